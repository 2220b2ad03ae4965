/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volumes of kernels against what they must add up to; shapes that are known; statistics
 * of meshes of which all is known. */
#include "../../lib/geom/kernel.h"
#include "../../lib/examine/poly/poly_parts.h"
#include "../../lib/examine/poly/poly_statistics.h"
#include "random.h"
#include "voxels.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 128 };

static bool close_to(double value, double right)
{
    return fabs(value - right) <= 1e-12 * (1 + fabs(right));
}

static double between(double lo, double hi)
{
    return lo + (hi - lo) * random_unit();
}

static void random_plane(double plane[4], double lo, double hi)
{
    double length2;
    do {
        length2 = 0;
        for (int k = 0; k < 3; k++) {
            plane[k] = between(-1, 1);
            length2 += plane[k] * plane[k];
        }
    } while (length2 > 1 || length2 < 0.01);
    for (int k = 0; k < 3; k++)
        plane[k] /= sqrt(length2);
    plane[3] = between(lo, hi);
}

/* The box of side 2 around the origin. */
static size_t box(double (*plane)[4])
{
    memset(plane, 0, 6 * sizeof *plane);
    for (size_t i = 0; i < 6; i++) {
        plane[i][i / 2] = i % 2 ? 1 : -1;
        plane[i][3] = 1;
    }
    return 6;
}

/* 0 where there is no inner point. */
static double volume_of(const double (*plane)[4], size_t count)
{
    const double reach = 4;
    tm_kernel_memory memory = {0};
    double center[3], radius, volume = 0;
    if (tm_kernel_ball(plane, count, center, &radius) && radius > 0)
        assert_non_null(tm_kernel_volume(&memory, plane, count, center, reach, &volume));
    tm_kernel_memory_free(&memory);
    return volume;
}

static void test_kernel_volume(void **state)
{
    (void)state;
    double plane[MOST][4];
    size_t count = box(plane);
    assert_true(close_to(volume_of((const double(*)[4])plane, count), 8));
    /* Planes twice, some of them moved by rounding, and planes that do not matter. */
    for (size_t i = 0; i < 6; i++) {
        memcpy(plane[count], plane[i], sizeof *plane);
        plane[count++][3] += i % 2 ? 0x1p-52 : 0;
        memcpy(plane[count], plane[i], sizeof *plane);
        plane[count][(i / 2 + 1) % 3] = 1e-15;
        count++;
    }
    for (; count < MOST; count++)
        random_plane(plane[count], 2, 3);
    assert_true(close_to(volume_of((const double(*)[4])plane, MOST), 8));
    /* A corner cut off: 1/6 of a cube of side 1. */
    count = box(plane);
    for (int k = 0; k < 3; k++)
        plane[count][k] = sqrt(1.0 / 3);
    plane[count++][3] = 2 * sqrt(1.0 / 3);
    assert_true(close_to(volume_of((const double(*)[4])plane, count), 8 - 1.0 / 6));
    for (int k = 0; k < 4; k++)
        plane[count - 1][k] *= -1;
    assert_true(close_to(volume_of((const double(*)[4])plane, count), 1.0 / 6));
}

/* All planes twice change nothing; a plane cuts it into two parts. */
static void test_kernel_volume_parts(void **state)
{
    (void)state;
    enum { ROUNDS = 1000, PLANES = 80 };
    for (int round = 0; round < ROUNDS; round++) {
        double plane[MOST][4];
        size_t count = box(plane);
        for (const size_t end = count + random_below(PLANES); count < end; count++)
            random_plane(plane[count], 0.2, 1);
        const double whole = volume_of((const double(*)[4])plane, count);
        double twice[2 * MOST][4];
        memcpy(twice, plane, count * sizeof *twice);
        memcpy(twice + count, plane, count * sizeof *twice);
        assert_true(fabs(volume_of((const double(*)[4])twice, 2 * count) - whole) <
                    1e-10);
        random_plane(plane[count], -0.5, 0.5);
        double parts = volume_of((const double(*)[4])plane, count + 1);
        for (int k = 0; k < 4; k++)
            plane[count][k] *= -1;
        parts += volume_of((const double(*)[4])plane, count + 1);
        assert_true(whole > 0);
        assert_true(fabs(parts - whole) < 1e-10);
    }
}

static tm_poly_shape shape_of(const voxels *v, uint32_t cell)
{
    tm_poly_boundary b = {0};
    tm_poly_shape_memory memory = {0};
    tm_poly_shape shape;
    const size_t start = v->cell_start[cell];
    assert_int_equal(tm_poly_boundary_find(&b, &v->mesh, v->cell_facet + start,
                                           v->cell_start[cell + 1] - start, cell, NULL),
                     TM_OK);
    assert_int_equal(tm_poly_shape_measure(&shape, &memory, &b, v->mesh.xyz, NULL),
                     TM_OK);
    tm_poly_boundary_free(&b);
    tm_poly_shape_memory_free(&memory);
    return shape;
}

static tm_poly_shape shape_of_picture(int x, int y, int z, const char *picture)
{
    voxels v = voxels_of(x, y, z, picture);
    voxels_join(&v);
    /* Size 1/4, far from the origin. */
    for (size_t i = 0; i < v.mesh.nodes; i++)
        for (int k = 0; k < 3; k++)
            v.xyz[i][k] = 1000 + v.xyz[i][k] / 4;
    const tm_poly_shape shape = shape_of(&v, 0);
    voxels_free(&v);
    return shape;
}

static void test_shapes(void **state)
{
    (void)state;
    tm_poly_shape s = shape_of_picture(1, 1, 1, "0");
    assert_true(close_to(s.volume, 1.0 / 64) && close_to(s.diameter, sqrt(3) / 4));
    assert_true(close_to(s.min_edge, 0.25) && close_to(s.min_face_area, 1.0 / 16));
    assert_true(close_to(s.min_dihedral, 90) && close_to(s.max_dihedral, 90));
    assert_true(s.star_shaped && close_to(s.kernel_radius, 0.5 / sqrt(3)));
    assert_true(close_to(s.kernel_ratio, 1) && close_to(s.rho[0], 1));
    assert_true(close_to(s.rho[1], (1 / sqrt(3) + 1 / sqrt(2)) / 2));
    assert_true(close_to(s.rho[2], (4. / 6 + 3. / 4) / 2));
    assert_true(close_to(s.centroid_depth, 0.5 / sqrt(3)));
    /* Three cubes at a corner: the one in the middle sees the others. */
    s = shape_of_picture(2, 2, 1, "000.");
    assert_true(close_to(s.volume, 3.0 / 64) && close_to(s.diameter, 3.0 / 4));
    assert_true(close_to(s.min_dihedral, 90) && close_to(s.max_dihedral, 270));
    assert_true(s.star_shaped && close_to(s.kernel_radius, 0.5 / 3));
    assert_true(close_to(s.kernel_ratio, 1.0 / 3));
    /* A cross: the cube in the middle of seven. */
    s = shape_of_picture(3, 3, 3, "....0.....0.000.0.....0....");
    assert_true(s.star_shaped && close_to(s.kernel_ratio, 1.0 / 7));
    assert_true(close_to(s.rho[0], 1.0 / 7) &&
                close_to(s.centroid_depth, 0.5 / sqrt(11)));
    /* Kernels that are flat, empty, and of a ring. */
    s = shape_of_picture(3, 2, 1, "00..00");
    assert_true(!s.star_shaped && s.kernel_radius == 0 && s.kernel_ratio == 0);
    s = shape_of_picture(4, 2, 1, "000.0.00");
    assert_true(!s.star_shaped && s.kernel_radius == 0 && s.kernel_ratio == 0);
    s = shape_of_picture(3, 3, 1, "0000.0000");
    assert_true(!s.star_shaped && close_to(s.volume, 8.0 / 64));
    assert_true(s.rho[0] == 0 && s.centroid_depth < 0);
}

enum { MOST_CORNERS = 8 };

/* A prism of height 1 on a polygon, turned, 1/8 as large, far from the origin. */
typedef struct {
    double xyz[2 * MOST_CORNERS][3];
    uint32_t side[MOST_CORNERS + 2][2], facet[MOST_CORNERS + 2];
    uint32_t node[6 * MOST_CORNERS];
    size_t start[MOST_CORNERS + 3], cell[2];
} prism;

static tm_poly_statistics measure_prism(const double (*outline)[2], uint32_t corners)
{
    static const double turn[3][3] = {
        {2 / 3., -1 / 3., 2 / 3.}, {2 / 3., 2 / 3., -1 / 3.}, {-1 / 3., 2 / 3., 2 / 3.}};
    const uint32_t nodes = 2 * corners, facets = corners + 2;
    prism p = {.start = {0, corners, nodes}, .cell = {0, facets}};
    for (uint32_t v = 0; v < nodes; v++)
        for (int k = 0; k < 3; k++) {
            const double *from = outline[v % corners];
            p.xyz[v][k] = 100 + (turn[k][0] * from[0] + turn[k][1] * from[1] +
                                 (v < corners ? 0 : turn[k][2])) /
                                    8;
        }
    for (uint32_t i = 0; i < corners; i++) {
        const uint32_t next = (i + 1) % corners;
        const uint32_t around[4] = {i, next, corners + next, corners + i};
        p.node[i] = corners - 1 - i;
        p.node[corners + i] = corners + i;
        memcpy(p.node + nodes + 4 * (size_t)i, around, sizeof around);
        p.start[i + 3] = p.start[i + 2] + 4;
    }
    for (uint32_t f = 0; f < facets; f++) {
        p.side[f][1] = TM_NONE;
        p.facet[f] = f;
    }
    const tm_poly_arrays mesh = {.nodes = nodes,
                                 .xyz = (const double(*)[3])p.xyz,
                                 .facets = facets,
                                 .side = (const uint32_t(*)[2])p.side,
                                 .facet_start = p.start,
                                 .facet_node = p.node,
                                 .cells = 1,
                                 .cell_start = p.cell,
                                 .cell_facet = p.facet};
    tm_poly_statistics s;
    assert_int_equal(tm_poly_statistics_measure(&s, &mesh, 1, NULL), TM_OK);
    return s;
}

/* An L of three unit cubes with two hexagons: its indicator by hand. */
static void test_indicator(void **state)
{
    (void)state;
    enum { CORNERS = 6, FACETS = CORNERS + 2 };
    static const double outline[CORNERS][2] = {{0, 0}, {2, 0}, {2, 1},
                                               {1, 1}, {1, 2}, {0, 2}};
    const tm_poly_statistics s = measure_prism(outline, CORNERS);
    /* The square in the corner sees all of the hexagon, the cube there all of the prism.
     */
    const double rho1 = 1 / 3. * 1 / 3. * 1 / 3.;
    const double rho2 =
        (sqrt(2) / 3 + (2 / sqrt(8) + 2 / sqrt(5) + 4 / sqrt(2)) / FACETS) / 2;
    const double rho3 = (4. / FACETS + (2 * 3 / 6. + 6 * 3 / 4.) / FACETS) / 2;
    assert_true(fabs(s.volume - 3 / 512.) < 1e-12);
    assert_true(fabs(s.max_diameter - 3 / 8.) < 1e-12);
    assert_true(fabs(s.rho[0].mean - rho1) < 1e-9 && fabs(s.rho[0].min - rho1) < 1e-9);
    assert_true(fabs(s.rho[1].mean - rho2) < 1e-9 && fabs(s.rho[2].mean - rho3) < 1e-12);
    assert_true(fabs(s.vem_indicator - sqrt(rho1 * (rho2 + rho3) / 2)) < 1e-9);
    /* The centroid is at 5/6, the kernel ends at 1, the diameter is 3. */
    assert_true(fabs(s.centroid_depth.mean - 1 / 18.) < 1e-9 && s.centroid_outside == 0);
    /* The hexagons are fans around the corner in the middle. */
    assert_int_equal(s.fv.no_fan + s.fv.unseen, 0);
    assert_int_equal(s.fv.concave, 1);
    assert_true(s.fv.min_weight == 0 && s.fv.small_weights == 0);
}

/* A U: its octagons are no fans, and its centroid does not see all walls. */
static void test_no_fan(void **state)
{
    (void)state;
    enum { CORNERS = 8 };
    static const double outline[CORNERS][2] = {{0, 0}, {3, 0}, {3, 3}, {2, 3},
                                               {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    const tm_poly_statistics s = measure_prism(outline, CORNERS);
    assert_true(s.rho[0].mean == 0 && s.vem_indicator == 0 && s.centroid_outside == 1);
    assert_true(s.fv.no_fan >= 2 && s.fv.unseen >= 2 && s.fv.concave == 1);
}

/* Boxes in a row, as long as 4 and 1/100, beside others: the first is seen to be concave
 * by facets in one plane. */
static void test_all_geometry(void **state)
{
    (void)state;
    voxels v = voxels_of(5, 1, 1, "00001");
    voxels_join(&v);
    for (size_t i = 0; i < v.mesh.nodes; i++)
        v.xyz[i][0] = fmin(v.xyz[i][0], 4.01);
    tm_poly_finite_volume fv;
    assert_int_equal(tm_poly_finite_volume_measure(&fv, &v.mesh, 1, NULL), TM_OK);
    assert_true(close_to(fv.min_weight, 0.005 / 2.005) && fv.small_weights == 1);
    assert_true(close_to(fv.min_volume_ratio, 0.01 / 4) && fv.small_volume_ratios == 1);
    assert_true(fv.min_determinant == 0 && fv.small_determinants == 2);
    assert_true(fv.concave == 1 && fv.no_fan == 0 && fv.reversed == 0);
    voxels_free(&v);
    /* In a block of cubes those at corners have three facets inside. */
    v = voxels_new(3, 3, 3);
    for (int i = 0; i < 27; i++)
        v.label[i] = i;
    voxels_join(&v);
    assert_int_equal(tm_poly_finite_volume_measure(&fv, &v.mesh, 1, NULL), TM_OK);
    assert_true(close_to(fv.min_determinant, 1.0 / 8) && fv.small_determinants == 0);
    assert_true(close_to(fv.min_weight, 0.5) && close_to(fv.min_volume_ratio, 1));
    assert_true(fv.concave + fv.small_weights + fv.small_volume_ratios == 0);
    voxels_free(&v);
    /* A U around a block, its centroid in that: 7 facets between, 6 of them along the
     * line from one centroid to the other. */
    v = voxels_of(4, 3, 1, "000001110000");
    voxels_join(&v);
    assert_int_equal(tm_poly_finite_volume_measure(&fv, &v.mesh, 1, NULL), TM_OK);
    assert_true(fv.reversed == 6 && fv.non_orthogonal == 6 && fv.wrong_pyramids == 7);
    assert_true(fv.unseen == 7 && fv.no_fan == 7 && fv.concave == 2);
    voxels_free(&v);
}

static void test_flat(void **state)
{
    (void)state;
    voxels v = voxels_of(1, 1, 1, "0");
    voxels_join(&v);
    for (size_t i = 0; i < v.mesh.nodes; i++)
        v.xyz[i][2] = 0;
    tm_poly_shape s = shape_of(&v, 0);
    assert_true(s.volume == 0 && !s.star_shaped && s.min_edge == 0);
    assert_true(s.min_face_area == 0 && close_to(s.diameter, sqrt(2)));
    for (size_t i = 0; i < v.mesh.nodes; i++)
        memset(v.xyz[i], 0, sizeof v.xyz[i]);
    s = shape_of(&v, 0);
    assert_true(s.volume == 0 && !s.star_shaped && s.diameter == 0);
    assert_true(s.min_dihedral == 360 && s.max_dihedral == 0);
    assert_true(s.rho[0] == 0 && s.rho[1] == 0 && s.centroid_depth == 0);
    voxels_free(&v);
}

static tm_poly_statistics measure(const voxels *v, unsigned threads)
{
    tm_poly_statistics s;
    assert_int_equal(tm_poly_statistics_measure(&s, &v->mesh, threads, NULL), TM_OK);
    return s;
}

/* A block of 5 by 3 by 2: a ring, its hole, two cubes that touch in an edge, the rest. */
static void test_statistics(void **state)
{
    (void)state;
    voxels v = voxels_of(5, 3, 2,
                         "000230103200033"
                         "444444444444444");
    voxels_join(&v);
    const tm_poly_statistics s = measure(&v, 1);
    assert_int_equal(s.size.elements, 5);
    assert_int_equal(s.size.faces, v.mesh.facets);
    assert_int_equal(s.size.nodes, 72);
    assert_int_equal(s.swallowed, 0);
    assert_int_equal(s.unmatched, 0);
    assert_int_equal(s.non_simple, 3);
    assert_int_equal(s.cause[TM_CAUSE_EULER], 3);
    assert_int_equal(s.cause[TM_CAUSE_PIECES], 0);
    assert_int_equal(s.cause[TM_CAUSE_VERTEX], 0);
    assert_int_equal(s.cause[TM_CAUSE_EDGE], 2);
    assert_int_equal(s.not_star_shaped, 3);
    assert_true(close_to(s.volume, 30) && s.min_volume == 1);
    assert_true(s.min_edge == 1 && s.min_face_area == 1);
    assert_true(close_to(s.min_dihedral, 90) && close_to(s.max_dihedral, 270));
    assert_int_equal(s.input.elements, 180);
    assert_true(s.tets_per_polyhedron == 36);
    assert_int_equal(s.largest_tets, 90);
    assert_int_equal(s.input.faces, 0);
    assert_int_equal(s.input.edges, 0);
    assert_true(close_to(s.kernel_ratio.mean, 2.0 / 5) && s.kernel_ratio.min == 0);
    assert_true(s.centroid_outside == 3 && close_to(s.rho[0].mean, 2.0 / 5));
    assert_true(close_to(s.max_diameter, sqrt(25 + 9 + 1)));
    voxels_free(&v);
}

static void test_swallowed(void **state)
{
    (void)state;
    voxels v = voxels_of(2, 2, 2, "00000000");
    voxels_join(&v);
    tm_poly_statistics s = measure(&v, 1);
    assert_int_equal(s.swallowed, 1);
    assert_int_equal(s.size.nodes, 26);
    assert_int_equal(s.input.nodes, 27);
    assert_int_equal(s.non_simple, 0);
    assert_true(close_to(s.kernel_ratio.mean, 1));
    /* Attributes that are no numbers of tetrahedra. */
    v.attribute[0] = 1.5;
    s = measure(&v, 1);
    assert_int_equal(s.input.elements, 0);
    assert_int_equal(s.input.nodes, 0);
    assert_true(s.tets_per_polyhedron == 0);
    voxels_free(&v);
}

static void test_no_polyhedra(void **state)
{
    (void)state;
    const tm_poly_arrays nothing = {0};
    tm_poly_statistics s;
    assert_int_equal(tm_poly_statistics_measure(&s, &nothing, 1, NULL), TM_OK);
    assert_true(s.volume == 0 && s.min_edge == 0 && s.kernel_ratio.min == 0);
    assert_int_equal(s.size.elements, 0);
}

static void test_bins(void **state)
{
    (void)state;
    static const size_t begin[] = {1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64};
    for (size_t i = 0; i < sizeof begin / sizeof *begin; i++)
        assert_int_equal(tm_count_bin_begin(i), begin[i]);
    assert_true(tm_count_bin_begin(TM_COUNT_BINS) > UINT32_MAX);
}

/* Random labels: all kinds of polyhedra, in more than one chunk. */
static void test_threads(void **state)
{
    (void)state;
    enum { SIDE = 12, CELLS = 800 };
    voxels v = voxels_new(SIDE, SIDE, SIDE);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        v.label[i] = i < CELLS ? i : (int)random_below(CELLS);
    voxels_join(&v);
    for (size_t i = 0; i < v.mesh.nodes; i++)
        for (int k = 0; k < 3; k++)
            v.xyz[i][k] += random_unit() / 8;
    const tm_poly_statistics alone = measure(&v, 1);
    assert_true(alone.non_simple > 0 && alone.non_simple < CELLS);
    for (unsigned threads = 2; threads < 5; threads++) {
        const tm_poly_statistics s = measure(&v, threads);
        assert_memory_equal(&s, &alone, sizeof s);
    }
    voxels_free(&v);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kernel_volume), cmocka_unit_test(test_kernel_volume_parts),
        cmocka_unit_test(test_shapes),        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_statistics),    cmocka_unit_test(test_swallowed),
        cmocka_unit_test(test_no_polyhedra),  cmocka_unit_test(test_bins),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_indicator),
        cmocka_unit_test(test_no_fan),        cmocka_unit_test(test_all_geometry),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
