/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LEPP improvement: what no option may change, where it ends, and degenerate meshes. */
#include "../../lib/tet/lepp/lepp.h"
#include "../../lib/tet/mesh_set.h"
#include "tet_fixture.h"

static const tm_lepp_options usual = {.algorithm = TM_LEPP_SELECTIVE,
                                      .factor = 1.1,
                                      .angle = 30,
                                      .measure = TM_MEASURE_DIHEDRAL,
                                      .stop = TM_LEPP_CONVERGED};

static double worst_quality(const tm_tet_mesh *mesh, tm_tet_measure measure)
{
    double worst = HUGE_VAL;
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (tm_tet_lives(mesh, t)) {
            const uint32_t *n = mesh->tet[t];
            worst =
                fmin(worst, tm_tet_measure_of(measure, mesh->xyz[n[0]], mesh->xyz[n[1]],
                                              mesh->xyz[n[2]], mesh->xyz[n[3]]));
        }
    return worst;
}

static tm_lepp_report improve(tm_tet_mesh *mesh, const tm_lepp_options *options)
{
    tm_lepp_report report;
    tm_error error = {0};
    if (tm_lepp_improve(mesh, options, &report, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(mesh);
    return report;
}

/* Gives the mesh to its stream and takes it again. */
static void through_stream(tm_tet_mesh *mesh, tm_stream *stream)
{
    tm_error error = {0};
    assert_int_equal(tm_tet_mesh_to_stream(mesh, stream, &error), TM_OK);
    if (tm_tet_mesh_from_stream(mesh, stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(mesh);
}

static void check_counts(const tm_lepp_report *r)
{
    size_t closed = 0, open = 0, visited = 0;
    for (int i = 0; i < TM_LEPP_SIZES; i++) {
        closed += r->closed_size[i];
        open += r->open_size[i];
    }
    for (int i = 0; i < TM_LEPP_VISITS; i++)
        visited += r->visited[i];
    assert_int_equal(closed, r->closed);
    assert_int_equal(open, r->open);
    assert_int_equal(visited, r->targets);
    assert_int_equal(tm_lepp_operations(r) + r->refused_closed + r->refused_open,
                     closed + open);
}

static void check_run(const tm_lepp_options *options, bool regions)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    make_mesh(&mesh, &stream, 3, 0.9, regions);
    invariants before = measure_invariants(&mesh);
    double worst = worst_quality(&mesh, options->measure);
    size_t tets = mesh.tets;
    tm_lepp_report report = improve(&mesh, options);
    invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    check_counts(&report);
    assert_int_equal(report.tets_before, tets);
    if (options->algorithm == TM_LEPP_SELECTIVE)
        assert_true(worst_quality(&mesh, options->measure) >= worst);
    through_stream(&mesh, &stream);
    after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    if (options->stop == TM_LEPP_CONVERGED) {
        report = improve(&mesh, options);
        assert_int_equal(tm_lepp_operations(&report), 0);
    }
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

static void test_all_options(void **state)
{
    (void)state;
    static const double factors[] = {1, 1.05, 1.2}, angles[] = {10, 30, 50};
    for (int regions = 0; regions < 2; regions++)
        for (int measure = 0; measure < 2; measure++) {
            tm_lepp_options o = usual;
            o.measure = measure ? TM_MEASURE_VOLUME : TM_MEASURE_DIHEDRAL;
            for (int f = 0; f < 3; f++) {
                o.factor = factors[f];
                o.angle = angles[random_below(3)];
                o.stop = TM_LEPP_CONVERGED;
                check_run(&o, regions);
                o.stop = TM_LEPP_ORIGINAL;
                check_run(&o, regions);
                o.stop = TM_LEPP_PASSES;
                o.passes = 1 + random_below(3);
                check_run(&o, regions);
            }
            for (int a = TM_LEPP_BISECTION; a < TM_LEPP_SELECTIVE; a++) {
                o.algorithm = (tm_lepp_algorithm)a;
                o.stop = TM_LEPP_ORIGINAL;
                check_run(&o, regions);
            }
            o.algorithm = TM_LEPP_SELECTIVE;
            o.max_star = 3 + random_below(3);
            check_run(&o, regions);
        }
}

/* Algorithms that change every star leave none of the original bad tetrahedra. */
static void check_removes_all(tm_lepp_algorithm algorithm, tm_lepp_path path)
{
    enum { MOST = 6 * 27 };
    tm_stream stream;
    tm_tet_mesh mesh;
    make_mesh(&mesh, &stream, 3, 0.9, false);
    tm_lepp_options o = usual;
    o.algorithm = algorithm;
    o.path = path;
    o.stop = TM_LEPP_ORIGINAL;
    uint32_t bad[MOST][4];
    size_t count = 0;
    for (uint32_t t = 0; t < mesh.slots; t++) {
        const uint32_t *n = mesh.tet[t];
        if (tm_tet_sine2(mesh.xyz[n[0]], mesh.xyz[n[1]], mesh.xyz[n[2]], mesh.xyz[n[3]]) <
            tm_bad_sine2(o.angle))
            memcpy(bad[count++], n, sizeof bad[0]);
    }
    tm_lepp_report report = improve(&mesh, &o);
    assert_int_equal(report.bad_before, count);
    for (uint32_t t = 0; t < mesh.slots; t++)
        for (size_t b = 0; b < count && tm_tet_lives(&mesh, t); b++)
            assert_int_not_equal(memcmp(mesh.tet[t], bad[b], sizeof bad[0]), 0);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

static void test_remove_all(void **state)
{
    (void)state;
    for (int a = TM_LEPP_BISECTION; a < TM_LEPP_SELECTIVE; a++)
        check_removes_all((tm_lepp_algorithm)a, TM_LEPP_SIMPLE);
    check_removes_all(TM_LEPP_SWAP_CENTROID, TM_LEPP_FIXED);
}

/* bisection only halves edges; max_star leaves larger stars alone. */
static void test_what_is_done(void **state)
{
    (void)state;
    enum { MAX_STAR = 4 };
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_lepp_options o = usual;
    make_mesh(&mesh, &stream, 5, 0.9, false);
    o.max_star = MAX_STAR;
    tm_lepp_report report = improve(&mesh, &o);
    for (int size = MAX_STAR + 1; size < TM_LEPP_SIZES; size++)
        assert_int_equal(report.swap_size[size] + report.insertion_size[size], 0);
    assert_true(report.above_max > 0);
    o.max_star = 0;
    o.algorithm = TM_LEPP_BISECTION;
    o.stop = TM_LEPP_ORIGINAL;
    report = improve(&mesh, &o);
    assert_true(report.midpoints > 0);
    assert_int_equal(report.swaps + report.centroids + report.outside + report.tangled,
                     0);
    o.algorithm = TM_LEPP_WCENTROID;
    report = improve(&mesh, &o);
    assert_true(report.centroids > 0);
    assert_int_equal(report.swaps, 0);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* A stream of given nodes and tetrahedra (0-based). */
static void make_stream(tm_stream *stream, const double (*xyz)[3], size_t nodes,
                        const uint32_t (*tet)[4], size_t tets)
{
    tm_stream_init(stream);
    tm_stream_add(stream, ".node");
    tm_stream_add(stream, ".ele");
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *ele = tm_stream_find(stream, ".ele");
    assert_int_equal(tm_block_allocate(node, nodes, 0, NULL), TM_OK);
    assert_int_equal(tm_block_allocate(ele, tets, 0, NULL), TM_OK);
    memcpy(node->real, xyz, nodes * sizeof *xyz);
    if (tets)
        memcpy(ele->integer, tet, tets * sizeof *tet);
}

static const double points[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},   {0, 0, 1},
                                   {1, 1, 1}, {2, 0, 0}, {-1, -1, 0}, {0, -1, 1}};
enum { POINTS = sizeof points / sizeof points[0] };

/* Runs every algorithm on a small mesh; returns how many operations there were. */
static size_t improve_small(const uint32_t (*tet)[4], size_t tets, const double (*xyz)[3],
                            size_t nodes)
{
    size_t operations = 0;
    for (int a = 0; a < 2; a++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        tm_error error = {0};
        make_stream(&stream, xyz, nodes, tet, tets);
        if (tm_tet_mesh_from_stream(&mesh, &stream, 1, &error) != TM_OK)
            fail_msg("%s", error.what);
        assert_valid(&mesh);
        double worst = worst_quality(&mesh, TM_MEASURE_DIHEDRAL);
        invariants before = measure_invariants(&mesh);
        tm_lepp_options o = usual;
        if (a == 1) {
            o.algorithm = TM_LEPP_SWAP_CENTROID;
            o.stop = TM_LEPP_ORIGINAL;
        }
        tm_lepp_report report = improve(&mesh, &o);
        if (a == 0)
            assert_true(worst_quality(&mesh, TM_MEASURE_DIHEDRAL) >= worst);
        operations += tm_lepp_operations(&report);
        invariants after = measure_invariants(&mesh);
        assert_same_invariants(&before, &after);
        through_stream(&mesh, &stream);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
    return operations;
}

static void test_degenerate(void **state)
{
    (void)state;
    static const uint32_t one[][4] = {{0, 1, 2, 3}}, left[][4] = {{0, 2, 1, 3}};
    static const uint32_t edge_only[][4] = {{0, 1, 2, 3}, {0, 1, 6, 7}};
    static const uint32_t pieces[][4] = {{0, 1, 2, 3}, {0, 6, 7, 6 - 1}};
    assert_int_equal(improve_small(NULL, 0, points, POINTS), 0);
    assert_int_equal(improve_small(NULL, 0, points, 0), 0);
    assert_int_equal(improve_small(one, 1, points, POINTS), 0);
    assert_int_equal(improve_small(left, 1, points, POINTS), 0);
    improve_small(edge_only, 2, points, POINTS);
    improve_small(pieces, 2, points, POINTS);
}

/* Two bad tetrahedra whose common longest edge is all that they share: a star walk sees
 * one of them only, so the edge is left alone. */
static void test_touching_edge(void **state)
{
    (void)state;
    static const double xyz[][3] = {{0, 0, 0},   {10, 0, 0}, {5, 1, 0},
                                    {5, 1, 0.1}, {5, -1, 0}, {5, -1, 0.1}};
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {0, 1, 4, 5}};
    tm_stream stream;
    tm_tet_mesh mesh;
    make_stream(&stream, xyz, 6, tet, 2);
    assert_int_equal(tm_tet_mesh_from_stream(&mesh, &stream, 1, NULL), TM_OK);
    assert_int_equal(mesh.turned, 1);
    assert_int_equal(mesh.locked.count, 1);
    tm_lepp_options o = usual;
    o.algorithm = TM_LEPP_SWAP_CENTROID;
    o.stop = TM_LEPP_ORIGINAL;
    tm_lepp_report report = improve(&mesh, &o);
    assert_int_equal(report.bad_before, 2);
    assert_int_equal(tm_lepp_operations(&report), 0);
    assert_true(report.locked > 0);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* A flat tetrahedron between two good ones, on the square 0 1 2 3, that one edge removal
 * takes out. */
static void test_flat(void **state)
{
    (void)state;
    static const double xyz[][3] = {{0, 0, 0}, {1, 0, 0},       {1, 1, 0},
                                    {0, 1, 0}, {0.5, 0.5, 0.6}, {0.5, 0.5, -0.6}};
    static const uint32_t tet[][4] = {
        {0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 3, 4}, {0, 3, 1, 5}, {1, 3, 2, 5}};
    tm_stream stream;
    tm_tet_mesh mesh;
    make_stream(&stream, xyz, 6, tet, 5);
    tm_error error = {0};
    if (tm_tet_mesh_from_stream(&mesh, &stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_int_equal(mesh.flat, 1);
    assert_valid(&mesh);
    invariants before = measure_invariants(&mesh);
    tm_lepp_report report = improve(&mesh, &usual);
    invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    assert_true(report.swaps > 0);
    assert_true(worst_quality(&mesh, TM_MEASURE_DIHEDRAL) > 0);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
    improve_small(tet, 1, xyz, 6);
}

/* Two equal points joined to different tetrahedra: two pieces that touch. */
static void test_duplicate_nodes(void **state)
{
    (void)state;
    static const double xyz[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                    {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
    static const uint32_t tet[][4] = {{0, 1, 2, 3}, {4, 6, 5, 7}};
    improve_small(tet, 2, xyz, 8);
}

static void assert_refused(const uint32_t (*tet)[4], size_t tets, const char *what)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    make_stream(&stream, points, POINTS, tet, tets);
    assert_int_equal(tm_tet_mesh_from_stream(&mesh, &stream, 1, &error), TM_ERROR_INPUT);
    assert_non_null(strstr(error.what, what));
    assert_string_equal(error.block, ".ele");
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

static void test_no_meshes(void **state)
{
    (void)state;
    static const uint32_t twice[][4] = {{0, 1, 2, 2}};
    static const uint32_t three[][4] = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 7}};
    static const uint32_t overlap[][4] = {{0, 1, 2, 3}, {0, 1, 2, 4}};
    assert_refused(twice, 1, "names a node twice");
    assert_refused(three, 3, "tetrahedra 1, 2 and 3 have one face in common");
    assert_refused(overlap, 2, "same side");
}

/* A repeated row of .face or .edge is an error; a dangling one is kept and counted. */
static void test_listed_faces_and_edges(void **state)
{
    (void)state;
    static const uint32_t one[][4] = {{0, 1, 2, 3}};
    static const uint32_t rows[3][3] = {{0, 1, 2}, {4, 5, 6}, {2, 0, 1}};
    for (size_t count = 2; count <= 3; count++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_stream(&stream, points, POINTS, one, 1);
        tm_block *face = tm_stream_add(&stream, ".face");
        assert_int_equal(tm_block_allocate(face, count, 0, NULL), TM_OK);
        memcpy(face->integer, rows, count * sizeof rows[0]);
        tm_error error = {0};
        tm_status status = tm_tet_mesh_from_stream(&mesh, &stream, 1, &error);
        if (count == 3) {
            assert_int_equal(status, TM_ERROR_INPUT);
            assert_string_equal(error.block, ".face");
        } else {
            assert_int_equal(status, TM_OK);
            assert_int_equal(mesh.dangling, 1);
            assert_valid(&mesh);
            assert_int_equal(tm_tet_mesh_to_stream(&mesh, &stream, NULL), TM_OK);
            face = tm_stream_find(&stream, ".face");
            assert_int_equal(face->count, 2);
            assert_memory_equal(face->integer, rows, 2 * sizeof rows[0]);
        }
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* The longest edge of a living tetrahedron. */
static double longest_edge(const tm_tet_mesh *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t];
    double longest = 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < i; j++)
            longest = fmax(longest, sqrt(tm_distance2(mesh->xyz[n[i]], mesh->xyz[n[j]])));
    return longest;
}

/* Whether the centre of t is in the lower half of the grid. */
static bool is_low(const tm_tet_mesh *mesh, uint32_t t, int n)
{
    double z = 0;
    for (int i = 0; i < 4; i++)
        z += mesh->xyz[mesh->tet[t][i]][2];
    return z < 2 * n;
}

/* A mesh whose set is its lower half. */
static void make_halved(tm_tet_mesh *mesh, tm_stream *stream, int n, double by)
{
    make_mesh(mesh, stream, n, by, true);
    bool *in_set = malloc(mesh->slots * sizeof *in_set);
    for (uint32_t t = 0; t < mesh->slots; t++)
        in_set[t] = is_low(mesh, t, n);
    assert_int_equal(tm_tet_mesh_add_set(mesh, in_set, NULL), TM_OK);
    free(in_set);
}

/* The improver without the checks, which a mesh with a set does not pass. */
static tm_lepp_report improve_set(tm_tet_mesh *mesh, const tm_lepp_options *options)
{
    tm_lepp_report report;
    assert_int_equal(tm_lepp_improve(mesh, options, &report, NULL), TM_OK);
    return report;
}

/* The set is carried on, and taken away again; what the mesh promises stays. */
static void test_set_of_every_algorithm(void **state)
{
    (void)state;
    for (int a = TM_LEPP_BISECTION; a <= TM_LEPP_SELECTIVE; a++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_halved(&mesh, &stream, 4, 0);
        const size_t regions = mesh.regions, before = tm_tet_mesh_count_set(&mesh);
        assert_int_equal(before, mesh.tets / 2);
        tm_tet_mesh_remove_set(&mesh);
        const invariants kept = measure_invariants(&mesh);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
        make_halved(&mesh, &stream, 4, 0);
        tm_lepp_options o = usual;
        o.algorithm = (tm_lepp_algorithm)a;
        o.stop = TM_LEPP_ORIGINAL;
        const tm_lepp_report report = improve_set(&mesh, &o);
        if (a == TM_LEPP_BISECTION)
            assert_int_equal(tm_tet_mesh_count_set(&mesh), 2 * before);
        if (a != TM_LEPP_SELECTIVE)
            assert_true(tm_lepp_operations(&report) > 0);
        tm_tet_mesh_remove_set(&mesh);
        tm_tet_mesh_remove_set(&mesh); /* nothing to do */
        assert_int_equal(mesh.regions, regions - 1);
        assert_valid(&mesh);
        const invariants after = measure_invariants(&mesh);
        assert_same_invariants(&kept, &after);
        through_stream(&mesh, &stream);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* Without a tetrahedron in the set nothing is done. */
static void test_empty_set(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    make_mesh(&mesh, &stream, 3, 0.9, false);
    bool *in_set = calloc(mesh.slots, sizeof *in_set);
    assert_int_equal(tm_tet_mesh_add_set(&mesh, in_set, NULL), TM_OK);
    free(in_set);
    tm_lepp_options o = usual;
    const tm_lepp_report report = improve_set(&mesh, &o);
    assert_int_equal(tm_lepp_operations(&report), 0);
    assert_int_equal(report.targets, 0);
    tm_tet_mesh_remove_set(&mesh);
    assert_null(mesh.region);
    assert_valid(&mesh);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* Every tetrahedron of the set becomes as small as is asked for. */
static void test_sizes(void **state)
{
    (void)state;
    const double size = 0.4, slack = 1 + 1e-9;
    for (int a = TM_LEPP_BISECTION; a <= TM_LEPP_DELAUNAY; a++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_halved(&mesh, &stream, 3, 0.2);
        tm_lepp_options o = usual;
        o.algorithm = (tm_lepp_algorithm)a;
        o.sizes.longest = size;
        const tm_lepp_report report = improve_set(&mesh, &o);
        assert_true(report.larger_before > 0);
        size_t larger = 0;
        for (uint32_t t = 0; t < mesh.slots; t++)
            larger += tm_tet_lives(&mesh, t) && tm_tet_is_in_set(&mesh, t) &&
                      longest_edge(&mesh, t) > size * slack;
        assert_int_equal(larger, report.larger_after);
        if (a == TM_LEPP_BISECTION)
            assert_int_equal(larger, 0);
        check_counts(&report);
        tm_tet_mesh_remove_set(&mesh);
        assert_valid(&mesh);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* A field of sizes: no edge is longer than it says at any node of the tetrahedron. */
static void test_field_of_sizes(void **state)
{
    (void)state;
    const double least = 0.2, slope = 0.3, slack = 1 + 1e-9;
    tm_stream stream;
    tm_tet_mesh mesh;
    make_mesh(&mesh, &stream, 3, 0.2, true);
    assert_int_equal(mesh.node_attributes, 1);
    for (size_t v = 0; v < mesh.nodes; v++)
        mesh.node_attribute[v] = least + slope * mesh.xyz[v][0];
    tm_lepp_options o = usual;
    o.algorithm = TM_LEPP_BISECTION;
    o.sizes.attribute = 1;
    const tm_lepp_report report = improve(&mesh, &o);
    assert_int_equal(report.larger_after, 0);
    for (uint32_t t = 0; t < mesh.slots; t++)
        for (int i = 0; i < 4 && tm_tet_lives(&mesh, t); i++)
            assert_true(longest_edge(&mesh, t) <=
                        slack * mesh.node_attribute[mesh.tet[t][i]]);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* A mesh that may not grow so far stays below the limit, and what is too large is
 * counted. */
static void test_sizes_out_of_reach(void **state)
{
    (void)state;
    for (int a = TM_LEPP_BISECTION; a <= TM_LEPP_DELAUNAY; a++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, 3, 0.2, false);
        const size_t before = mesh.tets;
        tm_lepp_options o = usual;
        o.algorithm = (tm_lepp_algorithm)a;
        o.sizes.longest = 0.05;
        o.max_growth = 3;
        const tm_lepp_report report = improve(&mesh, &o);
        assert_true(report.larger_after > 0);
        assert_true(report.no_room > 0);
        assert_true(mesh.tets <= 3 * before);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* Bisection of cubes cut along a diagonal makes three shapes, however often it is done.
 */
static void test_bisection_keeps_angles(void **state)
{
    (void)state;
    const double limit = tm_bad_sine2(44.9);
    tm_stream stream;
    tm_tet_mesh mesh;
    make_mesh(&mesh, &stream, 2, 0, false);
    tm_lepp_options o = usual;
    o.algorithm = TM_LEPP_BISECTION;
    for (o.sizes.longest = 1; o.sizes.longest > 0.1; o.sizes.longest *= 0.7) {
        improve(&mesh, &o);
        for (uint32_t t = 0; t < mesh.slots; t++) {
            const uint32_t *n = mesh.tet[t];
            if (tm_tet_lives(&mesh, t))
                assert_true(tm_tet_sine2(mesh.xyz[n[0]], mesh.xyz[n[1]], mesh.xyz[n[2]],
                                         mesh.xyz[n[3]]) > limit);
        }
    }
    assert_true(mesh.tets > 10000);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* Fixed paths leave what the mesh promises. */
static void test_fixed_paths(void **state)
{
    (void)state;
    for (int regions = 0; regions < 2; regions++) {
        tm_lepp_options o = usual;
        o.algorithm = TM_LEPP_SWAP_CENTROID;
        o.stop = TM_LEPP_ORIGINAL;
        o.path = TM_LEPP_FIXED;
        check_run(&o, regions);
        o.stop = TM_LEPP_PASSES;
        o.passes = 2;
        check_run(&o, regions);
    }
}

/* The node within an octahedron goes to its middle, which is a third better for the worst
 * tetrahedron. */
static void test_smoothing(void **state)
{
    (void)state;
    static const double xyz[][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0},    {0, -1, 0},
                                    {0, 0, 1}, {0, 0, -1}, {0.2, 0.2, 0}};
    static const uint32_t tet[][4] = {{6, 0, 2, 4}, {6, 2, 1, 4}, {6, 1, 3, 4},
                                      {6, 3, 0, 4}, {6, 2, 0, 5}, {6, 1, 2, 5},
                                      {6, 3, 1, 5}, {6, 0, 3, 5}};
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    make_stream(&stream, xyz, sizeof xyz / sizeof *xyz, tet, sizeof tet / sizeof *tet);
    if (tm_tet_mesh_from_stream(&mesh, &stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    const double before = worst_quality(&mesh, TM_MEASURE_DIHEDRAL);
    tm_lepp_options o = usual;
    o.angle = 89;
    o.sweeps = TM_SWEEP_SMOOTH;
    o.stop = TM_LEPP_PASSES;
    o.passes = 1;
    o.factor = 100; /* no star gains as much */
    const tm_lepp_report report = improve(&mesh, &o);
    const double after = worst_quality(&mesh, TM_MEASURE_DIHEDRAL);
    assert_true(tm_lepp_swept(&report.smooth) > 0);
    assert_true(after > 1.1 * before && after < 2 * before);
    assert_true(tm_norm(mesh.xyz[6]) < 0.01);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_options),
                                       cmocka_unit_test(test_remove_all),
                                       cmocka_unit_test(test_what_is_done),
                                       cmocka_unit_test(test_degenerate),
                                       cmocka_unit_test(test_touching_edge),
                                       cmocka_unit_test(test_flat),
                                       cmocka_unit_test(test_duplicate_nodes),
                                       cmocka_unit_test(test_no_meshes),
                                       cmocka_unit_test(test_listed_faces_and_edges),
                                       cmocka_unit_test(test_set_of_every_algorithm),
                                       cmocka_unit_test(test_empty_set),
                                       cmocka_unit_test(test_sizes),
                                       cmocka_unit_test(test_field_of_sizes),
                                       cmocka_unit_test(test_sizes_out_of_reach),
                                       cmocka_unit_test(test_bisection_keeps_angles),
                                       cmocka_unit_test(test_fixed_paths),
                                       cmocka_unit_test(test_smoothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
