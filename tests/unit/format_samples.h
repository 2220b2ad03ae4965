/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One surface, a pyramid on a square, in every foreign format; STL and .mdl, which have
 * triangles only, with the square cut in two. */
#ifndef TESTS_UNIT_FORMAT_SAMPLES_H
#define TESTS_UNIT_FORMAT_SAMPLES_H

#include "../../lib/format/surface/surface_format.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *name;
    tm_format format;
    bool triangles; /* only */
    const char *bytes;
    size_t size;
} sample;

static const char off_text[] = "# a pyramid\nOFF\n5 5 8 # counts\n\n"
                               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 5e-1 1 # the tip\n"
                               "4 0 3 2 1 255 0 0\n3 0 1 4\n3  1 2 4\t1 0 0\n"
                               "3 2 3 4\n3 3 0 4";

static const char obj_text[] = "mtllib a.mtl\no pyramid\nv 0 0 0\r\nv 1 0 0 1.0\r\n"
                               "v 1 1 \\\n 0\nv 0 1 0\nvn 0 0 1\nv 0.5 0.5 1 # tip\n"
                               "vt 0 0\ng side\nusemtl red\ns off\nf 1/1 4/1 3/1 2/1\n"
                               "f 1//1 2//1 \\\n5//1\nf -4 -3 -1\nf 3/1/1 4/1/1 5/1/1\n"
                               "f 4 1 5";

static const char ply_text[] =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\n"
    "property uchar red\nproperty float z\nproperty double x\nproperty list uchar int l\n"
    "property float y\nelement face 5\nproperty int flags\n"
    "property list uchar uint vertex_index\nelement edge 1\nproperty int a\n"
    "property int b\nend_header\n"
    "9 0 0 0 0\n9 0 1 2 7 8 0\n9 0 1 0 1\n9 0 0 0 1\n9 1 .5 1 3 .5\n"
    "0 4 0 3 2 1\n1 3 0 1 4\n2 3 1 2 4\n3 3 2 3 4\n4 3 3 0 4\n0 1\n";

static const char mdl_text[] =
    "[Name, STRING]\r\ntoto\r\n\r\n[Normals, ARRAY1<VECTOR3D>]\r\n1\r\n1 0 0\r\n\r\n"
    "[Triangles, ARRAY1<STRING>]\r\n6\r\n0 3 2 0 0 0\n0 2 1 0 0 0\n0 1 4 0 0 0\n"
    "1 2 4 0 0 0\n2 3 4 0 0 0\n3 0 4 0 0 0\n[Vertices, ARRAY1<POINT3D>]\n5\n\n"
    " +0.00000000E+00 0 0\n +1.0E+00 0 0\n1 1 0\n0 1 0\n 5.0E-01 .5 1\n";

static const char poly_text[] =
    "# part 1\n5 3 1 1\n\n0  0 0 0  2.5 1\n1  1 0 0  2 1 # a corner\n2 1 1 0 2 1\n"
    "3 0 1 0 2 1\n4 .5 .5 1 -1 7\n# part 2\n5 1\n1 0 4 # the square\n4 0 3\n 2 1\n"
    "2 1\n3 0 1 4\n2 0 1\n1  0.5 0.2 0.3\n1 0 -5\n3 1 2 4\n1\n3 2 3 4\n1 0 6\n3 3 0 4\n"
    "1\n1 0.5 0.5 0.1\n2\n1 0.5 0.5 0.5 10 0.01\n2 0.5 0.5 0.6 20\n";

static const char smesh_text[] =
    "5 3\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 .5 .5 1\n5 1\n4 1 4 3 2 4\n3 1 2 5 0\n"
    "3 2 3 5 -5\n3 3 4 5 0\n3 4 1 5 6\n0\n0\n";

static const char stl_text[] =
    "solid a name\n"
    "facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 1 0\n"
    "endloop\nendfacet\n"
    "  facet normal nan nan nan\r\n    outer loop\r\n      vertex -0 0 -0.0\r\n"
    "      vertex 1 1 0\r\n      vertex 1 0 0\r\n    endloop\r\n  endfacet\r\n"
    "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0.5 0.5 1 endloop "
    "endfacet\nendsolid a name\nsolid\n"
    "FACET NORMAL 0 0 0\nOUTER LOOP\nVERTEX 1 0 0\nVERTEX 1 1 0\nVERTEX 0.5 0.5 1\n"
    "ENDLOOP\nENDFACET\n"
    "facet normal 0 0 0\nouter loop\nvertex 1 1 0\nvertex 0 1 0\nvertex 0.5 0.5 1\n"
    "endloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 0.5 0.5 1\n"
    "endloop\nendfacet\nendsolid\n";

enum { POINTS = 5, POLYGONS = 5, TRIANGLES = 6 };

static const double pyramid[POINTS][3] = {
    {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
static const unsigned char polygon_size[POLYGONS] = {4, 3, 3, 3, 3};
static const unsigned char polygon_node[] = {0, 3, 2, 1, 0, 1, 4, 1,
                                             2, 4, 2, 3, 4, 3, 0, 4};
static const unsigned char triangle_node[3 * TRIANGLES] = {0, 3, 2, 0, 2, 1, 0, 1, 4,
                                                           1, 2, 4, 2, 3, 4, 3, 0, 4};

/* Binary samples ------------------------------------------------------------------- */

enum { BINARY_MAX = 4096 };

typedef struct {
    char bytes[BINARY_MAX];
    size_t size;
    bool big;
} binary;

static inline void put(binary *b, uint64_t value, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        size_t shift = 8 * (b->big ? size - 1 - i : i);
        b->bytes[b->size++] = (char)(value >> shift);
    }
}

static inline void put_float(binary *b, double value)
{
    float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put(b, bits, sizeof bits);
}

static inline void put_double(binary *b, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put(b, bits, sizeof bits);
}

static inline void put_text(binary *b, const char *text)
{
    memcpy(b->bytes + b->size, text, strlen(text));
    b->size += strlen(text);
}

/* The header may begin as that of a text file does. */
static inline void make_stl(binary *b, const char *header)
{
    enum { HEADER = 80 };
    *b = (binary){.size = 0};
    put_text(b, header);
    b->size = HEADER;
    put(b, TRIANGLES, 4);
    for (int t = 0; t < TRIANGLES; t++) {
        for (int i = 0; i < 3; i++)
            put(b, 0x7fc00000, 4); /* a normal of NaN */
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                double value = pyramid[triangle_node[3 * t + i]][k];
                put_float(b, t % 2 == 1 && value == 0 ? -0.0 : value);
            }
        put(b, 0xffff, 2);
    }
}

static inline void make_ply(binary *b, bool big)
{
    *b = (binary){.big = big};
    put_text(b, "ply\r\nformat binary_");
    put_text(b, big ? "big" : "little");
    put_text(b, "_endian 1.0\r\nelement vertex 5\r\nproperty double x\r\n"
                "property float32 y\r\nproperty int8 z\r\nproperty short more\r\n"
                "element face 5\r\nproperty list ushort int colours\r\n"
                "property list int16 uint16 vertex_indices\r\nend_header\r\n");
    for (int v = 0; v < POINTS; v++) {
        put_double(b, pyramid[v][0]);
        put_float(b, pyramid[v][1]);
        put(b, (uint64_t)pyramid[v][2], 1);
        put(b, 0xfffe, 2);
    }
    for (int p = 0, i = 0; p < POLYGONS; p++) {
        put(b, (uint64_t)p, 2);
        for (int k = 0; k < p; k++)
            put(b, 0, 4);
        put(b, polygon_size[p], 2);
        for (int k = 0; k < polygon_size[p]; k++)
            put(b, polygon_node[i++], 2);
    }
}

static binary stl_binary, stl_solid, ply_little, ply_big;

#define TEXT_SAMPLE(name, format, triangles, text)                                       \
    {                                                                                    \
        name, format, triangles, text, sizeof(text) - 1                                  \
    }

enum { SAMPLES = 11 };

static inline void make_samples(sample samples[SAMPLES])
{
    make_stl(&stl_binary, "made by hand");
    make_stl(&stl_solid, "solid, but binary\nfacet normal 0 0 0\n");
    make_ply(&ply_little, false);
    make_ply(&ply_big, true);
    const sample all[SAMPLES] = {
        TEXT_SAMPLE("a.off", TM_FORMAT_OFF, false, off_text),
        TEXT_SAMPLE("a.obj", TM_FORMAT_OBJ, false, obj_text),
        TEXT_SAMPLE("a.ply", TM_FORMAT_PLY, false, ply_text),
        TEXT_SAMPLE("a.poly", TM_FORMAT_POLY, false, poly_text),
        TEXT_SAMPLE("a.smesh", TM_FORMAT_SMESH, false, smesh_text),
        TEXT_SAMPLE("a.mdl", TM_FORMAT_MDL, true, mdl_text),
        TEXT_SAMPLE("a.stl", TM_FORMAT_STL, true, stl_text),
        {"b.stl", TM_FORMAT_STL, true, stl_binary.bytes, stl_binary.size},
        {"c.stl", TM_FORMAT_STL, true, stl_solid.bytes, stl_solid.size},
        {"l.ply", TM_FORMAT_PLY, false, ply_little.bytes, ply_little.size},
        {"b.ply", TM_FORMAT_PLY, false, ply_big.bytes, ply_big.size},
    };
    memcpy(samples, all, sizeof all);
}

#endif
