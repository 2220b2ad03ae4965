/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every defect on the smallest mesh that has it; meshes of known shape. */
#include "../../lib/base/sum.h"
#include "../../lib/examine/element_examine.h"
#include "cube_mesh.h"
#include "random.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

/* The corner of a cube, a point on each side of its face 1 2 3, one below its base, and
 * two that are far away. */
static const double points[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},  {0, 0, 1},
                                   {1, 1, 1}, {2, 2, 2}, {0, 0, -1}, {7, 0, 0},
                                   {8, 1, 0}, {7, 1, 1}};
enum { POINTS = sizeof points / sizeof *points };

static tm_examination examine(const tm_mesh_view *mesh)
{
    tm_examination found;
    assert_int_equal(tm_element_examine(&found, mesh, 1, NULL), TM_OK);
    return found;
}

static tm_examination examine_points(const uint32_t (*tet)[4], size_t tets)
{
    return examine(&(tm_mesh_view){
        .nodes = POINTS, .xyz = points, .elements = tets, .item = tet ? tet[0] : NULL});
}

/* A kind of defects and how many of it there must be. */
typedef struct expected {
    tm_defect kind;
    size_t count;
} expected;

/* Asserts that these defects were found, and no other. */
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

static void assert_place(const tm_examination *found, tm_defect d, size_t i,
                         const uint32_t place[TM_DEFECT_NUMBERS])
{
    assert_true(i < found->defect[d].count);
    for (size_t k = 0; k < TM_DEFECT_NUMBERS; k++)
        assert_int_equal(found->defect[d].place[i][k], place[k]);
}

#define ASSERT_PLACE(found, d, i, ...)                                                   \
    assert_place(found, d, i, (const uint32_t[TM_DEFECT_NUMBERS]){__VA_ARGS__})

static bool close_to(double value, double right)
{
    const double ulps = 16;
    return fabs(value - right) <= ulps * DBL_EPSILON * fabs(right);
}

static void test_one_tetrahedron(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}};
    const tm_examination found = examine_points(tet, 1);
    ASSERT_GOOD(&found);
    assert_int_equal(found.nodes, POINTS);
    assert_int_equal(found.element_count, 1);
    assert_int_equal(found.boundary_faces, 4);
    assert_int_equal(found.components, 1);
    assert_int_equal(found.unused_nodes, POINTS - 4);
    assert_int_equal(found.euler, 1);
    assert_true(close_to(found.volume, 1.0 / 6));
    assert_true(close_to(found.area, 1.5 + sqrt(3) / 2));
}

static void test_nothing(void **state)
{
    (void)state;
    tm_examination found = examine(&(tm_mesh_view){0});
    ASSERT_GOOD(&found);
    assert_true(found.volume == 0 && found.area == 0 && found.euler == 0);
    assert_int_equal(found.components, 0);
    found = examine_points(NULL, 0);
    ASSERT_GOOD(&found);
    assert_int_equal(found.unused_nodes, POINTS);
    assert_int_equal(found.euler, 0);
}

static void test_two_neighbours(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {1, 2, 3, 5}};
    const tm_examination found = examine_points(tet, 2);
    ASSERT_GOOD(&found);
    assert_int_equal(found.boundary_faces, 6);
    assert_int_equal(found.components, 1);
    assert_int_equal(found.euler, 1);
}

static void test_inverted(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {1, 2, 3, 5}, {1, 2, 0, 6}};
    static const uint32_t left[][4] = {{0, 2, 1, 3}, {2, 1, 3, 5}, {2, 1, 0, 6}};
    tm_examination found = examine_points(tet, 3);
    ASSERT_ONLY(&found, {TM_INVERTED, 1});
    ASSERT_PLACE(&found, TM_INVERTED, 0, 2);
    /* A mesh that is left-handed throughout is inverted, but does not overlap. */
    found = examine_points(left, 3);
    ASSERT_ONLY(&found, {TM_INVERTED, 2});
    ASSERT_PLACE(&found, TM_INVERTED, 0, 0);
    ASSERT_PLACE(&found, TM_INVERTED, 1, 1);
}

static void test_flat(void **state)
{
    (void)state;
    /* Points 1 2 3 and 4, 5 are not coplanar; 0, 3, 4 and 5 are. */
    static const uint32_t tet[][4] = {{0, 3, 4, 5}};
    const tm_examination found = examine_points(tet, 1);
    ASSERT_ONLY(&found, {TM_DEGENERATE, 1});
    ASSERT_PLACE(&found, TM_DEGENERATE, 0, 0, TM_NONE);
    assert_int_equal(found.boundary_faces, 4);
    assert_true(found.volume == 0);
}

static void test_node_twice(void **state)
{
    (void)state;
    /* The second and third have no part in the mesh: 0 1 2 3 stays alone. */
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {1, 2, 3, 3}, {6, 7, 6, 6}};
    const tm_examination found = examine_points(tet, 3);
    ASSERT_ONLY(&found, {TM_DEGENERATE, 2});
    ASSERT_PLACE(&found, TM_DEGENERATE, 0, 1, 3);
    ASSERT_PLACE(&found, TM_DEGENERATE, 1, 2, 6);
    assert_int_equal(found.element_count, 3);
    assert_int_equal(found.components, 1);
    assert_int_equal(found.euler, 1);
    assert_int_equal(found.unused_nodes, POINTS - 4);
    assert_int_equal(found.boundary_faces, 4);
}

static void test_overlapping(void **state)
{
    (void)state;
    /* Points 4 and 5 are on the same side of 1 2 3. */
    static const uint32_t tet[][4] = {{1, 2, 3, 5}, {2, 1, 4, 3}};
    tm_examination found = examine_points(tet, 2);
    ASSERT_ONLY(&found, {TM_OVERLAPPING_FACE, 1});
    ASSERT_PLACE(&found, TM_OVERLAPPING_FACE, 0, 0, 1);
    /* The same with one of them listed inverted. */
    static const uint32_t inverted[][4] = {{1, 2, 3, 5}, {1, 2, 4, 3}};
    found = examine_points(inverted, 2);
    ASSERT_ONLY(&found, {TM_OVERLAPPING_FACE, 1}, {TM_INVERTED, 1});
    /* A tetrahedron that is there twice overlaps itself at its four faces. */
    static const uint32_t twice[][4] = {{0, 1, 2, 3}, {1, 2, 0, 3}};
    found = examine_points(twice, 2);
    ASSERT_ONLY(&found, {TM_OVERLAPPING_FACE, 4});
    assert_int_equal(found.boundary_faces, 0);
}

static void test_three_at_a_face(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}, {1, 2, 3, 5}};
    const tm_examination found = examine_points(tet, 3);
    /* The boundary has three faces at each edge of the common face. */
    ASSERT_ONLY(&found, {TM_UNMATCHED_FACE, 1}, {TM_OPEN_EDGE, 3},
                {TM_NON_MANIFOLD_EDGE, 3});
    ASSERT_PLACE(&found, TM_UNMATCHED_FACE, 0, 1, 2, 3, 3);
    ASSERT_PLACE(&found, TM_OPEN_EDGE, 0, 1, 2, 3);
    ASSERT_PLACE(&found, TM_NON_MANIFOLD_EDGE, 2, 2, 3, 3);
    assert_int_equal(found.boundary_faces, 9);
    assert_int_equal(found.components, 1);
}

static void test_common_edge(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {0, 1, 6, 8}};
    const tm_examination found = examine_points(tet, 2);
    ASSERT_ONLY(&found, {TM_NON_MANIFOLD_EDGE, 1});
    ASSERT_PLACE(&found, TM_NON_MANIFOLD_EDGE, 0, 0, 1, 4);
    assert_int_equal(found.components, 2);
    assert_int_equal(found.euler, 1);
}

static void test_common_vertex(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {7, 8, 9, 1}};
    static const uint32_t apart[][4] = {{0, 1, 2, 3}, {7, 8, 9, 5}};
    tm_examination found = examine_points(tet, 2);
    ASSERT_ONLY(&found, {TM_NON_MANIFOLD_VERTEX, 1}, {TM_INVERTED, 1});
    ASSERT_PLACE(&found, TM_NON_MANIFOLD_VERTEX, 0, 1, 2);
    assert_int_equal(found.components, 2);
    assert_int_equal(found.euler, 1);
    found = examine_points(apart, 2);
    ASSERT_ONLY(&found, {TM_INVERTED, 1});
    assert_int_equal(found.components, 2);
    assert_int_equal(found.euler, 2);
}

static void test_duplicate_nodes(void **state)
{
    (void)state;
    static const double xyz[][3] = {{0, 0, 0},    {1, 0, 0},       {0, 1, 0},
                                    {0, 0, 1},    {1, 0x1p-60, 0}, {-0.0, 0, -0.0},
                                    {0, -0.0, 0}, {0, 0, 1}};
    static const uint32_t tet[][4] = {{0, 1, 2, 3}};
    const tm_examination found =
        examine(&(tm_mesh_view){.nodes = 8, .xyz = xyz, .elements = 1, .item = tet[0]});
    ASSERT_ONLY(&found, {TM_DUPLICATE_NODE, 3});
    ASSERT_PLACE(&found, TM_DUPLICATE_NODE, 0, 5, 0);
    ASSERT_PLACE(&found, TM_DUPLICATE_NODE, 1, 6, 0);
    ASSERT_PLACE(&found, TM_DUPLICATE_NODE, 2, 7, 3);
}

static void test_rows_of_face_and_edge(void **state)
{
    (void)state;
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {1, 2, 3, 5}};
    /* An inner face, boundary faces, one of them again; not a face; a node twice. */
    static const uint32_t face[][3] = {{3, 1, 2}, {0, 1, 2}, {2, 5, 3}, {2, 1, 0},
                                       {0, 1, 5}, {1, 1, 2}, {7, 8, 9}, {8, 9, 7}};
    static const uint32_t edge[][2] = {{3, 2}, {0, 0}, {2, 3}, {5, 0},
                                       {0, 1}, {8, 7}, {5, 3}};
    const tm_examination found = examine(&(tm_mesh_view){.nodes = POINTS,
                                                         .xyz = points,
                                                         .elements = 2,
                                                         .item = tet[0],
                                                         .faces = 8,
                                                         .face = face,
                                                         .edges = 7,
                                                         .edge = edge});
    ASSERT_ONLY(&found, {TM_REPEATED_FACE, 2}, {TM_DANGLING_FACE, 3},
                {TM_REPEATED_EDGE, 1}, {TM_DANGLING_EDGE, 3});
    ASSERT_PLACE(&found, TM_REPEATED_FACE, 0, 3, 1);
    ASSERT_PLACE(&found, TM_REPEATED_FACE, 1, 7, 6);
    ASSERT_PLACE(&found, TM_DANGLING_FACE, 0, 4);
    ASSERT_PLACE(&found, TM_DANGLING_FACE, 1, 5);
    ASSERT_PLACE(&found, TM_DANGLING_FACE, 2, 6);
    ASSERT_PLACE(&found, TM_REPEATED_EDGE, 0, 2, 0);
    ASSERT_PLACE(&found, TM_DANGLING_EDGE, 0, 1);
    ASSERT_PLACE(&found, TM_DANGLING_EDGE, 1, 3);
    ASSERT_PLACE(&found, TM_DANGLING_EDGE, 2, 5);
    assert_int_equal(found.boundary_faces, 6);
}

static tm_examination examine_cubes(const cube_mesh *m)
{
    return examine(&(tm_mesh_view){.nodes = m->nodes,
                                   .xyz = (const double(*)[3])m->xyz,
                                   .elements = m->tets,
                                   .item = m->tet[0]});
}

static void test_cube_of_five(void **state)
{
    (void)state;
    cube_mesh m = cube_mesh_box(1, 1, 1);
    static const uint32_t tet[][4] = {
        {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 1, 4, 7}, {6, 4, 2, 7}, {1, 2, 4, 7}};
    memcpy(m.tet, tet, sizeof tet);
    m.tets = 5;
    const tm_examination found = examine_cubes(&m);
    ASSERT_GOOD(&found);
    assert_true(close_to(found.volume, 1));
    assert_true(close_to(found.area, 6));
    assert_int_equal(found.euler, 1);
    assert_int_equal(found.boundary_faces, 12);
    cube_mesh_free(&m);
}

/* Three by three cubes in a plane, or three layers of them, without the one in the
 * middle: a ring and a box with a cavity. */
static void test_ring_and_cavity(void **state)
{
    (void)state;
    static const struct {
        unsigned layers;
        int euler;
        double area;
    } shape[] = {{1, 0, 32}, {3, 2, 60}};
    for (size_t i = 0; i < 2; i++) {
        cube_mesh m = cube_mesh_box(3, 3, shape[i].layers);
        m.present[cube_mesh_cubes(&m) / 2] = false;
        cube_mesh_cut(&m);
        const tm_examination found = examine_cubes(&m);
        ASSERT_GOOD(&found);
        assert_int_equal(found.euler, shape[i].euler);
        assert_int_equal(found.components, 1);
        assert_int_equal(found.unused_nodes, 0);
        assert_true(close_to(found.area, shape[i].area));
        assert_true(close_to(found.volume, (double)cube_mesh_cubes(&m) - 1));
        cube_mesh_free(&m);
    }
}

/* Tetrahedra around a common edge: many faces meet at its ends. Without one of them the
 * edge is on the boundary. */
static void test_wide_star(void **state)
{
    (void)state;
    enum { RING = 100 };
    const double turn = 2 * acos(-1) / RING;
    static double xyz[RING + 2][3] = {[RING] = {0, 0, -1}, [RING + 1] = {0, 0, 1}};
    static uint32_t tet[RING][4];
    for (uint32_t v = 0; v < RING; v++) {
        xyz[v][0] = cos(v * turn);
        xyz[v][1] = sin(v * turn);
        memcpy(tet[v], (uint32_t[]){v, (v + 1) % RING, RING, RING + 1}, sizeof tet[v]);
    }
    tm_mesh_view mesh = {.nodes = RING + 2,
                         .xyz = (const double(*)[3])xyz,
                         .elements = RING,
                         .item = tet[0]};
    for (size_t open = 0; open < 2; open++) {
        const size_t tets = mesh.elements = RING - open;
        const tm_examination found = examine(&mesh);
        ASSERT_GOOD(&found);
        assert_int_equal(found.euler, 1);
        assert_int_equal(found.components, 1);
        assert_int_equal(found.boundary_faces, 2 * tets + 2 * open);
        assert_true(close_to(found.volume, (double)tets * sin(turn) / 3));
    }
}

/* Two cubes of a 2×2×2 box that touch in an edge, and in a vertex. */
static void test_touching_cubes(void **state)
{
    (void)state;
    cube_mesh m = cube_mesh_box(2, 2, 2);
    memset(m.present, false, cube_mesh_cubes(&m));
    m.present[0] = m.present[3] = true;
    cube_mesh_cut(&m);
    tm_examination found = examine_cubes(&m);
    ASSERT_ONLY(&found, {TM_NON_MANIFOLD_EDGE, 1});
    m.present[3] = false;
    m.present[7] = true;
    cube_mesh_cut(&m);
    found = examine_cubes(&m);
    ASSERT_ONLY(&found, {TM_NON_MANIFOLD_VERTEX, 1});
    ASSERT_PLACE(&found, TM_NON_MANIFOLD_VERTEX, 0, 13, 2);
    assert_int_equal(found.unused_nodes, 27 - 15);
    cube_mesh_free(&m);
}

/* Renumbers nodes and tetrahedra at random. */
static void shuffle(cube_mesh *m)
{
    uint32_t *number = malloc(m->nodes * sizeof *number);
    for (uint32_t v = 0; v < m->nodes; v++)
        number[v] = v;
    for (uint32_t v = (uint32_t)m->nodes - 1; v > 0; v--) {
        const uint32_t u = random_below(v + 1), old = number[v];
        double xyz[3];
        number[v] = number[u];
        number[u] = old;
        memcpy(xyz, m->xyz[v], sizeof xyz);
        memcpy(m->xyz[v], m->xyz[u], sizeof xyz);
        memcpy(m->xyz[u], xyz, sizeof xyz);
    }
    uint32_t *place = malloc(m->nodes * sizeof *place);
    for (uint32_t v = 0; v < m->nodes; v++)
        place[number[v]] = v;
    for (size_t t = m->tets; t-- > 0;) {
        const size_t u = random_below((unsigned)t + 1);
        uint32_t tet[4];
        memcpy(tet, m->tet[u], sizeof tet);
        memcpy(m->tet[u], m->tet[t], sizeof tet);
        for (size_t i = 0; i < 4; i++)
            m->tet[t][i] = place[tet[i]];
    }
    free(number);
    free(place);
}

static void test_random_cubes(void **state)
{
    (void)state;
    enum { ROUNDS = 100, SIDE = 6 };
    for (size_t round = 0; round < ROUNDS; round++) {
        cube_mesh m = cube_mesh_box(1 + random_below(SIDE), 1 + random_below(SIDE),
                                    1 + random_below(SIDE));
        const unsigned missing = random_below(4);
        size_t cubes = 0;
        for (size_t i = 0; i < cube_mesh_cubes(&m); i++) {
            m.present[i] = random_below(4) >= missing;
            cubes += m.present[i];
        }
        cube_mesh_cut(&m);
        shuffle(&m);
        const tm_examination found = examine_cubes(&m);
        assert_int_equal(found.euler, cube_mesh_euler(&m));
        assert_int_equal(found.boundary_faces, 2 * cube_mesh_exposed(&m));
        assert_true(close_to(found.volume, (double)cubes));
        assert_true(close_to(found.area, (double)cube_mesh_exposed(&m)));
        static const tm_defect never[] = {TM_INVERTED,         TM_DEGENERATE,
                                          TM_UNMATCHED_FACE,   TM_OPEN_EDGE,
                                          TM_OVERLAPPING_FACE, TM_DUPLICATE_NODE};
        for (size_t i = 0; i < sizeof never / sizeof *never; i++)
            assert_int_equal(found.defect[never[i]].count, 0);
        if (missing == 0)
            ASSERT_GOOD(&found);
        cube_mesh_free(&m);
    }
}

/* A box with its planes at random distances: the sums are as good as the products. */
static void test_sums(void **state)
{
    (void)state;
    enum { SIDE = 24, PLANES = SIDE + 1 };
    cube_mesh m = cube_mesh_box(SIDE, SIDE, SIDE);
    double plane[3][PLANES];
    for (size_t i = 0; i < 3; i++) {
        plane[i][0] = random_unit() - 1;
        for (size_t k = 1; k < PLANES; k++)
            plane[i][k] = plane[i][k - 1] + 0x1p-10 + random_unit();
    }
    for (size_t v = 0; v < m.nodes; v++)
        for (size_t i = 0; i < 3; i++)
            m.xyz[v][i] = plane[i][(size_t)m.xyz[v][i]];
    cube_mesh_cut(&m);
    shuffle(&m);
    const tm_examination found = examine_cubes(&m);
    double side[3];
    for (size_t i = 0; i < 3; i++)
        side[i] = plane[i][SIDE] - plane[i][0];
    ASSERT_GOOD(&found);
    assert_true(close_to(found.volume, side[0] * side[1] * side[2]));
    assert_true(close_to(
        found.area, 2 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0])));
    cube_mesh_free(&m);

    tm_sum sum = {0};
    tm_sum_add(&sum, 0x1p60);
    for (int i = 0; i < 1000; i++)
        tm_sum_add(&sum, 1);
    tm_sum_add(&sum, -0x1p60);
    assert_true(tm_sum_value(sum) == 1000);
    tm_sum_add(&sum, DBL_MAX);
    tm_sum_add(&sum, DBL_MAX);
    assert_true(isinf(tm_sum_value(sum)));
}

static void test_threads(void **state)
{
    (void)state;
    enum { SIDE = 20, INVERTED = 40 };
    cube_mesh m = cube_mesh_box(SIDE, SIDE, SIDE);
    cube_mesh_cut(&m);
    shuffle(&m);
    for (size_t i = 0; i < INVERTED; i++) {
        uint32_t *n = m.tet[m.tets - 1 - i * m.tets / INVERTED];
        const uint32_t first = n[0];
        n[0] = n[1];
        n[1] = first;
    }
    const tm_mesh_view mesh = {.nodes = m.nodes,
                               .xyz = (const double(*)[3])m.xyz,
                               .elements = m.tets,
                               .item = m.tet[0]};
    const tm_examination alone = examine(&mesh);
    ASSERT_ONLY(&alone, {TM_INVERTED, INVERTED});
    for (size_t i = 0; i < TM_DEFECTS_LISTED; i++)
        ASSERT_PLACE(&alone, TM_INVERTED, i,
                     (uint32_t)(m.tets - 1 - (INVERTED - 1 - i) * m.tets / INVERTED));
    for (unsigned threads = 2; threads < 6; threads++) {
        tm_examination found;
        assert_int_equal(tm_element_examine(&found, &mesh, threads, NULL), TM_OK);
        assert_memory_equal(&found, &alone, sizeof found);
    }
    cube_mesh_free(&m);
}

static void test_places(void **state)
{
    (void)state;
    static const uint32_t order[] = {9, 4, 7, 1, 8, 2, 6, 3, 5, 0};
    tm_defect_list list = {0}, more = {0};
    for (size_t i = 0; i < 4; i++)
        tm_defect_add(&list, (uint32_t[TM_DEFECT_NUMBERS]){1, order[i]});
    for (size_t i = 4; i < 10; i++)
        tm_defect_add(&more, (uint32_t[TM_DEFECT_NUMBERS]){1, order[i]});
    tm_defect_add_list(&list, &more);
    assert_int_equal(list.count, 10);
    for (uint32_t i = 0; i < TM_DEFECTS_LISTED; i++)
        assert_int_equal(list.place[i][1], i);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_tetrahedron),
        cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_two_neighbours),
        cmocka_unit_test(test_inverted),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_node_twice),
        cmocka_unit_test(test_overlapping),
        cmocka_unit_test(test_three_at_a_face),
        cmocka_unit_test(test_common_edge),
        cmocka_unit_test(test_common_vertex),
        cmocka_unit_test(test_duplicate_nodes),
        cmocka_unit_test(test_rows_of_face_and_edge),
        cmocka_unit_test(test_cube_of_five),
        cmocka_unit_test(test_ring_and_cavity),
        cmocka_unit_test(test_wide_star),
        cmocka_unit_test(test_touching_cubes),
        cmocka_unit_test(test_random_cubes),
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_places),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
