/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Delaunay property, and insertion that keeps it: against brute force on small
 * meshes, with cospherical nodes, regions, faces and edges that have to stay, and on
 * meshes that are not Delaunay. */
#include "../../lib/tet/delaunay/delaunay.h"
#include "../../lib/tet/lepp/lepp.h"
#include "tet_fixture.h"

static bool sphere_holds(const tm_tet_mesh *mesh, const uint32_t n[4], uint32_t v)
{
    return tm_insphere(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]], mesh->xyz[n[3]],
                       mesh->xyz[v]) > 0;
}

/* Every sphere against every node. */
static bool all_spheres_are_empty(const tm_tet_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->slots; t++)
        for (uint32_t v = 0; v < mesh->nodes && tm_tet_lives(mesh, t); v++)
            if (sphere_holds(mesh, mesh->tet[t], v))
                return false;
    return true;
}

/* The corner of a tetrahedron that is not among the nodes. */
static uint32_t corner_outside(const uint32_t n[4], const bool *among)
{
    uint32_t i = 0;
    while (i < 3 && among[n[i]])
        i++;
    return i;
}

static void mark(bool *among, const uint32_t n[4], bool is)
{
    for (int i = 0; i < 4; i++)
        among[n[i]] = is;
}

/* Whether the face between tetrahedra t and u, three of whose nodes are the same, has a
 * far node inside a sphere and need not stay. `in_t` marks the nodes of t. */
static bool is_wrong_face(const tm_tet_mesh *mesh, uint32_t t, uint32_t u, bool *in_t)
{
    const uint32_t *n = mesh->tet[t], *m = mesh->tet[u];
    const uint32_t far_u = m[corner_outside(m, in_t)];
    mark(in_t, n, false);
    mark(in_t, m, true);
    const uint32_t at = corner_outside(n, in_t);
    mark(in_t, m, false);
    mark(in_t, n, true);
    return !(mesh->neighbour[t][at] & TM_FACE_BIT) &&
           (sphere_holds(mesh, n, far_u) || sphere_holds(mesh, m, n[at]));
}

/* Inner faces with a far node inside a sphere, by all pairs of tetrahedra. */
static size_t count_wrong_faces(const tm_tet_mesh *mesh)
{
    size_t wrong = 0;
    bool *in_t = calloc(mesh->nodes, sizeof *in_t);
    assert_non_null(in_t);
    for (uint32_t t = 0; t < mesh->slots; t++) {
        if (!tm_tet_lives(mesh, t))
            continue;
        mark(in_t, mesh->tet[t], true);
        for (uint32_t u = 0; u < t; u++) {
            const uint32_t *m = mesh->tet[u];
            if (tm_tet_lives(mesh, u) &&
                in_t[m[0]] + in_t[m[1]] + in_t[m[2]] + in_t[m[3]] == 3)
                wrong += is_wrong_face(mesh, t, u, in_t);
        }
        mark(in_t, mesh->tet[t], false);
    }
    free(in_t);
    return wrong;
}

/* Moves the planes of the grid, so that its cells become boxes: still Delaunay, and with
 * eight nodes on each sphere. */
static void stretch(tm_tet_mesh *mesh, int n)
{
    enum { MOST = 8 };
    double at[3][MOST + 1];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i <= n; i++)
            at[k][i] = (i > 0 ? at[k][i - 1] : 0) + (1 + random_below(63)) / 32.;
    for (size_t v = 0; v < mesh->nodes; v++) {
        double *p = mesh->xyz[v];
        for (int k = 0; k < 3; k++)
            p[k] = at[k][(int)p[k]];
        mesh->node_attribute[v] = p[0] + 2 * p[1] - p[2];
    }
    assert_valid(mesh);
}

static tm_lepp_report run(tm_tet_mesh *mesh, double angle, size_t passes,
                          tm_lepp_path path)
{
    const tm_lepp_options options = {.algorithm = TM_LEPP_DELAUNAY,
                                     .angle = angle,
                                     .measure = TM_MEASURE_DIHEDRAL,
                                     .stop = TM_LEPP_PASSES,
                                     .passes = passes,
                                     .path = path};
    tm_lepp_report report;
    tm_error error = {0};
    invariants before = measure_invariants(mesh);
    if (tm_lepp_improve(mesh, &options, &report, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(mesh);
    invariants after = measure_invariants(mesh);
    assert_same_invariants(&before, &after);
    assert_int_equal(report.not_delaunay_after, tm_tet_mesh_not_delaunay(mesh));
    return report;
}

/* The count of wrong faces is that of brute force, and 0 just where all spheres are
 * empty. */
static void test_property(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, 3, k == 0 ? 0 : 0.3 * random_unit(), false);
        size_t wrong = tm_tet_mesh_not_delaunay(&mesh);
        assert_int_equal(wrong, count_wrong_faces(&mesh));
        assert_int_equal(wrong == 0, all_spheres_are_empty(&mesh));
        assert_true(k > 0 || wrong == 0);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* A Delaunay mesh of a box stays Delaunay, with all its nodes on common spheres or not.
 * The edge inside that has a marker stays. */
static void test_boxes(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, 3, 0, false);
        if (k > 0)
            stretch(&mesh, 3);
        assert_int_equal(tm_tet_mesh_not_delaunay(&mesh), 0);
        tm_lepp_report report = run(&mesh, 50, 1, k % 2 ? TM_LEPP_FULL : TM_LEPP_SIMPLE);
        assert_true(report.delaunay.insertions > 0);
        assert_int_equal(report.delaunay.cut_back, 0);
        assert_int_equal(report.not_delaunay_after, 0);
        assert_true(all_spheres_are_empty(&mesh));
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* With regions it stays constrained Delaunay: no cavity crosses the faces between. */
static void test_regions(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, 3, 0, true);
        stretch(&mesh, 3);
        tm_lepp_report report = run(&mesh, 50, 2, k % 2 ? TM_LEPP_FULL : TM_LEPP_SIMPLE);
        assert_true(report.delaunay.insertions > 0);
        assert_true(report.delaunay.flipped > 0);
        assert_int_equal(report.not_delaunay_after, 0);
        assert_int_equal(count_wrong_faces(&mesh), 0);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* Faces inside with a marker, here and there: some are alone, with cavities around them.
 */
static void test_loose_faces(void **state)
{
    (void)state;
    enum { INNER = 12, MARKER = FIXTURE_MARKERS - 1 };
    for (int k = 0; k < 6; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        tm_error error = {0};
        make_grid(&stream, 3, 0, false);
        tm_block *face = tm_stream_find(&stream, ".face");
        const tm_block *ele = tm_stream_find(&stream, ".ele");
        size_t boundary = face->count;
        uint32_t rows[6 * 27 * 3];
        int32_t markers[6 * 27];
        memcpy(rows, face->integer, 3 * boundary * sizeof *rows);
        memcpy(markers, face->marker, boundary * sizeof *markers);
        size_t count = boundary;
        while (count < boundary + INNER) {
            const uint32_t *n = ele->integer + 4 * random_below((unsigned)ele->count);
            bool known = false;
            for (size_t f = 0; f < count; f++) {
                int same = 0;
                for (int i = 0; i < 9; i++)
                    same += rows[3 * f + (size_t)(i / 3)] == n[i % 3];
                known |= same == 3;
            }
            if (known)
                continue;
            memcpy(rows + 3 * count, n, 3 * sizeof *n);
            markers[count++] = MARKER;
        }
        assert_int_equal(tm_block_allocate(face, count, 0, NULL), TM_OK);
        memcpy(face->integer, rows, 3 * count * sizeof *rows);
        memcpy(face->marker, markers, count * sizeof *markers);
        if (tm_tet_mesh_from_stream(&mesh, &stream, 1, &error) != TM_OK)
            fail_msg("%s", error.what);
        stretch(&mesh, 3);
        assert_true(measure_invariants(&mesh).area[MARKER] > 0);
        tm_lepp_report report = run(&mesh, 50, 1, TM_LEPP_SIMPLE);
        assert_true(report.delaunay.insertions > 0);
        assert_int_equal(report.not_delaunay_after, 0);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* A mesh that is not Delaunay: said, and improved all the same. */
static void test_not_delaunay(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, 3, 0.9, false);
        size_t wrong = tm_tet_mesh_not_delaunay(&mesh);
        assert_true(wrong > 0);
        tm_lepp_report report = run(&mesh, 35, 1, k % 2 ? TM_LEPP_FULL : TM_LEPP_SIMPLE);
        assert_int_equal(report.not_delaunay_before, wrong);
        assert_int_equal(report.delaunay.refused, 0);
        assert_true(report.delaunay.insertions > 0);
        assert_true(report.delaunay.removed >= report.delaunay.insertions);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_property), cmocka_unit_test(test_boxes),
        cmocka_unit_test(test_regions), cmocka_unit_test(test_loose_faces),
        cmocka_unit_test(test_not_delaunay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
