/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The readers of foreign surface formats: one pyramid from each, how formats are told
 * apart, and what they say of files that are wrong. */
#include "../../lib/surface/surface_defects.h"
#include "../../lib/format/tetgen.h"
#include "format_samples.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

static sample samples[SAMPLES];

/* Reads bytes that end where the memory does. */
static tm_status read_bytes(tm_polygon_surface *surface, tm_format format,
                            const char *bytes, size_t size, tm_error *error)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_polygon_surface_init(surface);
    tm_status status = tm_format_read(surface, format, copy, size, "file", error);
    free(copy);
    return status;
}

static void check_points(const tm_polygon_surface *surface)
{
    assert_int_equal(surface->nodes, POINTS);
    for (int v = 0; v < POINTS; v++)
        for (int k = 0; k < 3; k++)
            assert_true(surface->xyz[v][k] == pyramid[v][k]);
}

static void check_polygons(const tm_polygon_surface *surface)
{
    assert_int_equal(surface->polygons, POLYGONS);
    assert_int_equal(surface->facets, POLYGONS);
    assert_int_equal(surface->corners, sizeof polygon_node);
    for (size_t p = 0; p < POLYGONS; p++)
        assert_int_equal(surface->start[p + 1] - surface->start[p], polygon_size[p]);
    for (size_t i = 0; i < sizeof polygon_node; i++)
        assert_int_equal(surface->item[i], polygon_node[i]);
}

/* By coordinates: STL numbers its nodes as they come. */
static void check_triangles(const tm_polygon_surface *surface)
{
    assert_int_equal(surface->nodes, POINTS);
    assert_int_equal(surface->polygons, TRIANGLES);
    assert_int_equal(surface->corners, 3 * TRIANGLES);
    for (size_t i = 0; i < 3 * TRIANGLES; i++) {
        assert_int_equal(surface->start[i / 3], i / 3 * 3);
        for (int k = 0; k < 3; k++)
            assert_true(surface->xyz[surface->item[i]][k] ==
                        pyramid[triangle_node[i]][k]);
    }
}

static void test_same_surface_in_all_formats(void **state)
{
    (void)state;
    for (int s = 0; s < SAMPLES; s++) {
        tm_polygon_surface surface;
        tm_error error = {.status = TM_OK};
        const sample *it = &samples[s];
        if (it->format == TM_FORMAT_POLY)
            continue; /* has more in it: see test_poly() */
        tm_status status = read_bytes(&surface, it->format, it->bytes, it->size, &error);
        if (status != TM_OK)
            fail_msg("%s:%zu: %s", it->name, error.line, error.what);
        if (it->triangles) {
            check_triangles(&surface);
        } else {
            check_points(&surface);
            check_polygons(&surface);
        }
        tm_polygon_surface_free(&surface);
    }
}

static void test_stl_numbers_nodes_as_they_come(void **state)
{
    (void)state;
    tm_polygon_surface surface;
    assert_int_equal(
        read_bytes(&surface, TM_FORMAT_STL, stl_binary.bytes, stl_binary.size, NULL),
        TM_OK);
    static const uint32_t expected[] = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    for (size_t i = 0; i < sizeof expected / sizeof expected[0]; i++)
        assert_int_equal(surface.item[i], expected[i]);
    tm_polygon_surface_free(&surface);
}

static void check_poly(const tm_polygon_surface *surface)
{
    check_points(surface);
    assert_int_equal(surface->base, 0);
    assert_int_equal(surface->attributes, 1);
    assert_true(surface->attribute[0] == 2.5 && surface->attribute[4] == -1);
    assert_int_equal(surface->node_marker[4], 7);
    assert_int_equal(surface->facets, 5);
    assert_int_equal(surface->polygons, 6);
    static const size_t facet_start[] = {0, 1, 3, 4, 5, 6};
    static const int32_t marker[] = {4, 0, -5, 0, 6};
    for (size_t f = 0; f < 5; f++) {
        assert_int_equal(surface->facet_start[f + 1], facet_start[f + 1]);
        assert_int_equal(surface->facet_marker[f], marker[f]);
        assert_int_equal(surface->facet_hole_start[f + 1], f >= 1);
    }
    assert_true(surface->facet_hole[0][1] == 0.2);
    assert_int_equal(surface->start[3] - surface->start[2], 2); /* a segment */
    assert_int_equal(surface->holes, 1);
    assert_true(surface->hole[0][2] == 0.1);
    assert_int_equal(surface->regions, 2);
    assert_true(surface->region[0].attribute == 10);
    assert_true(surface->region[0].max_volume == 0.01);
    assert_true(surface->region[1].max_volume < 0);
}

/* Facets of several polygons, holes, regions; and the same again after writing. */
static void test_poly(void **state)
{
    (void)state;
    /* the second facet has two polygons and a hole */
    char text[sizeof poly_text];
    memcpy(text, poly_text, sizeof text);
    *strstr(text, "2 1\n3 0 1 4") = '2';
    tm_polygon_surface surface;
    tm_error error;
    assert_int_equal(read_bytes(&surface, TM_FORMAT_POLY, text, strlen(text), &error),
                     TM_OK);
    check_poly(&surface);
    tm_text written = {0};
    tm_plc_write(&written, &surface);
    tm_polygon_surface_free(&surface);
    assert_int_equal(
        read_bytes(&surface, TM_FORMAT_POLY, written.byte, written.size, &error), TM_OK);
    check_poly(&surface);
    tm_polygon_surface_free(&surface);
    tm_text_free(&written);
}

static void test_poly_with_nodes_elsewhere(void **state)
{
    (void)state;
    static const char node[] = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
    static const char smesh[] = "0 3 0 0\n1 0\n3 1 2 4\n0\n0\n";
    assert_true(tm_plc_lacks_nodes(smesh, sizeof smesh - 1));
    assert_false(tm_plc_lacks_nodes(smesh_text, sizeof smesh_text - 1));
    tm_polygon_surface surface;
    tm_polygon_surface_init(&surface);
    assert_int_equal(
        tm_format_read(&surface, TM_FORMAT_NODE, node, sizeof node - 1, "a.node", NULL),
        TM_OK);
    assert_int_equal(tm_format_read(&surface, TM_FORMAT_SMESH, smesh, sizeof smesh - 1,
                                    "a.smesh", NULL),
                     TM_OK);
    assert_int_equal(surface.nodes, 4);
    assert_int_equal(surface.item[2], 3);
    tm_polygon_surface_free(&surface);
}

static void test_formats_are_told_by_content(void **state)
{
    (void)state;
    for (int s = 0; s < SAMPLES; s++)
        assert_int_equal(tm_format_of(samples[s].bytes, samples[s].size, "<stdin>"),
                         samples[s].format);
    static const struct {
        const char *text, *name;
        tm_format format;
    } texts[] = {
        {"termesh 1\n.end\n", "a.off", TM_FORMAT_STREAM},
        {"2 3 0 0\n1 0 0 0\n2 0 0 1\n", "", TM_FORMAT_NODE},
        {"2 3 0 0\n1 0 0 0\n2 0 0 1\n", "a.smesh", TM_FORMAT_SMESH},
        {"0\n1 0\n1\n3 1 2 3\n", "", TM_FORMAT_POLY},
        {"0 3 0 0\n1 0\n3 1 2 3 7\n", "", TM_FORMAT_SMESH},
        {"# nothing\n", "", TM_FORMAT_UNKNOWN},
        {"", "a.stl", TM_FORMAT_UNKNOWN},
        {"12 4 0\n1 1 2 3 4\n", "a.ele", TM_FORMAT_UNKNOWN},
        {"STCNOFF\n0 0 0\n", "", TM_FORMAT_OFF},
        {"4OFF\n0 0 0\n", "", TM_FORMAT_OFF},
        {"BOFF\n", "", TM_FORMAT_OFF},
        {"MeshVersionFormatted 1\n", "a.mesh", TM_FORMAT_UNKNOWN},
        {"[Nodes, ARRAY1<STRING>]\n", "a.m3d", TM_FORMAT_UNKNOWN},
        {"# blender\nv 0 0 0\n", "", TM_FORMAT_OBJ},
        {"some bytes", "a.STL", TM_FORMAT_STL},
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
        assert_int_equal(
            tm_format_of(texts[i].text, strlen(texts[i].text), texts[i].name),
            texts[i].format);
}

/* A text, the line at fault (0: none is told) and words of the message. */
typedef struct {
    tm_format format;
    const char *text;
    size_t line;
    const char *what;
} fault;

static const fault faults[] = {
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 0\n", 3, "line ends where the z coordinate"},
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 0,5 0\n", 3, "decimal sign is a point"},
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 0x1 0\n", 3, "not a number"},
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 nan 0\n", 3, "not a number"},
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 1e999 0\n", 3, "too large"},
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 0 0 255 0 0\n", 3, "COFF"},
    {TM_FORMAT_OFF, "OFF\n-1 0 0\n", 2, "out of range"},
    {TM_FORMAT_OFF, "OFF\n2 0 0\n0 0 0\n", 4, "after 1 of 2 vertices"},
    {TM_FORMAT_OFF, "OFF\n4000000000 0 0\n", 3, "after 0 of 4000000000"},
    {TM_FORMAT_OFF, "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", 4,
     "vertex: 1 is out of range (0..0)"},
    {TM_FORMAT_OFF, "OFF\n1 1 0\n0 0 0\n2 0 0\n", 4, "number of corners"},
    {TM_FORMAT_OFF, "OFF\n1 1 0\n0 0 0\n3 0 0\n", 5, "file ends where vertex"},
    {TM_FORMAT_OFF, "OFF\n1 0 0\n0 0 0\n1 2 3\n", 4, "follows the last face"},
    {TM_FORMAT_OFF, "OFF BINARY\n\1\2", 1, "binary OFF"},
    {TM_FORMAT_OFF, "4OFF\n0 0 0\n", 1, "three coordinates"},
    {TM_FORMAT_OFF, "BOFF\n0 0 0\n", 1, "no keyword"},
    {TM_FORMAT_STL, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", 4, "the z co"},
    {TM_FORMAT_STL, "solid\nfacet normal 0 0 1\nloop\n", 3, "'outer' should be"},
    {TM_FORMAT_STL, "solid\n", 2, "'endsolid' should be"},
    {TM_FORMAT_STL, "solid\nendsolid\nmore\n", 3, "'solid' should be"},
    {TM_FORMAT_STL, "short", 0, "too few"},
    {TM_FORMAT_PLY, "ply\nformat ascii 1.0\n", 3, "before end_header"},
    {TM_FORMAT_PLY, "ply\nformat text 1.0\n", 2, "no format"},
    {TM_FORMAT_PLY, "ply\nproperty int x\n", 2, "before the first element"},
    {TM_FORMAT_PLY, "ply\nelement vertex 1\nproperty long x\n", 3, "no type"},
    {TM_FORMAT_PLY, "ply\nelement vertex 1\nproperty int x\nproperty int y\nend_header\n",
     6, "without x, y or z"},
    {TM_FORMAT_PLY,
     "ply\nelement face 1\nproperty list int int vertex_index\nend_header\n", 5,
     "before the vertices"},
    {TM_FORMAT_PLY,
     "ply\nelement vertex 1\nproperty int x\nproperty int y\nproperty int z\n"
     "element face 1\nproperty list int int vertex_index\nend_header\n0 0 0\n3 0 0 -1\n",
     10, "no vertex -1"},
    {TM_FORMAT_PLY,
     "ply\nelement vertex 9000000000000000000\nproperty int x\nproperty int y\n"
     "property int z\nend_header\n0 0 0\n",
     8, "file ends"},
    {TM_FORMAT_OBJ, "v 0 0\n", 1, "2 coordinates"},
    {TM_FORMAT_OBJ, "v 0 0 0\nf 1 1\n", 2, "2 corners"},
    {TM_FORMAT_OBJ, "v 0 0 0\nf 1 1 2\n", 2, "vertex 2 is out of range (1..1"},
    {TM_FORMAT_OBJ, "v 0 0 0\nf 1 1 0\n", 2, "vertex 0"},
    {TM_FORMAT_OBJ, "v 0 0 0\nf 1 1 -2\n", 2, "vertex -2"},
    {TM_FORMAT_OBJ, "v 0 0 0\nf 1 1 x\n", 2, "not the number of a vertex"},
    {TM_FORMAT_MDL, "[A, ARRAY1<POINT3D>]\n1\n0 0", 3, "coordinate"},
    {TM_FORMAT_MDL, "[A, ARRAY1<STRING>]\n1\n0 0 0 0 0 0\n", 0, "no section"},
    {TM_FORMAT_MDL, "[A, ARRAY1<STRING>]\n1\n0 0 7 0 0 0\n[B, ARRAY1<POINT3D>]\n0\n", 0,
     "out of range"},
    {TM_FORMAT_NODE, "1 2 0 0\n1 0 0\n", 1, "dimension 2"},
    {TM_FORMAT_NODE, "2 3 0 0\n1 0 0 0\n3 0 0 0\n", 3, "number 3 (2 is next)"},
    {TM_FORMAT_NODE, "1 3 0 0\n2 0 0 0\n", 2, "0 or 1"},
    {TM_FORMAT_NODE, "1 3 0 0\n1 0 0 0 5\n", 2, "follows the row"},
    {TM_FORMAT_NODE, "4000000000 3 0 0\n1 0 0 0\n", 2, "claims 4000000000 rows"},
    {TM_FORMAT_NODE, "1 3 2000000000 0\n1 0 0 0\n", 1,
     "attributes: 2000000000 is out of range"},
    {TM_FORMAT_NODE, "1 3 0 0\n1 0 0 0\n1 0 0\n", 3, "follows the last row"},
    {TM_FORMAT_SMESH, "1 3 0 0\n1 0 0 0\n1 0\n3 1 1 2\n", 4, "node: 2 is out of range"},
    {TM_FORMAT_SMESH, "1 3 0 0\n1 0 0 0\n1 0\n3 1 1 1 7\n", 4, "follows the facet"},
    {TM_FORMAT_SMESH, "1 3 0 0\n1 0 0 0\n1 0\n0\n", 4, "corners: 0"},
    {TM_FORMAT_POLY, "1 3 0 0\n1 0 0 0\n1 0\n1 1\n3 1 1 1\n", 6, "number of the hole"},
    {TM_FORMAT_POLY, "1 3 0 0\n1 0 0 0\n0 0\n1\n1 0 0\n", 5, "the z coordinate"},
    {TM_FORMAT_POLY, "1 3 0 0\n1 0 0 0\n0 0\n0\n1\n1 0 0 0\n", 6, "region's attribute"},
    {TM_FORMAT_UNKNOWN, "what", 0, "OFF, STL, PLY"},
};

static void test_messages(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof faults[0]; i++) {
        const fault *it = &faults[i];
        tm_polygon_surface surface;
        tm_error error = {.status = TM_OK};
        tm_status status =
            read_bytes(&surface, it->format, it->text, strlen(it->text), &error);
        if (status != TM_ERROR_INPUT || error.status != status ||
            error.line != it->line || !strstr(error.what, it->what))
            fail_msg("%s\ngave line %zu: %s\nbut line %zu was expected, with: %s",
                     it->text, error.line, error.what, it->line, it->what);
        assert_string_equal(error.file, "file");
        assert_int_equal(surface.nodes, 0);
        assert_null(surface.xyz);
    }
}

static void test_stl_that_is_cut_short_says_so(void **state)
{
    (void)state;
    tm_polygon_surface surface;
    tm_error error;
    assert_int_equal(
        read_bytes(&surface, TM_FORMAT_STL, stl_solid.bytes, stl_solid.size - 1, &error),
        TM_ERROR_INPUT);
    assert_non_null(strstr(error.what, "has 383 bytes, but claims 6 triangles"));
}

static tm_surface_defects defects_of(const char *off)
{
    tm_polygon_surface surface;
    tm_surface_defects defects;
    assert_int_equal(read_bytes(&surface, TM_FORMAT_OFF, off, strlen(off), NULL), TM_OK);
    assert_int_equal(tm_surface_find_defects(&surface, &defects, NULL), TM_OK);
    tm_polygon_surface_free(&surface);
    return defects;
}

static void test_defects(void **state)
{
    (void)state;
    tm_surface_defects d = defects_of(off_text);
    assert_int_equal(d.duplicate_nodes + d.unused_nodes + d.repeated_corners +
                         d.open_edges + d.crowded_edges + d.flat,
                     0);
    d = defects_of("OFF\n6 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n5 5 5\n-0 0 0\n"
                   "3 0 2 1\n3 5 1 3\n3 1 2 3\n3 3 3 2\n");
    assert_int_equal(d.duplicate_nodes, 1);
    assert_int_equal(d.unused_nodes, 1);
    assert_int_equal(d.repeated_corners, 1);
    assert_int_equal(d.open_edges, 2);
    assert_int_equal(d.open_edge[0][0], 0);
    assert_int_equal(d.open_edge[0][1], 2);
    assert_int_equal(d.crowded_edges, 1); /* 2-3: a triangle, and twice the bad one */
    assert_false(d.flat);
    assert_true(defects_of("OFF\n4 0 0\n0 0 1\n3 0 1\n0 1 1\n1 1 1\n").flat);
    assert_true(defects_of("OFF\n4 0 0\n0 0 0\n1 1 1\n3 3 3\n2 2 2\n").flat);
    assert_true(defects_of("OFF\n0 0 0\n").flat);
    assert_false(defects_of("OFF\n4 0 0\n0 0 0\n1 0 0\n0 1 0\n.5 .5 1e-300\n").flat);
}

/* Bytes behind the last triangle are such where it has a unit normal, or none; each
 * component counts. */
static void test_stl_with_more_behind(void **state)
{
    (void)state;
    enum { HEADER = 80, TRIANGLE = 50, MORE = 7 };
    for (int k = 0; k < 3; k++)
        for (int half = 0; half <= 2; half++) {
            char bytes[HEADER + 4 + TRIANGLE + MORE] = "";
            const float length = (float)half / 2;
            bytes[HEADER] = 1;
            memcpy(bytes + HEADER + 4 + 4 * k, &length, sizeof length);
            assert_int_equal(tm_stl_is_binary(bytes, sizeof bytes), half != 1);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_surface_in_all_formats),
        cmocka_unit_test(test_stl_numbers_nodes_as_they_come),
        cmocka_unit_test(test_poly),
        cmocka_unit_test(test_poly_with_nodes_elsewhere),
        cmocka_unit_test(test_formats_are_told_by_content),
        cmocka_unit_test(test_messages),
        cmocka_unit_test(test_stl_that_is_cut_short_says_so),
        cmocka_unit_test(test_defects),
        cmocka_unit_test(test_stl_with_more_behind),
    };
    make_samples(samples);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
