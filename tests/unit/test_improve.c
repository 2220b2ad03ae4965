/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver: the mesh is checked in full after each operation on small random meshes,
 * and what must not change is compared. */
#include "../../lib/element/tet_quality.h"
#include "../../lib/tet/improve/improve_engine.h"
#include "tet_fixture.h"

enum { GRID = 3 };

typedef struct {
    double least, most;
} extremes;

static extremes angles_of(const tm_tet_mesh *mesh)
{
    extremes e = {180, 0};
    for (uint32_t t = 0; t < mesh->slots; t++) {
        double angle[TM_TET_EDGES];
        const uint32_t *n = mesh->tet[t];
        if (!tm_tet_lives(mesh, t))
            continue;
        tm_tet_dihedrals(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                         mesh->xyz[n[3]], angle);
        for (int i = 0; i < TM_TET_EDGES; i++) {
            e.least = fmin(e.least, angle[i]);
            e.most = fmax(e.most, angle[i]);
        }
    }
    return e;
}

/* No angle is more extreme than before, where it is below `degrees` or above 180 less
 * that. */
static void assert_no_worse(const extremes *before, const extremes *after, double degrees)
{
    const double rounding = 1e-9; /* by the order of nodes */
    assert_true(after->least >= fmin(before->least, degrees) - rounding);
    assert_true(after->most <= fmax(before->most, 180 - degrees) + rounding);
}

/* What the improver remembers is so. */
static void check_memory(const tm_improver *m)
{
    const tm_tet_mesh *mesh = m->mesh;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        if (!tm_tet_lives(mesh, t))
            continue;
        assert_true(m->quality[t] == tm_tet_measure_of(m->cost.measure, mesh->xyz[n[0]],
                                                       mesh->xyz[n[1]], mesh->xyz[n[2]],
                                                       mesh->xyz[n[3]]));
        for (int i = 0; i < 4; i++) {
            assert_true(tm_node_lives(mesh, n[i]));
            uint32_t at = m->tet_at[n[i]];
            assert_true(tm_tet_lives(mesh, at));
            assert_int_equal(mesh->tet[at][tm_tet_corner(mesh, at, n[i])], n[i]);
        }
    }
    for (uint32_t v = 0; v < mesh->nodes; v++)
        if (tm_node_lives(mesh, v) && m->features.dimension[v] == 1)
            for (int i = 0; i < 2; i++)
                assert_true(tm_node_lives(mesh, m->features.line[v][i]));
}

/* One operation on a random tetrahedron, at a random price; which, or -1. */
static int operate(tm_improver *m)
{
    uint32_t t;
    do
        t = random_below((unsigned)m->mesh->slots);
    while (!tm_tet_lives(m->mesh, t));
    tm_improve_set_price(m, 2 * random_unit() - 1);
    memset(m->smoothed, 0, m->mesh->nodes * sizeof *m->smoothed);
    m->last = random_below(2);
    switch (random_below(6)) {
    case 0:
        return tm_improve_swap(m, t) ? 0 : -1;
    case 1:
        return tm_improve_smooth(m, t) ? 1 : -1;
    case 2:
        return tm_improve_contract(m, t) ? 2 : -1;
    case 3:
        return tm_improve_peel(m, t) ? 4 : -1;
    case 4:
        return tm_improve_reconnect(m, t) ? 5 : -1;
    default:
        return m->mesh->tets < 2000 && tm_improve_insert(m, t) ? 3 : -1;
    }
}

/* Bends the grid, so that its sides are curved. */
static void bend(tm_tet_mesh *mesh)
{
    const double by = 0.05;
    for (size_t v = 0; v < mesh->nodes; v++) {
        double *p = mesh->xyz[v], x = p[0], y = p[1], z = p[2];
        p[0] += by * sin(2 * y) * cos(z);
        p[1] += by * sin(2 * z + 1) * cos(x);
        p[2] += by * sin(2 * x + 2) * cos(y);
    }
}

/* The surface is within the tolerance: what it encloses, its shape, its markers. */
static void assert_within(tm_improver *m, const invariants *before)
{
    tm_error error = {0};
    const double tolerance = m->options->surface.tolerance;
    invariants now = measure_invariants(m->mesh);
    double area = 0;
    if (tm_envelope_check(&m->features.envelope, m->mesh, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_int_equal(now.euler_boundary, before->euler_boundary);
    for (int k = 0; k < FIXTURE_MARKERS; k++)
        area += before->area[k];
    for (int r = 0; r <= FIXTURE_REGIONS; r++)
        assert_true(fabs(now.volume[r] - before->volume[r]) <= tolerance * area);
    for (int k = 0; k < FIXTURE_MARKERS; k++)
        assert_true((now.area[k] > 0) == (before->area[k] > 0));
}

/* Operations with a surface that may move. */
static void operate_within(bool regions, double tolerance, size_t done[TM_IMPROVE_OPS])
{
    enum { TRIES = 1500 };
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    tm_improve_report report;
    static tm_improver m;
    tm_improve_options options = {.angle = 30 + 30 * random_unit(),
                                  .ops = TM_IMPROVE_ALL_OPS,
                                  .surface = {tolerance, 80, false}};
    make_mesh(&mesh, &stream, GRID, 0.3, regions);
    bend(&mesh);
    assert_valid(&mesh);
    invariants before = measure_invariants(&mesh);
    assert_int_equal(tm_improve_start(&m, &mesh, &options, &report, &error), TM_OK);
    assert_true(m.features.may_move);
    assert_within(&m, &before);
    for (int k = 0; k < TRIES; k++) {
        if (operate(&m) < 0)
            continue;
        assert_int_equal(m.status, TM_OK);
        assert_valid(&mesh);
        check_memory(&m);
        assert_within(&m, &before);
    }
    tm_improve_set_price(&m, 1); /* all that may be peeled off is */
    for (uint32_t t = 0; t < mesh.slots; t++)
        if (tm_tet_lives(&mesh, t) && tm_improve_peel(&m, t)) {
            assert_valid(&mesh);
            assert_within(&m, &before);
        }
    tm_improve_finish(&m);
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        done[op] += report.done.op[op];
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* Operations on one mesh; adds what was done. */
static void operate_on(bool regions, tm_tet_measure measure, size_t done[TM_IMPROVE_OPS])
{
    enum { TRIES = 1500 };
    const double angles[] = {30, 45, 60};
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    tm_improve_report report;
    static tm_improver m;
    tm_improve_options options = {
        .angle = angles[random_below(3)], .measure = measure, .ops = TM_IMPROVE_ALL_OPS};
    make_mesh(&mesh, &stream, GRID, 0.9, regions);
    invariants before = measure_invariants(&mesh);
    extremes angles_before = angles_of(&mesh);
    assert_int_equal(tm_improve_start(&m, &mesh, &options, &report, &error), TM_OK);
    for (int k = 0; k < TRIES; k++) {
        if (operate(&m) < 0)
            continue;
        assert_int_equal(m.status, TM_OK);
        assert_valid(&mesh);
        check_memory(&m);
        invariants now = measure_invariants(&mesh);
        assert_same_invariants(&before, &now);
    }
    tm_improve_finish(&m);
    extremes angles_after = angles_of(&mesh);
    assert_no_worse(&angles_before, &angles_after, options.angle);
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        done[op] += report.done.op[op];
    assert_int_equal(tm_tet_mesh_to_stream(&mesh, &stream, &error), TM_OK);
    assert_int_equal(tm_tet_mesh_from_stream(&mesh, &stream, 1, &error), TM_OK);
    assert_valid(&mesh);
    invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

static bool all_done(const size_t done[TM_IMPROVE_OPS], bool surface_moves)
{
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        if (done[op] == 0 && (op != TM_OP_PEELING || surface_moves))
            return false;
    return true;
}

/* On so many meshes, and more if some operation was never done, which is rare. */
static void operate_on_some(bool regions)
{
    enum { MESHES = 4, MOST = 100 };
    size_t done[TM_IMPROVE_OPS] = {0};
    operate_on(regions, TM_MEASURE_VOLUME, done);
    for (int k = 0; k < MESHES || !all_done(done, false); k++) {
        assert_true(k < MOST);
        operate_on(regions, TM_MEASURE_DIHEDRAL, done);
    }
}

static void test_operations(void **state)
{
    (void)state;
    operate_on_some(false);
}

static void test_operations_with_regions(void **state)
{
    (void)state;
    operate_on_some(true);
}

static void test_operations_within(void **state)
{
    (void)state;
    enum { MESHES = 6, MOST = 100 };
    const double tolerances[] = {0.02, 0.2, 0.8}; /* cells are 1 wide */
    size_t done[TM_IMPROVE_OPS] = {0};
    for (int k = 0; k < MESHES || !all_done(done, true); k++) {
        assert_true(k < MOST);
        operate_within(k % 2 == 1, tolerances[k % 3], done);
    }
}

static void assert_same_mesh(const tm_tet_mesh *a, const tm_tet_mesh *b)
{
    assert_int_equal(a->tets, b->tets);
    assert_int_equal(a->slots, b->slots);
    assert_int_equal(a->nodes, b->nodes);
    assert_int_equal(a->faces, b->faces);
    assert_int_equal(a->edge_of.count, b->edge_of.count);
    for (uint32_t t = 0; t < a->slots; t++) {
        assert_int_equal(tm_tet_lives(a, t), tm_tet_lives(b, t));
        if (!tm_tet_lives(a, t))
            continue;
        assert_memory_equal(a->tet[t], b->tet[t], sizeof a->tet[t]);
        assert_memory_equal(a->neighbour[t], b->neighbour[t], sizeof a->neighbour[t]);
    }
    for (uint32_t v = 0; v < a->nodes; v++) {
        assert_int_equal(tm_node_lives(a, v), tm_node_lives(b, v));
        if (tm_node_lives(a, v))
            assert_memory_equal(a->xyz[v], b->xyz[v], sizeof a->xyz[v]);
    }
    for (size_t f = 0; f < a->faces; f++)
        assert_memory_equal(a->face[f].node, b->face[f].node, sizeof a->face[f].node);
}

/* What some operations changed is kept in a copy, or undone with what is known of the
 * surface, and all is as it was. */
static void keep_or_undo(double tolerance, int rounds)
{
    enum { OPERATIONS = 12 };
    const bool moves = tolerance > 0;
    tm_stream stream;
    tm_tet_mesh mesh, kept = {0};
    tm_features features = {0};
    tm_error error = {0};
    tm_improve_report report;
    static tm_improver m;
    tm_improve_options options = {.angle = 45,
                                  .measure = TM_MEASURE_DIHEDRAL,
                                  .ops = TM_IMPROVE_ALL_OPS,
                                  .surface = {tolerance, 80, false}};
    make_mesh(&mesh, &stream, GRID, moves ? 0.3 : 0.9, true);
    if (moves)
        bend(&mesh);
    invariants before = measure_invariants(&mesh);
    assert_int_equal(tm_improve_start(&m, &mesh, &options, &report, &error), TM_OK);
    assert_int_equal(tm_tet_mesh_copy(&kept, &mesh, &error), TM_OK);
    assert_true(tm_features_copy(&features, &m.features));
    for (int k = 0; k < rounds; k++) {
        tm_mesh_part_clear(&m.changes);
        m.recording = true;
        tm_envelope_record(&m.features.envelope, true);
        for (int i = 0; i < OPERATIONS; i++)
            operate(&m);
        m.recording = false;
        assert_true(tm_mesh_part_close(&m.changes, &mesh, &kept, &m.marks));
        bool undo = k % 3 > 0;
        tm_tet_mesh *to = undo ? &mesh : &kept, *from = undo ? &kept : &mesh;
        if (undo)
            tm_envelope_undo(&m.features.envelope);
        tm_envelope_record(&m.features.envelope, false);
        assert_int_equal(tm_mesh_part_copy(&m.changes, to, from, &error), TM_OK);
        assert_true(tm_features_reserve(&features, m.features.room, 0));
        for (size_t i = 0; i < m.changes.nodes; i++)
            if (m.changes.node[i] < from->nodes)
                tm_features_copy_node(undo ? &m.features : &features,
                                      undo ? &features : &m.features, m.changes.node[i]);
        assert_same_mesh(&mesh, &kept);
        assert_valid(&mesh);
        for (uint32_t t = 0; t < mesh.slots; t++)
            if (tm_tet_lives(&mesh, t))
                tm_improve_note(&m, &t, 1);
        check_memory(&m);
        if (moves)
            assert_within(&m, &before);
    }
    tm_improve_finish(&m);
    tm_features_free(&features);
    tm_tet_mesh_free(&kept);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

static void test_parts(void **state)
{
    (void)state;
    keep_or_undo(0, 200);
}

static void test_parts_within(void **state)
{
    (void)state;
    keep_or_undo(0.3, 300);
}

/* A whole run. */
static tm_improve_report run(tm_tet_mesh *mesh, const tm_improve_options *options)
{
    tm_improve_report report;
    tm_error error = {0};
    size_t tets = mesh->tets;
    invariants before = measure_invariants(mesh);
    extremes angles_before = angles_of(mesh);
    if (tm_improve(mesh, options, &report, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(mesh);
    invariants after = measure_invariants(mesh);
    assert_same_invariants(&before, &after);
    extremes angles_after = angles_of(mesh);
    assert_no_worse(&angles_before, &angles_after, options->angle);
    assert_int_equal(report.tets_before, tets);
    assert_true(report.bad_after <= report.bad_before);
    if (options->max_growth == 0 || options->max_growth >= 1)
        assert_true(report.bad_after * tets <= report.bad_before * mesh->tets);
    double most = options->max_growth * (double)tets;
    if (options->max_growth > 0)
        assert_int_equal(report.too_large, (double)mesh->tets > most);
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        if (!(options->ops >> op & 1))
            assert_int_equal(report.done.op[op], 0);
    return report;
}

static void test_every_palette(void **state)
{
    (void)state;
    for (unsigned ops = 0; ops <= TM_IMPROVE_ALL_OPS; ops++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, GRID, 0.9, ops % 2);
        tm_improve_options options = {
            .angle = 30, .measure = TM_MEASURE_DIHEDRAL, .max_growth = 3, .ops = ops};
        tm_improve_report report = run(&mesh, &options);
        if (ops == 0)
            assert_int_equal(tm_improve_operations(&report), 0);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

static void test_growth(void **state)
{
    (void)state;
    const double growths[] = {0.01, 0.5, 0.9, 1, 1.1, 2, 0};
    for (size_t k = 0; k < sizeof growths / sizeof growths[0]; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, 4, 0.9, false);
        tm_improve_options options = {.angle = 40,
                                      .measure = TM_MEASURE_DIHEDRAL,
                                      .max_growth = growths[k],
                                      .ops = TM_IMPROVE_ALL_OPS};
        tm_improve_report report = run(&mesh, &options);
        assert_int_equal(report.too_large, growths[k] == 0.01);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* The fixture's mesh with so many times its height. */
static void make_box(tm_tet_mesh *mesh, tm_stream *stream, int n, double by,
                     double height)
{
    make_mesh(mesh, stream, n, by, false);
    for (size_t v = 0; v < mesh->nodes; v++) {
        double *p = mesh->xyz[v];
        p[2] *= height;
        mesh->node_attribute[v] = p[0] + 2 * p[1] - p[2];
    }
}

/* Where what the improver does by itself is small enough, nothing else is done because a
 * mesh has to become smaller; where it is not, much less good may not become of that. */
static void test_shrinking(void **state)
{
    (void)state;
    const double heights[] = {1, 0.1, 0.01}, growths[] = {0, 0.9, 0.6, 0.4};
    for (size_t h = 0; h < sizeof heights / sizeof *heights; h++) {
        const uint64_t same = random_state;
        double share = 0;
        size_t tets = 0;
        for (size_t k = 0; k < sizeof growths / sizeof *growths; k++) {
            tm_stream stream;
            tm_tet_mesh mesh;
            random_state = same;
            make_box(&mesh, &stream, 5, 0.9, heights[h]);
            tm_improve_options options = {.angle = 30,
                                          .measure = TM_MEASURE_DIHEDRAL,
                                          .max_growth = growths[k],
                                          .ops = TM_IMPROVE_ALL_OPS};
            const double most = growths[k] * (double)mesh.tets;
            const tm_improve_report report = run(&mesh, &options);
            const double now = (double)report.bad_after / (double)mesh.tets;
            if (k == 0) {
                share = now;
                tets = mesh.tets;
            } else if ((double)tets <= most) {
                assert_true(now <= share);
            } else {
                assert_true(now <= 2 * share + 0.1);
            }
            tm_tet_mesh_free(&mesh);
            tm_stream_free(&stream);
        }
    }
}

/* Bricks, each cut into 6: no angle is above 90 degrees, and those below a limit are only
 * gone if larger ones are made. */
static void test_bricks(void **state)
{
    (void)state;
    const double heights[] = {0.5, 0.2};
    for (size_t k = 0; k < sizeof heights / sizeof heights[0]; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_box(&mesh, &stream, 5, 0, heights[k]);
        tm_improve_options options = {
            .angle = 30, .measure = TM_MEASURE_DIHEDRAL, .ops = TM_IMPROVE_ALL_OPS};
        tm_improve_report report = run(&mesh, &options);
        assert_true(report.bad_before > mesh.tets / 4);
        assert_true(report.bad_after < report.bad_before / 10);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* A mesh that is much too flat: contraction alone would leave a few tetrahedra, all bad.
 * Few are left only where that halves the share of bad ones. */
static void test_flat_mesh(void **state)
{
    (void)state;
    const double heights[] = {0.1, 0.03, 0.01};
    const double angles[] = {30, 60};
    for (int k = 0; k < 6; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_box(&mesh, &stream, 4, 0.9, heights[k % 3]);
        size_t tets = mesh.tets;
        tm_improve_options options = {.angle = angles[k / 3],
                                      .measure =
                                          k % 2 ? TM_MEASURE_VOLUME : TM_MEASURE_DIHEDRAL,
                                      .ops = TM_IMPROVE_ALL_OPS};
        tm_improve_report report = run(&mesh, &options);
        double left = (double)mesh.tets / (double)tets;
        assert_true(options.measure == TM_MEASURE_VOLUME || left > 0.5 ||
                    (double)report.bad_after <= 0.5 * left * (double)report.bad_before);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* The same mesh twice gives the same. */
static void test_deterministic(void **state)
{
    (void)state;
    tm_stream stream[2];
    tm_tet_mesh mesh[2];
    uint64_t seed = random_state;
    for (int k = 0; k < 2; k++) {
        random_state = seed;
        make_mesh(&mesh[k], &stream[k], GRID, 0.9, false);
        tm_improve_options options = {
            .angle = 35, .measure = TM_MEASURE_DIHEDRAL, .ops = TM_IMPROVE_ALL_OPS};
        run(&mesh[k], &options);
    }
    assert_int_equal(mesh[0].nodes, mesh[1].nodes);
    assert_int_equal(mesh[0].slots, mesh[1].slots);
    assert_memory_equal(mesh[0].tet, mesh[1].tet, mesh[0].slots * sizeof *mesh[0].tet);
    assert_memory_equal(mesh[0].xyz, mesh[1].xyz, mesh[0].nodes * sizeof *mesh[0].xyz);
    for (int k = 0; k < 2; k++) {
        tm_tet_mesh_free(&mesh[k]);
        tm_stream_free(&stream[k]);
    }
}

/* On the cube: corners, edges, sides and what has a marker. */
static void test_features(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_features features;
    tm_tet_marks marks = {0};
    make_mesh(&mesh, &stream, GRID, 0.5, false);
    assert_int_equal(tm_features_find(&features, &mesh, NULL, &marks, NULL), TM_OK);
    for (int z = 0; z <= GRID; z++)
        for (int y = 0; y <= GRID; y++)
            for (int x = 0; x <= GRID; x++) {
                int free =
                    (x > 0 && x < GRID) + (y > 0 && y < GRID) + (z > 0 && z < GRID);
                uint32_t v = grid_node(GRID, x, y, z);
                /* the ends of the marked edges of the fixture */
                bool marked =
                    (y == 0 && z == 0 && x == 1) || (x == 1 && y == 1 && z <= 1);
                assert_int_equal(features.dimension[v], marked ? 0 : free);
            }
    tm_features_free(&features);
    tm_tet_marks_free(&marks);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* Nodes of a side whose markers are not those of their neighbours in it stay, and those
 * of an edge of the cube. */
static void test_unlike_nodes(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_features before, after;
    tm_tet_marks marks = {0};
    make_mesh(&mesh, &stream, GRID, 0, false);
    int32_t *marker = mesh.node_marker;
    mesh.node_marker = NULL;
    assert_int_equal(tm_features_find(&before, &mesh, NULL, &marks, NULL), TM_OK);
    mesh.node_marker = realloc(marker, mesh.nodes * sizeof *marker);
    assert_non_null(mesh.node_marker);
    bool *unlike = calloc(mesh.nodes, sizeof *unlike);
    /* It ends the marked edge inside, but is in the side, too. */
    const uint32_t end = grid_node(GRID, 1, 1, 0);
    assert_int_equal(before.dimension[end], 0);
    before.dimension[end] = 2;
    for (size_t v = 0; v < mesh.nodes; v++)
        mesh.node_marker[v] = before.dimension[v] < 3 ? (int32_t)random_below(8) / 6 : 0;
    for (size_t f = 0; f < mesh.faces; f++)
        for (int i = 0; i < 3; i++) {
            const uint32_t a = mesh.face[f].node[i], b = mesh.face[f].node[(i + 1) % 3];
            const bool along = before.dimension[a] == before.dimension[b] &&
                               (before.dimension[a] == 2 ||
                                (before.dimension[a] == 1 &&
                                 (before.line[a][0] == b || before.line[a][1] == b)));
            if (along && mesh.node_marker[a] != mesh.node_marker[b])
                unlike[a] = unlike[b] = true;
        }
    assert_int_equal(tm_features_find(&after, &mesh, NULL, &marks, NULL), TM_OK);
    before.dimension[end] = 0;
    for (size_t v = 0; v < mesh.nodes; v++)
        assert_int_equal(after.dimension[v], unlike[v] ? 0 : before.dimension[v]);
    free(unlike);
    tm_features_free(&before);
    tm_features_free(&after);
    tm_tet_marks_free(&marks);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_features),
        cmocka_unit_test(test_unlike_nodes),
        cmocka_unit_test(test_operations),
        cmocka_unit_test(test_operations_with_regions),
        cmocka_unit_test(test_operations_within),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_parts_within),
        cmocka_unit_test(test_every_palette),
        cmocka_unit_test(test_growth),
        cmocka_unit_test(test_shrinking),
        cmocka_unit_test(test_bricks),
        cmocka_unit_test(test_flat_mesh),
        cmocka_unit_test(test_deterministic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
