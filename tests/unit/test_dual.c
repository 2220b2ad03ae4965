/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dual of small meshes of many kinds: always polyhedra in which nothing is wrong, of
 * the same volume in each region and the same area under each marker, which their
 * centroids see; and attributes of nodes stay linear. */
#include "../../lib/examine/poly/poly_examine.h"
#include "../../lib/examine/poly/poly_finite_volume.h"
#include "../../lib/examine/poly/poly_statistics.h"
#include "../../lib/poly/dual/dual.h"
#include "tet_fixture.h"

enum { GRID = 3 };

/* The polyhedra of a dual as arrays. */
static tm_poly_arrays arrays_of(const tm_dual_blocks *b)
{
    return (tm_poly_arrays){.nodes = b->node.count,
                            .xyz = (const double(*)[3])b->node.real,
                            .facets = b->facet.count,
                            .side = (const uint32_t(*)[2])b->facet.integer,
                            .facet_start = b->facet.start,
                            .facet_node = b->facet.item,
                            .cells = b->cell.count,
                            .cell_start = b->cell.start,
                            .cell_facet = b->cell.item,
                            .attributes = b->cell.attributes,
                            .attribute = b->cell.attribute};
}

static void add_facet(const tm_dual_blocks *b, size_t f, double area[3], double *volume)
{
    const double(*xyz)[3] = (const double(*)[3])b->node.real;
    const uint32_t *node = b->facet.item + b->facet.start[f];
    const size_t count = b->facet.start[f + 1] - b->facet.start[f];
    for (size_t i = 1; i + 1 < count; i++) {
        double normal[3];
        tm_triangle_normal(normal, xyz[node[0]], xyz[node[i]], xyz[node[i + 1]]);
        for (int x = 0; x < 3; x++)
            area[x] += normal[x] / 2;
        *volume += tm_dot(normal, xyz[node[0]]) / 6;
    }
}

/* What is to be the same as in the tetrahedra: see invariants. */
static invariants measure_dual(const tm_dual_blocks *b, size_t regions)
{
    invariants i = {0};
    for (size_t f = 0; f < b->facet.count; f++) {
        double area[3] = {0}, volume = 0;
        add_facet(b, f, area, &volume);
        for (int s = 0; s < 2; s++) {
            const uint32_t c = b->facet.integer[2 * f + (size_t)s];
            if (c == TM_NONE)
                continue;
            const double region =
                regions ? b->cell.attribute[c * b->cell.attributes + 1] : 0;
            i.volume[(size_t)region] += s ? -volume : volume;
        }
        const int32_t marker = b->facet.marker[f];
        assert_in_range(marker, 0, FIXTURE_MARKERS - 1);
        i.area[marker] += tm_norm(area);
    }
    return i;
}

/* Nothing is wrong with polyhedra, all are balls, and centroids see all facets. */
static void assert_sound(const tm_poly_arrays *mesh, size_t wrong_pyramids)
{
    tm_error error;
    tm_examination found;
    tm_poly_statistics statistics;
    assert_int_equal(tm_poly_examine(&found, mesh, 1, &error), TM_OK);
    static const tm_defect kinds[] = {
        TM_INVERTED,       TM_DEGENERATE,    TM_UNCLOSED_EDGE, TM_UNORIENTED_EDGE,
        TM_UNMATCHED_FACE, TM_REPEATED_FACE, TM_OPEN_EDGE};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        assert_int_equal(found.defect[kinds[k]].count, 0);
    assert_int_equal(tm_poly_statistics_measure(&statistics, mesh, 1, &error), TM_OK);
    assert_int_equal(statistics.non_simple, 0);
    assert_int_equal(statistics.fv.wrong_pyramids, wrong_pyramids);
}

/* The field of make_grid(), which is linear, is that of the new nodes, too. */
static void assert_linear(const tm_block *node)
{
    double largest = 0;
    for (size_t i = 0; i < 3 * node->count; i++)
        largest = fmax(largest, fabs(node->real[i]));
    for (size_t v = 0; v < node->count && node->attributes > 0; v++) {
        const double *p = node->real + 3 * v;
        assert_true(fabs(node->attribute[v] - (p[0] + 2 * p[1] - p[2])) <=
                    1e-12 * largest);
    }
}

/* Makes the dual and asserts all that it promises. */
static tm_dual_report check(const tm_tet_mesh *mesh, double feature_angle, bool convex)
{
    tm_error error = {0};
    tm_dual_blocks made;
    tm_dual_report report;
    const tm_dual_options options = {.feature_angle = feature_angle, .convex = convex};
    if (tm_dual_make(&made, mesh, &options, &report, &error) != TM_OK)
        fail_msg("%s", error.what);
    const tm_poly_arrays arrays = arrays_of(&made);
    assert_sound(&arrays, report.wrong_pyramids);
    assert_linear(&made.node);
    const invariants before = measure_invariants(mesh);
    const invariants after = measure_dual(&made, mesh->regions);
    for (int r = 0; r <= FIXTURE_REGIONS && feature_angle == 0; r++)
        assert_true(fabs(before.volume[r] - after.volume[r]) <=
                    1e-12 * (fabs(before.volume[r]) + 1e-300));
    for (int m = 1; m < FIXTURE_MARKERS && feature_angle == 0; m++)
        assert_true(fabs(before.area[m] - after.area[m]) <= 1e-11 * before.area[m]);
    tm_dual_blocks_free(&made);
    return report;
}

static tm_dual_report check_dual(const tm_tet_mesh *mesh, double feature_angle)
{
    return check(mesh, feature_angle, false);
}

/* The mesh of a stream, which is used up. */
static void take_mesh(tm_tet_mesh *mesh, tm_stream *stream)
{
    tm_error error = {0};
    if (tm_tet_mesh_from_stream(mesh, stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(mesh);
    tm_stream_free(stream);
}

/* Keeps each tetrahedron with a chance: what is left touches itself in edges and nodes,
 * is in parts, and concave everywhere. */
static void keep_some(tm_stream *stream, double chance)
{
    tm_block *ele = tm_stream_find(stream, ".ele");
    size_t kept = 0;
    for (size_t t = 0; t < ele->count; t++) {
        if (random_unit() > chance)
            continue;
        memmove(ele->integer + 4 * kept, ele->integer + 4 * t, 4 * sizeof *ele->integer);
        if (ele->attribute)
            ele->attribute[kept] = ele->attribute[t];
        kept++;
    }
    ele->count = kept;
}

static void scale_nodes(tm_stream *stream, double x, double y, double z)
{
    tm_block *node = tm_stream_find(stream, ".node");
    for (size_t v = 0; v < node->count; v++) {
        node->real[3 * v] *= x;
        node->real[3 * v + 1] *= y;
        node->real[3 * v + 2] *= z;
        const double *p = node->real + 3 * v;
        node->attribute[v] = p[0] + 2 * p[1] - p[2];
    }
}

static void test_one_tetrahedron(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    make_grid(&stream, 1, 0, false);
    tm_block *ele = tm_stream_find(&stream, ".ele");
    ele->count = 1;
    take_mesh(&mesh, &stream);
    const tm_dual_report r = check_dual(&mesh, 0);
    assert_int_equal(r.cells, 4);
    assert_int_equal(r.facets, 6 + 4 * 3);
    assert_int_equal(r.nodes, 1 + 4 + 6 + 4);
    assert_int_equal(r.wrong_pyramids, 0);
    tm_tet_mesh_free(&mesh);
}

/* A cube in a grid: a cell for each node; on its sides a facet for each node, with points
 * in triangles only, but for its edges, which have markers and a marked edge. */
static void test_cube(void **state)
{
    (void)state;
    for (int n = 1; n <= 4; n++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_grid(&stream, n, 0, false);
        tm_stream_remove(&stream, tm_stream_find(&stream, ".edge"));
        take_mesh(&mesh, &stream);
        const tm_dual_report r = check_dual(&mesh, 0);
        const size_t m = (size_t)n;
        assert_int_equal(r.cells, (m + 1) * (m + 1) * (m + 1));
        assert_int_equal(r.nodes, 6 * m * m * m + 12 * m * m + 12 * m + 8);
        const size_t inner = 3 * m * (m + 1) * (m + 1) + 3 * m * m * (m + 1) + m * m * m;
        assert_int_equal(r.facets, inner + 6 * (m + 1) * (m + 1));
        assert_int_equal(r.wrong_pyramids, 0);
        tm_tet_mesh_free(&mesh);
    }
}

static const double angles[] = {0, 0, 30};

static void test_grids(void **state)
{
    (void)state;
    for (int k = 0; k < 30; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_grid(&stream, 1 + (int)random_below(GRID), random_unit(), k % 2);
        if (k % 5 == 0)
            scale_nodes(&stream, 1, 1, pow(10, -(double)random_below(6)));
        take_mesh(&mesh, &stream);
        const tm_dual_report r = check_dual(&mesh, angles[k % 3]);
        assert_int_equal(r.wrong_pyramids, 0);
        tm_tet_mesh_free(&mesh);
    }
}

static void test_touching(void **state)
{
    (void)state;
    for (int k = 0; k < 30; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_grid(&stream, 1 + (int)random_below(GRID), k % 4 ? 0.4 : 0, k % 2);
        keep_some(&stream, 0.3 + 0.7 * random_unit());
        take_mesh(&mesh, &stream);
        const tm_dual_report r = check_dual(&mesh, angles[k % 3]);
        assert_int_equal(r.wrong_pyramids, 0);
        tm_tet_mesh_free(&mesh);
    }
}

/* Of what is concave everywhere hardly a cell is, where it is to be convex: those that
 * have the surface on two sides of a hollow are cut between them. */
static void test_convex(void **state)
{
    (void)state;
    size_t before = 0, after = 0;
    for (int k = 0; k < 12; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_grid(&stream, GRID, 0.2, k % 2);
        keep_some(&stream, 0.7 + 0.2 * random_unit());
        take_mesh(&mesh, &stream);
        before += check(&mesh, 30, false).concave;
        const tm_dual_report r = check(&mesh, 30, true);
        assert_int_equal(r.wrong_pyramids, 0);
        after += r.concave;
        tm_tet_mesh_free(&mesh);
    }
    assert_true(before > 0);
    assert_true(2 * after < before);
}

/* Regions and marked faces at random: faces that stay end anywhere. */
static void test_regions(void **state)
{
    (void)state;
    for (int k = 0; k < 30; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_grid(&stream, 1 + (int)random_below(GRID), 0.4, true);
        tm_block *ele = tm_stream_find(&stream, ".ele");
        const unsigned regions = 1 + random_below(FIXTURE_REGIONS);
        for (size_t t = 0; t < ele->count; t++)
            if (k % 2 || random_below(10) == 0)
                ele->attribute[t] = 1 + random_below(regions);
        tm_block *face = tm_stream_find(&stream, ".face");
        for (size_t f = 0; f < face->count && ele->count > 0; f++) {
            /* A face of a tetrahedron, whichever: no row is there twice. */
            const uint32_t *n = ele->integer + 4 * random_below((unsigned)ele->count);
            if (random_below(3) > 0)
                continue;
            bool known = false;
            for (size_t g = 0; g < face->count; g++)
                known |= tm_face_has_node(face->integer + 3 * g, n[0]) &&
                         tm_face_has_node(face->integer + 3 * g, n[1]) &&
                         tm_face_has_node(face->integer + 3 * g, n[2]);
            if (known)
                continue;
            memcpy(face->integer + 3 * f, n, 3 * sizeof *n);
            face->marker[f] = 7;
        }
        take_mesh(&mesh, &stream);
        const tm_dual_report r = check_dual(&mesh, angles[k % 3]);
        assert_int_equal(r.wrong_pyramids, 0);
        tm_tet_mesh_free(&mesh);
    }
}

/* Nothing depends on the unit of length. */
static void test_scales(void **state)
{
    (void)state;
    static const double unit[] = {0x1p-140, 0x1p-20, 0x1p140};
    const uint64_t seed = random_state;
    tm_dual_report first = {0};
    for (size_t k = 0; k < sizeof unit / sizeof *unit; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        random_state = seed;
        make_grid(&stream, GRID, 0.4, false);
        keep_some(&stream, 0.8);
        scale_nodes(&stream, unit[k], unit[k], unit[k]);
        take_mesh(&mesh, &stream);
        const tm_dual_report r = check_dual(&mesh, 0);
        if (k == 0)
            first = r;
        assert_memory_equal(&r, &first, sizeof r);
        tm_tet_mesh_free(&mesh);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_tetrahedron), cmocka_unit_test(test_cube),
        cmocka_unit_test(test_grids),           cmocka_unit_test(test_touching),
        cmocka_unit_test(test_convex),          cmocka_unit_test(test_regions),
        cmocka_unit_test(test_scales)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
