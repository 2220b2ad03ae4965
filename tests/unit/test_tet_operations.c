/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh, stars, edge removal and insertion: the mesh is checked in full before and
 * after each of many random operations. */
#include "../../lib/tet/operation/edge_removal.h"
#include "../../lib/tet/operation/star_insertion.h"
#include "tet_fixture.h"

enum { OPERATIONS = 400, GRID = 3, EDGES = 6 };

/* A random living tetrahedron. */
static uint32_t random_tet(const tm_tet_mesh *mesh)
{
    uint32_t t;
    do
        t = random_below((unsigned)mesh->slots);
    while (!tm_tet_lives(mesh, t));
    return t;
}

/* What star.h promises of a star, against a search of all tetrahedra. */
static void check_star(const tm_tet_mesh *mesh, const tm_star *star)
{
    size_t around = 0;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        int hits = 0;
        for (int i = 0; i < 4 && tm_tet_lives(mesh, t); i++)
            hits += n[i] == star->a || n[i] == star->b;
        around += hits == 2;
    }
    assert_int_equal(around, star->size);
    for (size_t i = 0; i < star->size; i++) {
        assert_int_equal(tm_orient3d(mesh->xyz[star->a], mesh->xyz[star->b],
                                     mesh->xyz[star->ring[i]],
                                     mesh->xyz[star->ring[i + 1]]),
                         1);
        uint32_t expected[4] = {star->a, star->b, star->ring[i], star->ring[i + 1]};
        for (int k = 0; k < 4; k++)
            assert_int_equal(
                mesh->tet[star->tet[i]][tm_tet_corner(mesh, star->tet[i], expected[k])],
                expected[k]);
        const uint8_t *end = tm_edge_corner[star->edge[i]];
        uint32_t v = mesh->tet[star->tet[i]][end[0]];
        uint32_t w = mesh->tet[star->tet[i]][end[1]];
        assert_true((v == star->a && w == star->b) || (v == star->b && w == star->a));
    }
    if (star->closed)
        assert_int_equal(star->ring[0], star->ring[star->size]);
    else
        assert_true(star->constrained_face);
}

/* One random operation; whether there was one to do. */
static bool operate(tm_tet_mesh *mesh, tm_star *star, tm_edge_removal *removal,
                    uint32_t *created)
{
    uint32_t t = random_tet(mesh);
    double p[3];
    assert_true(tm_star_around(mesh, t, random_below(EDGES), star));
    check_star(mesh, star);
    bool is_free = tm_star_is_free(mesh, star);
    if (random_below(2) && is_free && tm_edge_is_removable(star)) {
        if (!tm_edge_removal_plan(mesh, star, TM_MEASURE_DIHEDRAL, 1e-6, removal))
            return false;
        size_t before = mesh->tets;
        assert_int_equal(tm_edge_removal_apply(mesh, star, removal, created, NULL),
                         TM_OK);
        assert_int_equal(mesh->tets, before + star->size - 4);
        return true;
    }
    bool on_edge = !is_free || random_below(2);
    if (on_edge)
        tm_star_midpoint(mesh, star, p);
    else
        tm_star_centroid(mesh, star, p);
    if (!tm_star_sees(mesh, star, p))
        return false;
    assert_true(tm_star_contains(mesh, star, p) || on_edge);
    size_t before = mesh->tets;
    assert_int_equal(tm_star_insert(mesh, star, p, on_edge, created, NULL), TM_OK);
    assert_int_equal(mesh->tets, before + star->size);
    return true;
}

static void operate_on(bool regions)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_star star = {0};
    tm_edge_removal *removal = malloc(sizeof *removal);
    uint32_t *created = malloc(sizeof *created * 1000);
    assert_non_null(removal);
    assert_non_null(created);
    make_mesh(&mesh, &stream, GRID, 0.5, regions);
    invariants before = measure_invariants(&mesh);
    int done = 0;
    for (int k = 0; k < OPERATIONS; k++) {
        if (!operate(&mesh, &star, removal, created))
            continue;
        done++;
        assert_valid(&mesh);
        invariants after = measure_invariants(&mesh);
        assert_same_invariants(&before, &after);
    }
    assert_true(done > OPERATIONS / 10);
    assert_int_equal(tm_tet_mesh_to_stream(&mesh, &stream, NULL), TM_OK);
    tm_error error = {0};
    if (tm_tet_mesh_from_stream(&mesh, &stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(&mesh);
    invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
    tm_star_free(&star);
    free(removal);
    free(created);
}

static void test_operations(void **state)
{
    (void)state;
    operate_on(false);
}

static void test_operations_with_regions(void **state)
{
    (void)state;
    operate_on(true);
}

/* The best triangulation by trying all of them. */
static double best_of_all(const tm_tet_mesh *mesh, const tm_star *star, size_t i,
                          size_t j)
{
    if (j - i < 2)
        return HUGE_VAL;
    double best = 0;
    for (size_t k = i + 1; k < j; k++) {
        const double *x = mesh->xyz[star->ring[i]], *y = mesh->xyz[star->ring[k]];
        const double *z = mesh->xyz[star->ring[j]];
        double q = fmin(tm_tet_sine2(x, y, z, mesh->xyz[star->b]),
                        tm_tet_sine2(x, z, y, mesh->xyz[star->a]));
        q = fmin(q, fmin(best_of_all(mesh, star, i, k), best_of_all(mesh, star, k, j)));
        best = fmax(best, q);
    }
    return best;
}

/* The first `tets` of n tetrahedra around an edge, with a random ring; checked to be
 * positive. */
static bool random_star(tm_stream *stream, tm_tet_mesh *mesh, size_t n, size_t tets)
{
    tm_stream_init(stream);
    tm_stream_add(stream, ".node");
    tm_stream_add(stream, ".ele");
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *ele = tm_stream_find(stream, ".ele");
    assert_int_equal(tm_block_allocate(node, n + 2, 0, NULL), TM_OK);
    assert_int_equal(tm_block_allocate(ele, tets, 0, NULL), TM_OK);
    const double turn = 8 * atan(1);
    node->real[2] = -1 - random_unit();
    node->real[5] = 1 + random_unit();
    for (size_t i = 0; i < n; i++) {
        double angle = turn * ((double)i + 0.5 * random_unit()) / (double)n;
        double r = 0.5 + random_unit();
        double *p = node->real + 3 * (i + 2);
        p[0] = r * cos(angle), p[1] = r * sin(angle), p[2] = 0.4 * random_unit();
        if (i >= tets)
            continue;
        uint32_t *t = ele->integer + 4 * i;
        t[0] = 0, t[1] = 1, t[2] = (uint32_t)i + 2, t[3] = (uint32_t)((i + 1) % n) + 2;
    }
    if (!all_positive(node, ele)) {
        tm_stream_free(stream);
        return false;
    }
    assert_int_equal(tm_tet_mesh_from_stream(mesh, stream, 1, NULL), TM_OK);
    return true;
}

static void test_best_removal(void **state)
{
    (void)state;
    enum { LARGEST = 9, TIMES = 40 };
    tm_star star = {0};
    tm_edge_removal *removal = malloc(sizeof *removal);
    uint32_t created[2 * LARGEST];
    size_t found = 0;
    for (size_t n = 3; n <= LARGEST; n++)
        for (int k = 0; k < TIMES; k++) {
            tm_stream stream;
            tm_tet_mesh mesh;
            if (!random_star(&stream, &mesh, n, n))
                continue;
            assert_true(tm_star_around(&mesh, 0, 0, &star));
            assert_true(star.closed && star.size == n);
            double best = best_of_all(&mesh, &star, 0, n - 1);
            bool done =
                tm_edge_removal_plan(&mesh, &star, TM_MEASURE_DIHEDRAL, 1e-9, removal);
            assert_int_equal(done, best >= 1e-9);
            if (done) {
                found++;
                assert_true(fabs(removal->quality - best) <= 1e-12 * best);
                assert_false(tm_edge_removal_plan(&mesh, &star, TM_MEASURE_DIHEDRAL,
                                                  best * 1.001, removal));
                assert_true(tm_edge_removal_plan(&mesh, &star, TM_MEASURE_DIHEDRAL,
                                                 best * 0.999, removal));
                assert_int_equal(
                    tm_edge_removal_apply(&mesh, &star, removal, created, NULL), TM_OK);
                assert_valid(&mesh);
                assert_int_equal(mesh.tets, 2 * n - 4);
            }
            tm_tet_mesh_free(&mesh);
            tm_stream_free(&stream);
        }
    assert_true(found > TIMES);
    tm_star_free(&star);
    free(removal);
}

/* Both at once say what each says, of random points near the edge. */
static void check_insertion(const tm_tet_mesh *mesh, const tm_star *star)
{
    for (int k = 0; k < 20; k++) {
        double scale = 0.5 * random_unit(), quality;
        double p[3] = {scale * (random_unit() - 0.5), scale * (random_unit() - 0.5),
                       random_unit() - 0.5};
        double least = random_below(2) ? 1e-9 : 0.1 * random_unit();
        bool sees = tm_star_sees(mesh, star, p);
        double expected =
            tm_star_insertion_quality(mesh, star, p, TM_MEASURE_DIHEDRAL, least);
        assert_int_equal(
            tm_star_try_insertion(mesh, star, p, TM_MEASURE_DIHEDRAL, least, &quality),
            sees);
        if (sees)
            assert_true(quality == expected);
    }
}

/* Closed and open stars of all sizes, walked from each of their tetrahedra. */
static void test_stars_of_all_sizes(void **state)
{
    (void)state;
    enum { LARGEST = 130 };
    size_t found[2] = {0, 0};
    for (size_t n = 3; n <= LARGEST; n++)
        for (size_t missing = 0; missing < 3 && missing + 1 < n; missing++) {
            tm_stream stream;
            tm_tet_mesh mesh;
            if (!random_star(&stream, &mesh, n, n - missing))
                continue;
            for (uint32_t t = 0; t < mesh.slots; t++) {
                tm_star star = {0}; /* new: its room has to grow */
                unsigned e = 0;
                while (mesh.tet[t][tm_edge_corner[e][0]] > 1 ||
                       mesh.tet[t][tm_edge_corner[e][1]] > 1)
                    e++;
                assert_true(tm_star_around(&mesh, t, e, &star));
                assert_int_equal(star.closed, missing == 0);
                assert_true(missing > 0 || star.tet[0] == t);
                check_star(&mesh, &star);
                if (t == 0)
                    check_insertion(&mesh, &star);
                tm_star_free(&star);
            }
            found[missing > 0]++;
            tm_tet_mesh_free(&mesh);
            tm_stream_free(&stream);
        }
    assert_true(found[0] > 20 && found[1] > 20);
}

static void test_edge_map(void **state)
{
    (void)state;
    enum { NODES = 40, STEPS = 20000 };
    tm_edge_map map = {0};
    static uint32_t expected[NODES][NODES];
    size_t count = 0;
    memset(expected, 0, sizeof expected);
    for (uint32_t k = 1; k <= STEPS; k++) {
        uint32_t a = random_below(NODES), b = random_below(NODES);
        if (a >= b)
            continue;
        const uint32_t *value = tm_edge_map_get(&map, b, a);
        assert_int_equal(value ? *value : 0, expected[a][b]);
        bool put = random_below(3) == 0;
        count -= expected[a][b] != 0;
        expected[a][b] = put ? k : 0;
        count += put;
        assert_true(tm_edge_map_reserve(&map, 1));
        if (put)
            tm_edge_map_put(&map, b, a, k);
        else
            tm_edge_map_remove(&map, b, a);
        assert_int_equal(map.count, count);
    }
    tm_edge_map_free(&map);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edge_map), cmocka_unit_test(test_best_removal),
        cmocka_unit_test(test_stars_of_all_sizes), cmocka_unit_test(test_operations),
        cmocka_unit_test(test_operations_with_regions)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
