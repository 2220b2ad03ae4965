/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Neighbours of tetrahedra are found whatever number the nodes have: around a hub, a node
 * that thousands of tetrahedra have, where it is the first, the last or any. */
#include "../../lib/tet/mesh.h"
#include "tet_fixture.h"

enum { AROUND = 40, RINGS = 20, ON_SPHERE = AROUND * (RINGS - 1) + 2 };

/* Node of ring r (0 and RINGS are the poles) on the sphere. */
static uint32_t sphere_node(int r, int a)
{
    if (r == 0 || r == RINGS)
        return r == 0 ? 0 : ON_SPHERE - 1;
    return (uint32_t)(1 + (r - 1) * AROUND + a % AROUND);
}

static void put_sphere(double *xyz, const uint32_t *number)
{
    const double pi = acos(-1);
    for (int r = 0; r <= RINGS; r++)
        for (int a = 0; a < AROUND; a++) {
            const double u = pi * r / RINGS, w = 2 * pi * a / AROUND;
            double *p = xyz + 3 * number[sphere_node(r, a)];
            p[0] = sin(u) * cos(w);
            p[1] = sin(u) * sin(w);
            p[2] = cos(u);
        }
}

/* Appends a tetrahedron between the hub and a triangle of the sphere. */
static void add_tet(tm_block *ele, const uint32_t *number, const int place[3][2],
                    uint32_t hub)
{
    uint32_t *n = ele->integer + 4 * ele->count;
    for (int i = 0; i < 3; i++)
        n[i] = number[sphere_node(place[i][0], place[i][1])];
    n[3] = hub;
    if (ele->attributes)
        ele->attribute[ele->count] = (double)(ele->count % 7 == 0);
    ele->count++;
}

/* A ball of tetrahedra around the hub; its nodes have the numbers of a permutation, the
 * hub the last of it. With rows of .face between tetrahedra, marked where `marked`. */
static void make_hub(tm_stream *stream, const uint32_t *number, size_t attributes,
                     bool marked)
{
    tm_stream_init(stream);
    tm_block *node = tm_stream_add(stream, ".node");
    assert_int_equal(tm_block_allocate(node, ON_SPHERE + 1, 0, NULL), TM_OK);
    put_sphere(node->real, number);
    tm_block *ele = tm_stream_add(stream, ".ele");
    ele->attributes = attributes;
    const size_t tets = (size_t)2 * AROUND * (RINGS - 1);
    assert_int_equal(tm_block_allocate(ele, tets, 0, NULL), TM_OK);
    ele->count = 0;
    for (int r = 0; r < RINGS; r++)
        for (int a = 0; a < AROUND; a++) {
            if (r > 0)
                add_tet(ele, number, (const int[3][2]){{r, a}, {r + 1, a}, {r, a + 1}},
                        number[ON_SPHERE]);
            if (r < RINGS - 1)
                add_tet(ele, number,
                        (const int[3][2]){{r, a + 1}, {r + 1, a}, {r + 1, a + 1}},
                        number[ON_SPHERE]);
        }
    assert_int_equal(ele->count, tets);
    tm_block *face = tm_stream_add(stream, ".face");
    face->markers = marked;
    assert_int_equal(tm_block_allocate(face, tets / 5, 0, NULL), TM_OK);
    ele = tm_stream_find(stream, ".ele");
    for (size_t f = 0; f < face->count; f++) {
        const uint32_t *n = ele->integer + 20 * f;
        const uint32_t row[3] = {n[f % 3], n[3], n[(f + 1) % 3]};
        memcpy(face->integer + 3 * f, row, sizeof row);
        if (marked)
            face->marker[f] = (int32_t)(f % 3);
    }
}

/* Across half face h: the half face, or for a constrained face both of its sides, its
 * marker and whether it is listed. */
static void assert_same_across(const tm_tet_mesh *a, const tm_tet_mesh *b, uint32_t h)
{
    const uint32_t p = a->neighbour[h / 4][h % 4], q = b->neighbour[h / 4][h % 4];
    if (!(p & TM_FACE_BIT)) {
        assert_int_equal(p, q);
        return;
    }
    assert_true(q & TM_FACE_BIT);
    const tm_constrained_face *f = &a->face[p & ~TM_FACE_BIT];
    const tm_constrained_face *g = &b->face[q & ~TM_FACE_BIT];
    assert_int_equal(f->side[0] ^ f->side[1], g->side[0] ^ g->side[1]);
    assert_int_equal(f->marker, g->marker);
    assert_int_equal(f->listed, g->listed);
}

static void number_nodes(uint32_t *number, int kind)
{
    for (uint32_t v = 0; v <= ON_SPHERE; v++)
        number[v] = kind == 0 ? (v == ON_SPHERE ? 0 : v + 1) : v;
    for (uint32_t v = 0; kind == 2 && v < ON_SPHERE; v++) {
        const uint32_t w = v + random_below(ON_SPHERE + 1 - v), swapped = number[v];
        number[v] = number[w];
        number[w] = swapped;
    }
}

static void test_hub(void **state)
{
    (void)state;
    uint32_t number[ON_SPHERE + 1];
    for (unsigned regions = 0; regions < 2; regions++)
        for (int marked = 0; marked < 2; marked++) {
            tm_stream stream[3];
            tm_tet_mesh mesh[3];
            tm_error error = {0};
            for (int kind = 0; kind < 3; kind++) {
                number_nodes(number, kind);
                make_hub(&stream[kind], number, regions, marked);
                if (tm_tet_mesh_from_stream(&mesh[kind], &stream[kind], 1, &error) !=
                    TM_OK)
                    fail_msg("%s", error.what);
                assert_valid(&mesh[kind]);
                assert_int_equal(mesh[kind].faces, mesh[0].faces);
                assert_int_equal(mesh[kind].dropped_faces, mesh[0].dropped_faces);
                for (uint32_t h = 0; kind > 0 && h < 4 * mesh[0].slots; h++)
                    assert_same_across(&mesh[0], &mesh[kind], h);
            }
            for (int kind = 0; kind < 3; kind++) {
                tm_tet_mesh_free(&mesh[kind]);
                tm_stream_free(&stream[kind]);
            }
        }
}

/* What is wrong around a hub is found there, too. */
static void test_wrong_hub(void **state)
{
    (void)state;
    uint32_t number[ON_SPHERE + 1];
    for (int kind = 0; kind < 3; kind++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        tm_error error = {0};
        number_nodes(number, kind);
        make_hub(&stream, number, 0, false);
        const tm_block *face = tm_stream_find(&stream, ".face");
        for (int i = 0; i < 3; i++)
            face->integer[3 + i] = face->integer[i];
        assert_int_equal(tm_tet_mesh_from_stream(&mesh, &stream, 1, &error),
                         TM_ERROR_INPUT);
        assert_string_equal(error.block, ".face");
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
        make_hub(&stream, number, 0, false);
        const tm_block *ele = tm_stream_find(&stream, ".ele");
        memcpy(ele->integer, ele->integer + 400, 4 * sizeof *ele->integer);
        assert_int_equal(tm_tet_mesh_from_stream(&mesh, &stream, 1, &error),
                         TM_ERROR_INPUT);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hub),
                                       cmocka_unit_test(test_wrong_hub)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
