/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is simple and what is not, on the smallest polyhedra; every defect of a mesh of
 * polyhedra. */
#include "../../lib/examine/poly/poly_boundary.h"
#include "../../lib/examine/poly/poly_examine.h"
#include "../../lib/examine/poly/poly_parts.h"
#include "random.h"
#include "voxels.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum {
    SIMPLE = 0,
    EDGE = 1 << TM_CAUSE_EDGE,
    VERTEX = 1 << TM_CAUSE_VERTEX,
    PIECES = 1 << TM_CAUSE_PIECES,
    EULER = 1 << TM_CAUSE_EULER
};

static unsigned causes_of(const voxels *v, uint32_t cell, long *euler)
{
    tm_poly_boundary b = {0};
    const size_t start = v->cell_start[cell];
    assert_int_equal(tm_poly_boundary_find(&b, &v->mesh, v->cell_facet + start,
                                           v->cell_start[cell + 1] - start, cell, NULL),
                     TM_OK);
    const unsigned causes = tm_poly_boundary_causes(&b);
    *euler = (long)b.nodes - (long)b.edges + (long)b.faces;
    double volume;
    assert_int_equal(tm_poly_sign(&b, v->mesh.xyz, &volume), 1);
    assert_true(fabs(volume - v->attribute[cell] / 6) < 1e-12);
    tm_poly_boundary_free(&b);
    return causes;
}

static void check(int x, int y, int z, const char *picture, unsigned causes, long euler)
{
    voxels v = voxels_of(x, y, z, picture);
    long found;
    voxels_join(&v);
    assert_int_equal(causes_of(&v, 0, &found), causes);
    assert_int_equal(found, euler);
    voxels_free(&v);
}

static void test_simple(void **state)
{
    (void)state;
    check(1, 1, 1, "0", SIMPLE, 2);
    check(2, 2, 1, "0000", SIMPLE, 2);
    check(2, 2, 1, "00.0", SIMPLE, 2);
    /* One of two cells, and a cube in the middle of another cell. */
    check(2, 1, 1, "01", SIMPLE, 2);
    check(3, 3, 3, "111111111111101111111111111", SIMPLE, 2);
}

static void test_not_simple(void **state)
{
    (void)state;
    /* Two cubes that touch in an edge, and in a vertex. */
    check(2, 2, 1, "0..0", EDGE | EULER, 3);
    check(2, 2, 2, "0......0", VERTEX | EULER, 3);
    /* A ring, a cube with a cavity, two cubes that do not touch. */
    check(3, 3, 1, "0000.0000", EULER, 0);
    check(3, 3, 3, "0000000000000.0000000000000", PIECES | EULER, 4);
    check(3, 1, 1, "0.0", PIECES | EULER, 4);
}

/* What Euler's formula does not see. */
static void test_not_simple_but_euler(void **state)
{
    (void)state;
    /* A ring and a cube apart from it. */
    check(5, 3, 1, "000..0.0.0000..", PIECES, 2);
    /* Two bodies that touch in two vertices. */
    check(4, 2, 3,
          "0000...."
          "0..0...."
          ".....00.",
          VERTEX, 2);
    /* A ring that touches a cube in a vertex has 1, which is seen. */
    check(4, 4, 2,
          "000.0.0.000....."
          "...............0",
          VERTEX | EULER, 1);
    /* A ring that is closed by an edge only: a sphere with two segments made one. */
    check(3, 3, 1, "0000.000.", EDGE | EULER, 1);
}

typedef struct expected {
    tm_defect kind;
    size_t count;
} expected;

static void assert_only(const tm_examination *found, const expected *list, size_t kinds)
{
    for (tm_defect d = 0; d < TM_DEFECTS; d++) {
        size_t count = 0;
        for (size_t i = 0; i < kinds; i++)
            if (list[i].kind == d)
                count = list[i].count;
        if (found->defect[d].count != count)
            fail_msg("defects of kind %u: %zu, not %zu", d, found->defect[d].count,
                     count);
    }
    assert_int_equal(tm_examination_is_good(found), kinds == 0);
}

#define ASSERT_ONLY(found, ...)                                                          \
    assert_only(found, (const expected[]){__VA_ARGS__},                                  \
                sizeof((const expected[]){__VA_ARGS__}) / sizeof(expected))
#define ASSERT_GOOD(found) assert_only(found, NULL, 0)

static tm_examination examine(const voxels *v)
{
    tm_examination found;
    assert_int_equal(tm_poly_examine(&found, &v->mesh, 1, NULL), TM_OK);
    return found;
}

/* The facet between two cells, or at the boundary. */
static size_t facet_between(const voxels *v, uint32_t a, uint32_t b)
{
    size_t f = 0;
    while (v->side[f][0] != a || v->side[f][1] != b)
        f++;
    return f;
}

static void test_good(void **state)
{
    (void)state;
    voxels v = voxels_of(3, 2, 1, "011022");
    voxels_join(&v);
    tm_examination found = examine(&v);
    ASSERT_GOOD(&found);
    assert_int_equal(found.element_count, 3);
    assert_int_equal(found.boundary_faces, 22);
    assert_int_equal(found.components, 1);
    assert_int_equal(found.unused_nodes, 0);
    assert_int_equal(found.euler, 1);
    assert_true(found.volume == 6 && found.area == 22);
    voxels_free(&v);

    v = voxels_of(3, 1, 1, "0.1");
    voxels_join(&v);
    found = examine(&v);
    ASSERT_GOOD(&found);
    assert_int_equal(found.components, 2);
    assert_int_equal(found.euler, 2);
    voxels_free(&v);

    const tm_poly_arrays nothing = {0};
    assert_int_equal(tm_poly_examine(&found, &nothing, 1, NULL), TM_OK);
    ASSERT_GOOD(&found);
    assert_int_equal(found.euler, 0);
}

static void test_random_blocks(void **state)
{
    (void)state;
    enum { ROUNDS = 100, SIDE = 6 };
    for (int round = 0; round < ROUNDS; round++) {
        voxels v = voxels_new(1 + (int)random_below(SIDE), 1 + (int)random_below(SIDE),
                              1 + (int)random_below(SIDE));
        const int cubes = v.size[0] * v.size[1] * v.size[2];
        for (int i = 0; i < cubes; i++)
            v.label[i] = i;
        voxels_join(&v);
        const tm_examination found = examine(&v);
        ASSERT_GOOD(&found);
        assert_int_equal(found.euler, 1);
        assert_int_equal(found.components, 1);
        assert_true(found.volume == cubes);
        voxels_free(&v);
    }
}

/* A cell with a facet that belongs to its neighbour as well as to the outside. */
static void test_unmatched(void **state)
{
    (void)state;
    voxels v = voxels_of(3, 1, 1, "012");
    voxels_join(&v);
    const size_t f = facet_between(&v, 0, 1);
    v.side[f][1] = 2;
    tm_examination found = examine(&v);
    /* Cell 1 sees it as it is, not turned: its four edges run alike. */
    ASSERT_ONLY(&found, {TM_UNMATCHED_FACE, 1}, {TM_UNORIENTED_EDGE, 4});
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].place[0][0], f);
    assert_int_equal(found.defect[TM_UNORIENTED_EDGE].place[0][0], 1);
    v.side[f][1] = 0;
    found = examine(&v);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 1);
    v.side[f][1] = TM_NONE;
    found = examine(&v);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 1);
    assert_int_equal(found.boundary_faces, 15);
    assert_int_equal(found.defect[TM_OPEN_EDGE].count, 4);
    assert_int_equal(found.defect[TM_NON_MANIFOLD_EDGE].count, 4);
    voxels_free(&v);
}

/* A cell that names one facet twice and another not at all. */
static void test_unclosed(void **state)
{
    (void)state;
    voxels v = voxels_of(1, 1, 1, "0");
    voxels_join(&v);
    v.cell_facet[0] = v.cell_facet[1];
    const tm_examination found = examine(&v);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 2);
    assert_true(found.defect[TM_UNCLOSED_EDGE].count >= 4);
    voxels_free(&v);
}

static void swap(uint32_t *a, uint32_t *b)
{
    const uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

/* A facet that turns the wrong way round; all of them. */
static void test_turned(void **state)
{
    (void)state;
    voxels v = voxels_of(1, 1, 1, "0");
    voxels_join(&v);
    swap(&v.facet_node[0], &v.facet_node[2]);
    tm_examination found = examine(&v);
    ASSERT_ONLY(&found, {TM_UNORIENTED_EDGE, 4});
    for (uint32_t f = 1; f < 6; f++)
        swap(&v.facet_node[4 * f], &v.facet_node[4 * f + 2]);
    found = examine(&v);
    ASSERT_ONLY(&found, {TM_INVERTED, 1});
    assert_true(found.volume == -1);
    for (size_t i = 0; i < v.mesh.nodes; i++)
        v.xyz[i][2] = 0;
    found = examine(&v);
    ASSERT_ONLY(&found, {TM_DEGENERATE, 1}, {TM_DUPLICATE_NODE, 4});
    assert_int_equal(found.defect[TM_DEGENERATE].place[0][1], TM_NONE);
    voxels_free(&v);
}

static void test_node_twice(void **state)
{
    (void)state;
    voxels v = voxels_of(1, 1, 1, "0");
    voxels_join(&v);
    v.facet_node[2] = v.facet_node[0];
    const tm_examination found = examine(&v);
    assert_int_equal(found.defect[TM_DEGENERATE].count, 1);
    assert_int_equal(found.defect[TM_DEGENERATE].place[0][0], 0);
    assert_int_equal(found.defect[TM_DEGENERATE].place[0][1], v.facet_node[0]);
    assert_int_equal(found.defect[TM_DEGENERATE].place[0][2], 1);
    voxels_free(&v);
}

/* Two rows of .facet between two cells, each seen as a boundary. */
static void test_repeated(void **state)
{
    (void)state;
    voxels v = voxels_of(2, 1, 1, "01");
    voxels_join(&v);
    const size_t f = facet_between(&v, 0, 1), g = v.mesh.facets++;
    v.side[f][1] = TM_NONE;
    v.side[g][0] = 1;
    v.side[g][1] = TM_NONE;
    static const size_t turned[4] = {1, 0, 3, 2};
    for (size_t i = 0; i < 4; i++)
        v.facet_node[4 * g + i] = v.facet_node[4 * f + turned[i]];
    v.facet_start[g + 1] = 4 * (g + 1);
    for (size_t i = v.cell_start[1]; i < v.cell_start[2]; i++)
        if (v.cell_facet[i] == f)
            v.cell_facet[i] = (uint32_t)g;
    const tm_examination found = examine(&v);
    ASSERT_ONLY(&found, {TM_REPEATED_FACE, 1}, {TM_NON_MANIFOLD_EDGE, 4});
    assert_int_equal(found.defect[TM_REPEATED_FACE].place[0][0], g);
    assert_int_equal(found.defect[TM_REPEATED_FACE].place[0][1], f);
    assert_int_equal(found.components, 2);
    voxels_free(&v);
}

/* The boundary touches itself; the cells are good. */
static void test_contacts(void **state)
{
    (void)state;
    voxels v = voxels_of(2, 2, 1, "0..1");
    voxels_join(&v);
    tm_examination found = examine(&v);
    ASSERT_ONLY(&found, {TM_NON_MANIFOLD_EDGE, 1});
    voxels_free(&v);
    v = voxels_of(2, 2, 2, "0......1");
    voxels_join(&v);
    found = examine(&v);
    ASSERT_ONLY(&found, {TM_NON_MANIFOLD_VERTEX, 1});
    assert_int_equal(found.defect[TM_NON_MANIFOLD_VERTEX].place[0][1], 2);
    voxels_free(&v);
}

/* A tetrahedron so flat that only the exact sign tells, either way. */
static void test_exact_sign(void **state)
{
    (void)state;
    static const double xyz[4][3] = {
        {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0x1p-80}};
    static const uint32_t side[4][2] = {
        {0, TM_NONE}, {0, TM_NONE}, {0, TM_NONE}, {0, TM_NONE}};
    static const size_t facet_start[] = {0, 3, 6, 9, 12}, cell_start[] = {0, 4};
    static const uint32_t facet_node[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    static const uint32_t cell_facet[] = {0, 1, 2, 3};
    double moved[4][3];
    memcpy(moved, xyz, sizeof moved);
    const tm_poly_arrays mesh = {.nodes = 4,
                                 .xyz = (const double(*)[3])moved,
                                 .facets = 4,
                                 .side = side,
                                 .facet_start = facet_start,
                                 .facet_node = facet_node,
                                 .cells = 1,
                                 .cell_start = cell_start,
                                 .cell_facet = cell_facet};
    tm_examination found;
    for (int sign = -1; sign <= 1; sign++) {
        moved[3][2] = sign * xyz[3][2];
        assert_int_equal(tm_poly_examine(&found, &mesh, 1, NULL), TM_OK);
        assert_int_equal(found.defect[TM_INVERTED].count, sign < 0);
        assert_int_equal(found.defect[TM_DEGENERATE].count, sign == 0);
    }
}

static void test_threads(void **state)
{
    (void)state;
    enum { SIDE = 16 };
    voxels v = voxels_new(SIDE, SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        v.label[i] = i;
    voxels_join(&v);
    for (size_t f = 0; f < v.mesh.facets; f += 100)
        swap(&v.facet_node[4 * f], &v.facet_node[4 * f + 2]);
    for (size_t i = 0; i < v.mesh.nodes; i++)
        for (int k = 0; k < 3; k++)
            v.xyz[i][k] += random_unit() / 8;
    const tm_examination alone = examine(&v);
    assert_true(alone.defect[TM_UNORIENTED_EDGE].count > 0);
    for (unsigned threads = 2; threads < 5; threads++) {
        tm_examination found;
        assert_int_equal(tm_poly_examine(&found, &v.mesh, threads, NULL), TM_OK);
        assert_memory_equal(&found, &alone, sizeof found);
    }
    voxels_free(&v);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_simple),
        cmocka_unit_test(test_not_simple),
        cmocka_unit_test(test_not_simple_but_euler),
        cmocka_unit_test(test_good),
        cmocka_unit_test(test_random_blocks),
        cmocka_unit_test(test_unmatched),
        cmocka_unit_test(test_unclosed),
        cmocka_unit_test(test_turned),
        cmocka_unit_test(test_node_twice),
        cmocka_unit_test(test_repeated),
        cmocka_unit_test(test_contacts),
        cmocka_unit_test(test_exact_sign),
        cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
