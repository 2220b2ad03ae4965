/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mixed meshes out of streams. */
#include "../../lib/mesh/mixed_stream.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A tetrahedron and a pyramid, with attributes. */
static tm_stream make_stream(void)
{
    static const uint32_t item[] = {0, 1, 2, 4, 0, 1, 2, 3, 4};
    static const size_t start[] = {0, 4, 9};
    tm_stream stream;
    tm_error error;
    tm_stream_init(&stream);
    tm_block *node = tm_stream_add(&stream, ".node");
    assert_int_equal(tm_block_allocate(node, 5, 0, &error), TM_OK);
    for (size_t i = 0; i < 15; i++)
        node->real[i] = (double)i;
    tm_block *mix = tm_stream_add(&stream, ".mix");
    mix->attributes = 1;
    assert_int_equal(tm_block_allocate(mix, 2, 9, &error), TM_OK);
    memcpy(mix->start, start, sizeof start);
    memcpy(mix->item, item, sizeof item);
    return stream;
}

static void free_mesh(tm_mixed_mesh *mesh)
{
    free(mesh->xyz);
    free(mesh->start);
    free(mesh->item);
}

static void test_from_stream(void **state)
{
    (void)state;
    tm_stream stream = make_stream();
    tm_mixed_mesh mesh;
    tm_error error;
    assert_int_equal(tm_mixed_mesh_from_stream(&mesh, &stream, &error), TM_OK);
    assert_int_equal(mesh.nodes, 5);
    assert_int_equal(mesh.elements, 2);
    assert_true(mesh.xyz[4][2] == 14);
    assert_int_equal(mesh.item[mesh.start[1] + 3], 3);
    assert_int_equal(mesh.start[2], 9);
    assert_int_equal(mesh.item[8], 4);
    const tm_block *node = tm_stream_find(&stream, ".node");
    const tm_block *mix = tm_stream_find(&stream, ".mix");
    assert_null(node->real);
    assert_null(mix->start);
    assert_null(mix->item);
    assert_int_equal(mix->attributes, 1);
    free_mesh(&mesh);
    tm_stream_free(&stream);
}

static void test_node_twice(void **state)
{
    (void)state;
    tm_stream stream = make_stream();
    tm_stream_find(&stream, ".mix")->item[8] = 2;
    tm_mixed_mesh mesh;
    tm_error error;
    assert_int_equal(tm_mixed_mesh_from_stream(&mesh, &stream, &error), TM_ERROR_INPUT);
    assert_string_equal(error.what, "element 2 names a node twice");
    free_mesh(&mesh);
    tm_stream_free(&stream);
}

static void test_empty(void **state)
{
    (void)state;
    tm_stream stream;
    tm_mixed_mesh mesh;
    tm_error error;
    tm_stream_init(&stream);
    assert_int_equal(tm_mixed_mesh_from_stream(&mesh, &stream, &error), TM_OK);
    assert_int_equal(mesh.nodes + mesh.elements, 0);
    assert_int_equal(mesh.start[0], 0);
    free_mesh(&mesh);
    tm_stream_free(&stream);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_from_stream),
        cmocka_unit_test(test_node_twice),
        cmocka_unit_test(test_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
