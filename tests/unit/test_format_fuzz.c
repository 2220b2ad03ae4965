/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No input makes a reader of foreign formats crash or return a surface that is not one:
 * every beginning of a good file, and good files with bytes changed, TM_CASES of each. */
#include "../../lib/mesh/cell_faces.h"
#include "../../lib/format/mesh_format.h"
#include "../../lib/format/oct.h"
#include "../../lib/format/tetgen.h"
#include "../../lib/format/visf.h"
#include "format_samples.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

enum { CHANGED = 3000, CHANGES_MAX = 6 };

static int changed_files = CHANGED;

static sample samples[SAMPLES];

static void check_ranges(const size_t *start, size_t count, size_t end)
{
    assert_true(count == 0 || (start[0] == 0 && start[count] == end));
    for (size_t i = 0; i < count; i++)
        assert_true(start[i] <= start[i + 1]);
}

static void check_surface(const tm_polygon_surface *s)
{
    for (size_t v = 0; v < s->nodes; v++)
        for (int k = 0; k < 3; k++)
            assert_true(isfinite(s->xyz[v][k]));
    check_ranges(s->start, s->polygons, s->corners);
    for (size_t i = 0; i < s->corners; i++)
        assert_true(s->item[i] < s->nodes);
    check_ranges(s->facet_start, s->facets, s->polygons);
    check_ranges(s->facet_hole_start, s->facets, s->facet_holes);
}

/* The bytes are read where reading one more is an error that a sanitizer sees. */
static void read_any(const char *bytes, size_t size, tm_format format)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_polygon_surface surface;
    tm_polygon_surface_init(&surface);
    tm_error error = {.status = TM_OK};
    tm_format_of(copy, size, "<stdin>");
    tm_status status = tm_format_read(&surface, format, copy, size, "file", &error);
    if (status == TM_OK) {
        check_surface(&surface);
    } else {
        assert_int_equal(status, TM_ERROR_INPUT);
        assert_int_equal(error.status, status);
        assert_true(error.what[0] != '\0');
        assert_int_equal(surface.nodes + surface.polygons + surface.facets, 0);
    }
    tm_polygon_surface_free(&surface);
    free(copy);
}

static void test_every_beginning(void **state)
{
    (void)state;
    for (int s = 0; s < SAMPLES; s++)
        for (size_t size = 0; size <= samples[s].size; size++)
            read_any(samples[s].bytes, size, samples[s].format);
}

/* Bytes that mean something in these formats are likelier than others. */
static char random_byte(void)
{
    static const char likely[] = "0123456789-+.eE \n\r\t#/\\";
    return random_below(4) ? likely[random_below(sizeof likely - 1)]
                           : (char)random_below(256);
}

static void change(char *bytes, size_t size)
{
    for (unsigned n = 1 + random_below(CHANGES_MAX); n > 0; n--)
        bytes[random_below((unsigned)size)] = random_byte();
}

static void test_changed_bytes(void **state)
{
    (void)state;
    for (int s = 0; s < SAMPLES; s++)
        for (int i = 0; i < changed_files; i++) {
            char changed[BINARY_MAX];
            memcpy(changed, samples[s].bytes, samples[s].size);
            change(changed, samples[s].size);
            read_any(changed, samples[s].size, samples[s].format);
        }
}

/* Every reader on every other format's files. */
static void test_wrong_reader(void **state)
{
    (void)state;
    for (int s = 0; s < SAMPLES; s++)
        for (int other = 0; other < SAMPLES; other++)
            read_any(samples[s].bytes, samples[s].size, samples[other].format);
}

static void read_rows(const char *bytes, size_t size, const char *name)
{
    enum { NODES = 5 };
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_stream stream;
    tm_stream_init(&stream);
    tm_block *block = tm_stream_add(&stream, name);
    assert_non_null(block);
    tm_error error = {.status = TM_OK};
    tm_tetgen_nodes nodes = {.base = 1, .count = NODES};
    if (tm_tetgen_read(block, copy, size, "file", &nodes, &error) == TM_OK) {
        size_t integers = block->count * tm_block_integers(block->kind);
        for (size_t i = 0; i < integers; i++)
            assert_true(block->integer[i] < NODES);
    } else {
        assert_int_equal(error.status, TM_ERROR_INPUT);
        assert_int_equal(block->count, 0);
    }
    assert_true(nodes.base <= 1);
    tm_tetgen_nodes_free(&nodes);
    tm_stream_free(&stream);
    free(copy);
}

static void test_rows(void **state)
{
    (void)state;
    static const struct {
        const char *name, *text;
    } rows[] = {
        {".node", "# TetGen\n2 3 2 1\n1 0 1e-3 .5  7 8.5 -1\n2 1 2 3 4 5 6\n"},
        {".ele", "2 4 1\r\n1 1 2 3 4 2.5\r\n2 5 4 3 2 -1\r\n"},
        {".face", "2 1\n1 1 2 3 -1 0 -1\n2 3 4 5 0\n# end"},
        {".edge", "2 1\n0 1 2 1 5\n1 3 4 1"},
    };
    for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
        size_t length = strlen(rows[r].text);
        for (size_t size = 0; size <= length; size++)
            read_rows(rows[r].text, size, rows[r].name);
        for (int i = 0; i < changed_files; i++) {
            char changed[BINARY_MAX];
            memcpy(changed, rows[r].text, length);
            change(changed, length);
            read_rows(changed, length, rows[r].name);
        }
    }
}

/* What is read is a mesh whose facets and cells agree. */
static void read_visf(const char *bytes, size_t size)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_stream stream;
    tm_polyhedra_repairs repairs;
    tm_error error = {.status = TM_OK};
    tm_cell_faces faces;
    tm_stream_init(&stream);
    if (tm_visf_read(&stream, copy, size, "file", &repairs, &error) == TM_OK) {
        assert_int_equal(tm_cell_faces_find(&faces, &stream, &error), TM_OK);
        tm_cell_faces_free(&faces);
    } else {
        assert_int_equal(error.status, TM_ERROR_INPUT);
        assert_true(error.what[0] != '\0');
        assert_int_equal(stream.blocks, 0);
    }
    tm_stream_free(&stream);
    free(copy);
}

/* Two tetrahedra, and a polygon that neither has. */
static const char visf_text[] = "2 2\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n8\n"
                                "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 1 4 3\n"
                                "3 2 4 1\n3 3 4 2\n3 0 1 4\n0\n2\n4 0 1 2 3\n"
                                "4 3 4 5 6\n";

static void test_visf(void **state)
{
    (void)state;
    static const tm_visf_options forms[] = {{TM_VISF_TEXT, false, false},
                                            {TM_VISF_TEXT, true, true},
                                            {TM_VISF_LITTLE, true, false},
                                            {TM_VISF_BIG, false, true}};
    tm_stream stream;
    tm_polyhedra_repairs repairs;
    tm_error error;
    tm_stream_init(&stream);
    assert_int_equal(
        tm_visf_read(&stream, visf_text, sizeof visf_text - 1, "file", &repairs, &error),
        TM_OK);
    assert_int_equal(repairs.dropped, 1);
    for (size_t f = 0; f < sizeof forms / sizeof forms[0]; f++) {
        tm_text text = {0};
        assert_int_equal(tm_visf_write(&text, &stream, &forms[f], &error), TM_OK);
        for (size_t size = 0; size <= text.size; size++)
            read_visf(text.byte, size);
        for (int i = 0; i < changed_files && text.size > 0; i++) {
            char *changed = malloc(text.size);
            assert_non_null(changed);
            memcpy(changed, text.byte, text.size);
            change(changed, text.size);
            read_visf(changed, text.size);
            free(changed);
        }
        tm_text_free(&text);
    }
    tm_stream_free(&stream);
}

/* What is read refers to what there is, and is written again. */
static void read_m3d(const char *bytes, size_t size)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_stream stream;
    tm_text text = {0};
    size_t materials;
    tm_error error = {.status = TM_OK};
    tm_stream_init(&stream);
    if (tm_m3d_read(&stream, copy, size, "file", &materials, &error) == TM_OK) {
        const tm_block *mix = tm_stream_find(&stream, ".mix");
        check_ranges(mix->start, mix->count, mix->start[mix->count]);
        for (size_t i = 0; i < mix->start[mix->count]; i++)
            assert_true(mix->item[i] < tm_stream_find(&stream, ".node")->count);
        assert_true(materials <= mix->count);
        assert_int_equal(tm_mvm_write(&text, &stream, 1, &error),
                         mix->count > 0 ? TM_OK : TM_ERROR_INPUT);
        tm_text_free(&text);
    } else {
        assert_int_equal(error.status, TM_ERROR_INPUT);
        assert_true(error.what[0] != '\0');
        assert_int_equal(stream.blocks, 0);
    }
    tm_stream_free(&stream);
    free(copy);
}

/* Where octants are read and fit into a tree, their places are in its roots. */
static void read_oct(const char *bytes, size_t size)
{
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_stream stream;
    tm_oct oct;
    tm_error error = {.status = TM_OK};
    tm_stream_init(&stream);
    tm_status status = tm_oct_read(&oct, copy, size, "file", &error);
    if (status == TM_OK)
        status = tm_oct_to_stream(&oct, &stream, "file", &error);
    if (status == TM_OK) {
        const tm_block *octant = tm_stream_find(&stream, ".octant");
        const tm_block *root = tm_stream_find(&stream, ".root");
        assert_int_equal(octant->count, oct.octants);
        for (size_t o = 0; o < octant->count; o++)
            assert_true(octant->integer[6 * o] <= root->integer[0]);
        for (size_t i = 0; i < 4 * root->count; i++)
            assert_true(isfinite(root->real[i]));
    } else {
        assert_int_equal(status, TM_ERROR_INPUT);
        assert_true(error.status == status && error.what[0] != '\0');
    }
    tm_oct_free(&oct);
    tm_stream_free(&stream);
    free(copy);
}

static void read_damaged(const char *text, void (*read)(const char *, size_t))
{
    size_t length = strlen(text);
    for (size_t size = 0; size <= length; size++)
        read(text, size);
    for (int i = 0; i < changed_files && length > 0; i++) {
        char changed[BINARY_MAX];
        memcpy(changed, text, length);
        change(changed, length);
        read(changed, length);
    }
}

static void test_m3d(void **state)
{
    (void)state;
    read_damaged("[Name, STRING]\r\ntoto\r\n[Elements, ARRAY1<STRING>]\r\n4\r\n"
                 "H 0 1 2 3 4 5 6 7 1000.0 0.45 1.0\nP 4 5 6 7 8 1000.0 0.45 1.0\n"
                 "R 1 3 0 5 7 4 1000.0 0.5 1.0\nT 0 1 2 8 1000.0 0.45 1.0\n"
                 "[Nodes, ARRAY1<STRING>]\n9\n\n1 0 0 0\n1 1 0 0\n1 1 1 0\n1 0 1 0\n"
                 "1 0 0 1\n1 1 0 1\n1 1 1 1\n1 0 1 1\n1 +5.0E-01 .5 2\n",
                 read_m3d);
    read_damaged("MIXED\n5 2\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n.5 .5 1\nP 0 1 2 3 4\n"
                 "T 0 1 2 4\n",
                 read_m3d);
}

static void test_oct(void **state)
{
    (void)state;
    static const char points[] = "0 0 0\n0 0 1\n1 0 1\n1 0 0\n0 1 0\n0 1 1\n1 1 1\n"
                                 "1 1 0\n2 0 1\n2 0 0\n2 1 1\n2 1 0\n0 1 0\n8 9 1\n";
    static const char octants[] = "8 0 1 2 3 4 5 6 7 1\n3 0 1 2\n"
                                  "8 3 2 8 9 7 6 10 11 1\r\n0\n\n"
                                  "Geometric Transform\n0 0 0\n0 0 0\n";
    char text[BINARY_MAX];
    snprintf(text, sizeof text, "12 2 2\n\n%s\n%s1 0", points, octants);
    read_damaged(text, read_oct);
    snprintf(text, sizeof text, "12 2 2 3\n\n%s\n1 2\n%s", points, octants);
    read_damaged(text, read_oct);
    snprintf(text, sizeof text,
             "12 2 2\n\n%s\n8 0 1 2 3 4 5 6 7 1 12\n0\n8 3 2 8 9 7 6 10 11 1 7\n0\n\n"
             "Geometric Transform\n0 0 0\n0 0 0\n1 0",
             points);
    read_damaged(text, read_oct);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_beginning),
        cmocka_unit_test(test_changed_bytes),
        cmocka_unit_test(test_wrong_reader),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_visf),
        cmocka_unit_test(test_m3d),
        cmocka_unit_test(test_oct),
    };
    const char *cases = getenv("TM_CASES");
    if (cases)
        changed_files = atoi(cases);
    make_samples(samples);
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
