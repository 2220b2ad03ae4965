/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search for the best tetrahedralisation of a cavity: of random cavities of small
 * meshes, against a search that tries everything; what it finds is put into the mesh,
 * which is checked in full. */
#include "../../lib/tet/operation/cavity_search.h"
#include "tet_fixture.h"

enum { GRID = 3, STEPS_MOST = 100000, FEW_STEPS = 1000, SMALL = 8 };

static const double looseness = 0.5;

/* A cavity around a random tetrahedron: up to so many, each beside one before. */
static void grow_randomly(const tm_tet_mesh *mesh, tm_tet_marks *marks, size_t most,
                          tm_cavity *cavity)
{
    enum { TRIES = 40 };
    uint32_t t;
    do
        t = random_below((unsigned)mesh->slots);
    while (!tm_tet_lives(mesh, t));
    assert_true(tm_cavity_start(cavity, mesh, marks));
    assert_true(tm_cavity_add(cavity, mesh, marks, t));
    for (int k = 0; k < TRIES && cavity->size < most; k++) {
        uint32_t beyond = cavity->beyond[random_below((unsigned)cavity->faces)];
        if (!(beyond & TM_FACE_BIT))
            assert_true(tm_cavity_add(cavity, mesh, marks, beyond / 4));
    }
}

static double measure(const double (*x)[3], uint32_t a, uint32_t b, uint32_t c,
                      uint32_t d)
{
    return tm_tet_sine2(x[a], x[b], x[c], x[d]);
}

/* What the tetrahedra of the cavity cost, and the worst of them. */
static double old_cost(const tm_tet_mesh *mesh, const tm_cavity *cavity,
                       const tm_cost *cost, double *worst)
{
    double sum = 0;
    *worst = 1;
    for (size_t k = 0; k < cavity->size; k++) {
        const uint32_t *n = mesh->tet[cavity->tet[k]];
        double quality = measure((const double(*)[3])mesh->xyz, n[0], n[1], n[2], n[3]);
        *worst = fmin(*worst, quality);
        sum += tm_cost_of(cost, quality);
    }
    return sum;
}

/* Faces that are left to fill: each as often as it occurs. */
typedef struct {
    size_t count;
    uint32_t face[200][3];
} faces_left;

static bool is_same_face(const uint32_t n[3], uint32_t a, uint32_t b, uint32_t c)
{
    return (n[0] == a && n[1] == b && n[2] == c) ||
           (n[1] == a && n[2] == b && n[0] == c) || (n[2] == a && n[0] == b && n[1] == c);
}

/* The least cost of all ways to fill: the first face is joined to each node. It costs
 * less than `most`, or HUGE_VAL is returned. */
static double try_all(const tm_cavity_search *s, const tm_cost *cost, double least,
                      const faces_left *left, double sum, double most, int depth)
{
    if (left->count == 0)
        return sum;
    if (depth == 0)
        return HUGE_VAL;
    double best = HUGE_VAL;
    const uint32_t *n = left->face[0];
    for (uint32_t v = 0; v < s->nodes; v++) {
        if (tm_orient3d(s->xyz[n[0]], s->xyz[n[1]], s->xyz[n[2]], s->xyz[v]) <= 0)
            continue;
        double quality = tm_cost_quality(cost, least, s->xyz[n[0]], s->xyz[n[1]],
                                         s->xyz[n[2]], s->xyz[v]);
        if (quality < least)
            continue;
        double more = sum + tm_cost_of(cost, quality);
        if (more >= most)
            continue;
        faces_left next = *left;
        memcpy(next.face[0], next.face[--next.count], sizeof next.face[0]);
        for (int k = 0; k < 3; k++) {
            uint32_t x = n[k], y = n[(k + 1) % 3];
            size_t i = 0;
            while (i < next.count && !is_same_face(next.face[i], y, x, v))
                i++;
            if (i < next.count)
                memcpy(next.face[i], next.face[--next.count], sizeof next.face[0]);
            else
                memcpy(next.face[next.count++], (uint32_t[3]){x, y, v},
                       sizeof next.face[0]);
        }
        double filled = try_all(s, cost, least, &next, more, most, depth - 1);
        best = fmin(best, filled);
        most = fmin(most, filled);
    }
    return best;
}

static double best_of_all(const tm_cavity_search *s, const tm_cost *cost, double least,
                          double most)
{
    enum { DEPTH = 16 };
    faces_left left = {.count = s->faces};
    for (size_t f = 0; f < s->faces; f++)
        for (int k = 0; k < 3; k++)
            left.face[f][k] = s->face[f][k];
    return try_all(s, cost, least, &left, 0, most, DEPTH);
}

/* What was found is positive, costs what is said and has the cavity's volume. */
static void check_found(const tm_cavity_search *s, const tm_cost *cost, double least)
{
    double filled = 0, volume = 0, sum = 0;
    for (size_t f = 0; f < s->faces; f++)
        volume += tm_tet_volume(s->xyz[s->face[f][0]], s->xyz[s->face[f][1]],
                                s->xyz[s->face[f][2]], s->xyz[0]);
    for (size_t t = 0; t < s->tets; t++) {
        const uint8_t *n = s->tet[t];
        const double(*x)[3] = s->xyz;
        assert_int_equal(tm_orient3d(x[n[0]], x[n[1]], x[n[2]], x[n[3]]), 1);
        double quality = measure(x, n[0], n[1], n[2], n[3]);
        assert_true(quality >= least);
        sum += tm_cost_of(cost, quality);
        filled += tm_tet_volume(x[n[0]], x[n[1]], x[n[2]], x[n[3]]);
    }
    assert_true(fabs(filled - volume) <= 1e-12 * volume);
    assert_true(fabs(sum - s->cost) <= 1e-9);
}

/* Replaces the cavity by what was found; its nodes inside have to be used. */
static bool replace(tm_tet_mesh *mesh, const tm_cavity *cavity, const tm_cavity_search *s,
                    tm_replacement_table *table)
{
    uint32_t node[TM_SEARCH_TETS][4], created[TM_SEARCH_TETS], used = 0;
    for (size_t t = 0; t < s->tets; t++)
        for (int k = 0; k < 4; k++) {
            node[t][k] = s->label[s->tet[t][k]];
            used |= (uint32_t)1 << s->tet[t][k];
        }
    if (used + 1 != (uint32_t)1 << s->nodes)
        return false;
    tm_replacement what = {.old = cavity->tet,
                           .old_count = cavity->size,
                           .node = (const uint32_t(*)[4])node,
                           .count = s->tets,
                           .created = created};
    assert_int_equal(tm_tet_replace(mesh, &what, table, NULL), TM_OK);
    return true;
}

static bool has_marked_edge(const tm_tet_mesh *mesh, const tm_cavity *cavity)
{
    for (size_t k = 0; k < cavity->size; k++)
        for (int e = 0; e < TM_TET_EDGES; e++) {
            const uint32_t *n = mesh->tet[cavity->tet[k]];
            const tm_marked_edge *edge =
                tm_tet_mesh_edge(mesh, n[tm_edge_corner[e][0]], n[tm_edge_corner[e][1]]);
            if (edge && edge->marker != 0)
                return true;
        }
    return false;
}

typedef struct {
    size_t found, compared, replaced;
} tally;

/* One cavity of up to so many tetrahedra: the best that costs less than it does. */
static void search_one(tm_tet_mesh *mesh, size_t tets, tm_cavity_search *s, tally *done)
{
    static tm_tet_marks marks;
    tm_cavity cavity = {0};
    tm_replacement_table table = {0};
    tm_cost cost = {.measure = TM_MEASURE_DIHEDRAL,
                    .target = tm_bad_sine2(60),
                    .weight = 3,
                    .limits = tm_angle_limits_none()};
    cost.limits.least = 0, cost.limits.most = 180, cost.limits.safe = 0;
    double worst;
    grow_randomly(mesh, &marks, tets, &cavity);
    double old = old_cost(mesh, &cavity, &cost, &worst);
    double least = worst * looseness, most = old - 1e-9;
    if (tm_cavity_search_load(s, mesh, &cavity)) {
        bool is_small = s->nodes <= SMALL;
        bool found = tm_cavity_search_run(s, &cost, least, most,
                                          is_small ? STEPS_MOST : FEW_STEPS);
        if (is_small) {
            double best = best_of_all(s, &cost, least, most);
            assert_int_equal(found, best < HUGE_VAL);
            assert_true(!found || fabs(s->cost - best) <= 1e-9);
            done->compared += found;
        }
        if (found) {
            check_found(s, &cost, least);
            done->found++;
            invariants before = measure_invariants(mesh);
            if (!has_marked_edge(mesh, &cavity) && replace(mesh, &cavity, s, &table)) {
                assert_valid(mesh);
                invariants after = measure_invariants(mesh);
                assert_same_invariants(&before, &after);
                done->replaced++;
            }
        }
    }
    tm_cavity_free(&cavity);
    tm_replacement_table_free(&table);
}

static void search_on(bool regions)
{
    enum { CAVITIES = 300, SIZES = 20, MESHES = 40, ENOUGH = 10 };
    tally done = {0};
    tm_cavity_search *s = malloc(sizeof *s);
    assert_non_null(s);
    for (int k = 0; k < MESHES && (done.compared < ENOUGH || done.replaced < ENOUGH);
         k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, GRID, 0.9, regions);
        for (int i = 0; i < CAVITIES; i++)
            search_one(&mesh, 2 + random_below(SIZES), s, &done);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
    assert_true(done.compared >= ENOUGH && done.replaced >= ENOUGH);
    free(s);
}

static void test_cavities(void **state)
{
    (void)state;
    search_on(false);
}

static void test_cavities_with_regions(void **state)
{
    (void)state;
    search_on(true);
}

/* Schönhardt's prism cannot be filled without a node inside; with one it can. */
static void test_schoenhardt(void **state)
{
    (void)state;
    static const uint8_t face[8][3] = {{0, 1, 2}, {3, 5, 4}, {0, 4, 1}, {0, 3, 4},
                                       {1, 5, 2}, {1, 4, 5}, {2, 3, 0}, {2, 5, 3}};
    const double turn = 8 * atan(1), twist = turn / 12;
    tm_cavity_search *s = malloc(sizeof *s);
    assert_non_null(s);
    s->nodes = s->outer_nodes = 6;
    s->faces = sizeof face / sizeof face[0];
    memcpy(s->face, face, sizeof face);
    for (int i = 0; i < 6; i++) {
        double angle = turn * (i % 3) / 3 + (i < 3 ? 0 : twist);
        s->xyz[i][0] = cos(angle), s->xyz[i][1] = sin(angle), s->xyz[i][2] = i >= 3;
    }
    memcpy(s->xyz[6], (double[3]){0, 0, 0.5}, sizeof s->xyz[6]);
    tm_cost cost = {.measure = TM_MEASURE_DIHEDRAL,
                    .target = tm_bad_sine2(60),
                    .weight = 3,
                    .limits = {.least = 0, .most = 180, .safe = 0}};
    assert_false(tm_cavity_search_run(s, &cost, 1e-12, HUGE_VAL, STEPS_MOST));
    s->nodes = 7;
    assert_true(tm_cavity_search_run(s, &cost, 1e-12, HUGE_VAL, STEPS_MOST));
    assert_int_equal(s->tets, 8);
    check_found(s, &cost, 1e-12);
    free(s);
}

/* No more steps than allowed, and what is found then is valid. */
static void test_limit(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_tet_marks marks = {0};
    tm_cavity cavity = {0};
    tm_cavity_search *s = malloc(sizeof *s);
    assert_non_null(s);
    make_mesh(&mesh, &stream, GRID, 0.9, false);
    tm_cost cost = {.measure = TM_MEASURE_DIHEDRAL,
                    .target = tm_bad_sine2(60),
                    .weight = 3,
                    .limits = {.least = 0, .most = 180, .safe = 0}};
    for (size_t steps = 0; steps < 200; steps++) {
        grow_randomly(&mesh, &marks, 24, &cavity);
        if (!tm_cavity_search_load(s, &mesh, &cavity))
            continue;
        if (tm_cavity_search_run(s, &cost, 1e-12, HUGE_VAL, steps))
            check_found(s, &cost, 1e-12);
        assert_true(s->steps <= steps);
    }
    tm_cavity_free(&cavity);
    tm_tet_marks_free(&marks);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
    free(s);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cavities),
        cmocka_unit_test(test_cavities_with_regions),
        cmocka_unit_test(test_schoenhardt),
        cmocka_unit_test(test_limit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
