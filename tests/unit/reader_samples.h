/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small file of every text format that has counts or an end, and its reader.
 *
 * Where a cut cannot be seen is between braces: a cut before any byte of { … } gives
 * another file that is whole as well. That is so within the last number, before what a
 * format allows to lack, and before a second solid of STL. */
#ifndef TESTS_UNIT_READER_SAMPLES_H
#define TESTS_UNIT_READER_SAMPLES_H

#include "../../lib/format/mesh_format.h"
#include "../../lib/format/oct.h"
#include "../../lib/format/surface/surface_format.h"
#include "../../lib/format/tetgen.h"
#include "../../lib/format/visf.h"
#include "../../lib/octree/forest/rule_files.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

/* Reads bytes and appends what they mean to a text. */
typedef tm_status reader(const char *bytes, size_t size, tm_text *meaning);

static void write_stream(const tm_stream *stream, tm_text *meaning)
{
    static const char *const lists[] = {".mix", ".facet", ".cell"};
    for (size_t b = 0; b < stream->blocks; b++) {
        const tm_block *block = &stream->block[b];
        tm_text_format(meaning, "%s %zu %zu %d:", block->name, block->count,
                       block->attributes, block->markers);
        for (size_t i = 0; i < block->count * tm_block_reals(block->kind); i++)
            tm_text_format(meaning, " %g", block->real[i]);
        for (size_t i = 0; i < block->count * tm_block_integers(block->kind); i++)
            tm_text_format(meaning, " %u", block->integer[i]);
        for (size_t i = 0; i < block->count * block->attributes; i++)
            tm_text_format(meaning, " %g", block->attribute[i]);
        for (size_t i = 0; block->markers && i < block->count; i++)
            tm_text_format(meaning, " %d", block->marker[i]);
        for (size_t k = 0; k < sizeof lists / sizeof *lists; k++)
            for (size_t i = 0;
                 strcmp(lists[k], block->name) == 0 && i < block->start[block->count];
                 i++)
                tm_text_format(meaning, " %u", block->item[i]);
    }
}

static tm_status read_surface(const char *bytes, size_t size, tm_text *meaning,
                              tm_format format)
{
    tm_polygon_surface surface;
    tm_error error;
    tm_polygon_surface_init(&surface);
    const tm_status status =
        tm_format_read(&surface, format, bytes, size, "file", &error);
    if (status == TM_OK)
        tm_plc_write(meaning, &surface);
    tm_polygon_surface_free(&surface);
    return status;
}

#define SURFACE_READER(name, format)                                                     \
    static tm_status name(const char *bytes, size_t size, tm_text *meaning)              \
    {                                                                                    \
        return read_surface(bytes, size, meaning, format);                               \
    }
SURFACE_READER(read_off, TM_FORMAT_OFF)
SURFACE_READER(read_stl, TM_FORMAT_STL)
SURFACE_READER(read_ply, TM_FORMAT_PLY)
SURFACE_READER(read_mdl, TM_FORMAT_MDL)
SURFACE_READER(read_node, TM_FORMAT_NODE)
SURFACE_READER(read_poly, TM_FORMAT_POLY)
SURFACE_READER(read_smesh, TM_FORMAT_SMESH)

static tm_status read_rows(const char *bytes, size_t size, tm_text *meaning,
                           const char *name)
{
    enum { NODES = 99 };
    tm_stream stream;
    tm_error error;
    tm_tetgen_nodes nodes = {.base = 1, .count = NODES};
    tm_stream_init(&stream);
    tm_block *block = tm_stream_add(&stream, name);
    assert_non_null(block);
    const tm_status status = tm_tetgen_read(block, bytes, size, "file", &nodes, &error);
    tm_tetgen_nodes_free(&nodes);
    if (status == TM_OK)
        write_stream(&stream, meaning);
    tm_stream_free(&stream);
    return status;
}

static tm_status read_ele(const char *bytes, size_t size, tm_text *meaning)
{
    return read_rows(bytes, size, meaning, ".ele");
}

static tm_status read_face(const char *bytes, size_t size, tm_text *meaning)
{
    return read_rows(bytes, size, meaning, ".face");
}

static tm_status read_edge(const char *bytes, size_t size, tm_text *meaning)
{
    return read_rows(bytes, size, meaning, ".edge");
}

static tm_status read_visf(const char *bytes, size_t size, tm_text *meaning)
{
    tm_stream stream;
    tm_polyhedra_repairs repairs;
    tm_error error;
    tm_stream_init(&stream);
    const tm_status status = tm_visf_read(&stream, bytes, size, "file", &repairs, &error);
    write_stream(&stream, meaning);
    tm_stream_free(&stream);
    return status;
}

static tm_status read_m3d(const char *bytes, size_t size, tm_text *meaning)
{
    tm_stream stream;
    size_t materials;
    tm_error error;
    tm_stream_init(&stream);
    const tm_status status =
        tm_m3d_read(&stream, bytes, size, "file", &materials, &error);
    write_stream(&stream, meaning);
    tm_stream_free(&stream);
    return status;
}

static tm_status read_oct(const char *bytes, size_t size, tm_text *meaning)
{
    tm_oct oct;
    tm_error error;
    const tm_status status = tm_oct_read(&oct, bytes, size, "file", &error);
    for (size_t p = 0; p < oct.points && status == TM_OK; p++)
        tm_text_format(meaning, "%g %g %g\n", oct.xyz[p][0], oct.xyz[p][1],
                       oct.xyz[p][2]);
    for (size_t o = 0; o < oct.octants && status == TM_OK; o++) {
        for (int i = 0; i < TM_OCT_CORNERS; i++)
            tm_text_format(meaning, "%u ", oct.corner[o][i]);
        tm_text_format(meaning, "%d %u\n", oct.level[o], oct.elements[o]);
    }
    tm_oct_free(&oct);
    return status;
}

static tm_status read_reg(const char *bytes, size_t size, tm_text *meaning)
{
    tm_octree_rules rules = {.count = 0};
    tm_error error;
    const tm_status status = tm_reg_read(&rules, bytes, size, "file", &error);
    for (size_t i = 0; i < rules.count; i++)
        tm_text_format(meaning, "%g %g %u\n", rules.rule[i].low[0], rules.rule[i].high[2],
                       rules.rule[i].level);
    tm_octree_rules_free(&rules);
    return status;
}

static tm_status read_stream(const char *bytes, size_t size, tm_text *meaning)
{
    tm_stream stream;
    tm_error error;
    tm_stream_init(&stream);
    int fd = memfd_create("stream", 0);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, bytes, size), size);
    assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
    const tm_status status = tm_stream_read(&stream, fd, "file", 1, &error);
    close(fd);
    write_stream(&stream, meaning);
    tm_stream_free(&stream);
    return status;
}

static const struct {
    const char *name;
    reader *read;
    const char *text;
} reader_samples[] = {
    {"OFF", read_off,
     "OFF\n4 4 6 # counts\n0 0 0\n1 0 0\n0 1 0\n0 0 1.5\n3 0 2 1\n"
     "3 0 1 3 255 0 0\n3 0 3 2\n3 1 2 0{3}\n"},
    {"COFF", read_off, "COFF 3 1\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2 9 12 9"},
    {"STL", read_stl,
     "solid a name\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
     "vertex 0 1 0\nendloop\nendfacet\nendsolid{ a name\ns}olid b\nfacet normal 0 0 0\n"
     "outer loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
     "endsolid b\n"},
    {"PLY", read_ply,
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
     "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
     "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 0{2}\n"},
    {".mdl", read_mdl,
     "[Name, STRING]\ntoto\n\n[Normals, ARRAY1<VECTOR3D>]\n1\n1 0 0\n\n"
     "[Vertices, ARRAY1<POINT3D>]\n4\n\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\n"
     "[Triangles, ARRAY1<STRING>]\n4\n\n0 2 1 0 0 0\n0 1 3 0 0 0\n0 3 2 0 0 0\n"
     "1 2 3 0 0 10\n"},
    {".mdl, points last", read_mdl,
     "[Triangles, ARRAY1<STRING>]\n1\n0 1 2 0 0 0\n[Vertices, ARRAY1<POINT3D>]\n3\n"
     "0 0 0\n1 0 0\n0 1 1{.25}\n"},
    {".node", read_node, "# TetGen\n2 3 1 1\n1 0 1e-3 .5  7 8\n2 1 2 3 4 1{23}\n"},
    {".poly", read_poly,
     "4 3 0 1\n1 0 0 0 5\n2 4 0 0 5\n3 0 4 0 5\n4 0 0 4 5\n4 1\n1 0 4\n3 1 3 2\n"
     "2 1\n3 1 2 4\n3 1 2 4\n1 .2 .2 .2\n1\n3 1 4 3\n1 0 -7\n3 2 3 4\n"
     "1\n1 1 1 2{.5\n2}\n1 .1 .1 .1 3 1e-2\n2 2 2 2 4{ 1.5}\n"},
    {".smesh", read_smesh,
     "4 3\n1 0 0 0\n2 4 0 0\n3 0 4 0\n4 0 0 4\n4 1\n3 1 3 2 11\n3 1 2 4 12\n3 1 4 3\n"
     "3 2 3 4 13\n0{ # holes\n1} # regions\n1 1 1 1 1{1}\n"},
    {".smesh without regions", read_smesh,
     "3 3\n1 0 0 0\n2 4 0 0\n3 0 4 0\n1 0\n3 1 3 2\n0\n0\n"},
    {".smesh, nodes beside it", read_smesh, "0 3\n0 1\n0\n0\n"},
    {".ele", read_ele, "2 4 1\n1 1 2 3 4 2.5\n2 5 4 3 2 -1{.5}\n# end"},
    {".face", read_face, "2 1\n1 1 2 3 -1 0 -1\n2 3 4 5 1{2}\n"},
    {".edge", read_edge, "2 0\n0 1 2\n1 3 1{2}\n"},
    {"ViSF points", read_visf, "2 0\n2\n0 0 0\n1 1 1{.5}\n"},
    {"ViSF polygons", read_visf,
     "2 1\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n2\n3 0 1 2\n"
     "3 0 1 3\n0\n"},
    {"ViSF neighbours", read_visf,
     "2 1\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n2\n3 0 1 2\n"
     "3 0 1 3\n1\n1 1\n1 0\n"},
    {"ViSF polyhedra", read_visf,
     "2 2\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n0\n1\n"
     "4 0 1 2 03\n"},
    {".m3d", read_m3d,
     "[Nodes, ARRAY1<STRING>]\n4\n\n1 0 0 0\n1 1 0 0\n1 0 1 0\n1 0 0 1\n\n"
     "[Elements, ARRAY1<STRING>]\n1\n\nT 0 1 2 3 1000.0 0.45 1.0\n"},
    {".mvm", read_m3d, "MIXED\n4 1\n\n0 0 0\n1 0 0\n0 1 0\n0 0 1\nT 0 1 2 0{3}\n"},
    {".oct", read_oct,
     "8 1 1\n\n0 0 0\n0 0 1\n1 0 1\n1 0 0\n0 1 0\n0 1 1\n1 1 1\n1 1 0\n0 1 0\n"
     "8 0 1 2 3 4 5 6 7 0\n2 0 1\n\nGeometric Transform\n0 0 0\n0 0 0.0\n\n1{2}\n"},
    {".oct, other version", read_oct,
     "8 1 1 12\n\n0 0 0\n0 0 1\n1 0 1\n1 0 0\n0 1 0\n0 1 1\n1 1 1\n1 1 0\n0 1 0\n12\n"
     "8 0 1 2 3 4 5 6 7 0\n2 0 1\n\nGeometric Transform\n0 0 0\n0 0 0.0\n"},
    {".reg", read_reg, "n_regions 2\n0 0 0\n1 1 1\n5\n0 0 0\n2 2 2\n1{2}\n"},
    {"stream", read_stream,
     "termesh 1\n# made\n.node\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n.ele\n1 4 "
     "1\n"
     "1 1 2 3 4 7\n.end\n# more\n"},
};
enum {
    READER_SAMPLES = sizeof reader_samples / sizeof *reader_samples,
    READER_SAMPLE_MAX = 1024
};

/* The text without braces; unseen[size] is whether a cut there cannot be seen. */
static inline size_t take_braces(const char *text, char *bytes, bool *unseen)
{
    size_t size = 0;
    bool within = false;
    for (; *text; text++)
        if (*text == '{' || *text == '}') {
            within = *text == '{';
        } else {
            unseen[size] = within;
            bytes[size++] = *text;
        }
    return size;
}

/* The bytes are read where reading one more is an error that a sanitizer sees. */
static inline tm_status read_copy(reader *read, const char *bytes, size_t size,
                                  tm_text *meaning)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    const tm_status status = read(copy, size, meaning);
    tm_text_string(meaning, "");
    free(copy);
    return status;
}

#endif
