/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dihedral angles, sin² and volume quality of tetrahedra with known ones, and of random
 * ones against each other. */
#include "../../lib/geom/predicates.h"
#include "../../lib/geom/vector.h"
#include "../../lib/element/tet_four.h"
#include "../../lib/element/tet_measure.h"
#include "../../lib/element/tet_quality.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { DIMENSIONS = 3, CORNERS = 4 };

typedef double tetrahedron[CORNERS][DIMENSIONS];

static const double pi = 3.14159265358979323846;

static const tetrahedron regular = {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
static const tetrahedron right_corner = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const tetrahedron flat = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

/* Four points near the equator of a sphere: two angles near 180°, four near 0°. */
static const tetrahedron sliver = {
    {1, 0, -1e-3}, {0, 1, 1e-3}, {-1, 0, -1e-3}, {0, -1, 1e-3}};

/* A point near the middle of a triangle: three angles near 180°, three near 0°. */
static const tetrahedron cap = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {1, 1, 1e-3}};

static double sine2(const tetrahedron t)
{
    return tm_tet_sine2(t[0], t[1], t[2], t[3]);
}

static double volume_quality(const tetrahedron t)
{
    return tm_tet_volume_quality(t[0], t[1], t[2], t[3]);
}

/* min(α, 180° - α) over the six angles. */
static double worst_angle(const tetrahedron t)
{
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(t[0], t[1], t[2], t[3], angle);
    double worst = 90;
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        worst = fmin(worst, fmin(angle[e], 180 - angle[e]));
    return worst;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

static void test_regular(void **state)
{
    (void)state;
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(regular[0], regular[1], regular[2], regular[3], angle);
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        assert_near(angle[e], 70.528779365509308, 1e-13);
    assert_near(sine2(regular), 8.0 / 9, 1e-15);
    assert_near(tm_sine2_to_degrees(sine2(regular)), 70.528779365509308, 1e-13);
    assert_near(volume_quality(regular), 1, 1e-15);
}

static void test_right_corner(void **state)
{
    (void)state;
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(right_corner[0], right_corner[1], right_corner[2], right_corner[3],
                     angle);
    for (size_t e = 0; e < TM_TET_EDGES; e++) {
        const bool at_corner = tm_edge_corner[e][0] == 0;
        assert_near(angle[e], at_corner ? 90 : acos(1 / sqrt(3)) * 180 / pi, 1e-13);
    }
    assert_near(sine2(right_corner), 2.0 / 3, 1e-15);
    assert_near(volume_quality(right_corner), 0.5, 1e-15);
    assert_near(tm_triangle_area(right_corner[1], right_corner[2], right_corner[3]),
                sqrt(3) / 2, 1e-15);
    assert_near(
        tm_tet_volume(right_corner[0], right_corner[1], right_corner[2], right_corner[3]),
        1.0 / 6, 1e-16);
}

/* Which angle belongs to which edge: a wedge of 1 radian at each edge in turn. */
static void test_edge_order(void **state)
{
    (void)state;
    for (size_t e = 0; e < TM_TET_EDGES; e++) {
        const unsigned char *end = tm_edge_corner[e];
        const unsigned char *opposite = tm_edge_corner[TM_TET_EDGES - 1 - e];
        tetrahedron t = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        t[end[1]][2] = 1;
        t[opposite[0]][0] = 1;
        t[opposite[1]][0] = cos(1);
        t[opposite[1]][1] = sin(1);
        double angle[TM_TET_EDGES];
        tm_tet_dihedrals(t[0], t[1], t[2], t[3], angle);
        assert_near(angle[e], 180 / pi, 1e-13);
    }
}

static void test_bad_shapes(void **state)
{
    (void)state;
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(sliver[0], sliver[1], sliver[2], sliver[3], angle);
    const double small = acos(1 / (1 + 4e-6)) * 180 / pi;
    assert_near(angle[0], small, 1e-9); /* ab and cd are sides of the sliver's square */
    assert_near(angle[5], small, 1e-9);
    assert_near(angle[1], 180 - 2 * atan(2e-3) * 180 / pi, 1e-9); /* ac, a diagonal */
    assert_true(sine2(sliver) > 0 && sine2(sliver) < 2e-5);

    tm_tet_dihedrals(cap[0], cap[1], cap[2], cap[3], angle);
    assert_near(angle[0], atan(1e-3) * 180 / pi, 1e-12); /* z = 1e-3 y above ab */
    assert_true(angle[2] > 179 && angle[4] > 179 && angle[5] > 179);
    assert_near(tm_sine2_to_degrees(sine2(cap)), worst_angle(cap), 1e-10);
}

static void test_flat_and_negative(void **state)
{
    (void)state;
    assert_true(sine2(flat) == 0);
    assert_true(volume_quality(flat) == 0);
    assert_near(worst_angle(flat), 0, 0);
    assert_true(tm_tet_sine2(regular[1], regular[0], regular[2], regular[3]) == 0);
    assert_near(tm_tet_volume_quality(regular[1], regular[0], regular[2], regular[3]), -1,
                1e-15);
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(regular[1], regular[0], regular[2], regular[3], angle);
    assert_near(angle[0], 70.528779365509308, 1e-13);

    const double *point = regular[0];
    assert_true(tm_tet_sine2(point, point, point, point) == 0);
    assert_true(tm_tet_volume_quality(point, point, point, point) == 0);
    tm_tet_dihedrals(point, point, point, point, angle);
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        assert_near(angle[e], 0, 0);

    /* Two corners in one place: faces without area have angles of 0, not 180. */
    tm_tet_dihedrals(flat[0], flat[1], flat[2], flat[0], angle);
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        assert_near(angle[e], 0, 0);
}

/* Corners where random_unit() is stretched by up to 1000 along each axis. */
static void random_tetrahedron(tetrahedron t)
{
    for (size_t i = 0; i < DIMENSIONS; i++) {
        const double stretch = pow(1000, random_unit());
        for (size_t v = 0; v < CORNERS; v++)
            t[v][i] = stretch * random_unit();
    }
    if (tm_tet_volume(t[0], t[1], t[2], t[3]) < 0) {
        double kept[DIMENSIONS];
        memcpy(kept, t[0], sizeof kept);
        memcpy(t[0], t[1], sizeof kept);
        memcpy(t[1], kept, sizeof kept);
    }
}

/* A tetrahedron with two corners very near to each other. */
static void random_needle(tetrahedron t)
{
    do {
        random_tetrahedron(t);
        const double near = pow(10, -6 * random_unit());
        for (size_t i = 0; i < DIMENSIONS; i++)
            t[3][i] = t[2][i] + near * (t[3][i] - t[2][i]);
    } while (tm_tet_volume(t[0], t[1], t[2], t[3]) <= 0);
}

static void test_sine2_is_the_dihedrals(void **state)
{
    (void)state;
    tetrahedron t;
    for (int n = 0; n < 20000; n++) {
        if (n % 2 == 0)
            random_tetrahedron(t);
        else
            random_needle(t);
        /* asin loses half of the digits near 90°. */
        const double worst = worst_angle(t);
        const double expected = sin(worst * pi / 180);
        assert_near(sqrt(sine2(t)), expected, 1e-9 * expected + 1e-12);
    }
}

/* The angle between the two parts of the faces that are at right angles to the edge. */
static double angle_at_edge(const tetrahedron t, const unsigned char end[2],
                            const unsigned char opposite[2])
{
    double along[DIMENSIONS], away[2][DIMENSIONS], normal[DIMENSIONS];
    tm_subtract(along, t[end[1]], t[end[0]]);
    for (size_t side = 0; side < 2; side++) {
        tm_subtract(away[side], t[opposite[side]], t[end[0]]);
        const double shift = tm_dot(away[side], along) / tm_norm2(along);
        for (size_t i = 0; i < DIMENSIONS; i++)
            away[side][i] -= shift * along[i];
    }
    tm_cross(normal, away[0], away[1]);
    return atan2(tm_norm(normal), tm_dot(away[0], away[1])) * 180 / pi;
}

static void test_dihedrals_are_angles_across_edges(void **state)
{
    (void)state;
    tetrahedron t;
    for (int n = 0; n < 5000; n++) {
        random_tetrahedron(t);
        double angle[TM_TET_EDGES];
        tm_tet_dihedrals(t[0], t[1], t[2], t[3], angle);
        for (size_t e = 0; e < TM_TET_EDGES; e++) {
            const double expected =
                angle_at_edge(t, tm_edge_corner[e], tm_edge_corner[TM_TET_EDGES - 1 - e]);
            assert_near(angle[e], expected, 1e-7);
        }
    }
}

static void test_even_permutations(void **state)
{
    (void)state;
    static const unsigned char order[][CORNERS] = {{1, 2, 0, 3}, {2, 0, 1, 3},
                                                   {1, 0, 3, 2}, {3, 2, 1, 0},
                                                   {0, 2, 3, 1}, {3, 1, 0, 2}};
    tetrahedron t, turned;
    for (int n = 0; n < 1000; n++) {
        random_tetrahedron(t);
        for (size_t p = 0; p < sizeof order / sizeof *order; p++) {
            for (size_t v = 0; v < CORNERS; v++)
                memcpy(turned[v], t[order[p][v]], sizeof turned[v]);
            assert_near(sqrt(sine2(turned)), sqrt(sine2(t)), 1e-10);
            assert_near(worst_angle(turned), worst_angle(t), 1e-8);
            assert_near(volume_quality(turned), volume_quality(t), 1e-12);
        }
    }
}

/* Scaled by powers of two nothing changes at all, from near the smallest numbers to near
 * the largest; by others and shifted, little. */
static void test_scale_and_shift(void **state)
{
    (void)state;
    static const int exponents[] = {-900, -400, -200, -112, -108, -104, -90, -60,
                                    -1,   1,    60,   90,   104,  108,  400, 1000};
    tetrahedron t, moved;
    for (int n = 0; n < 200; n++) {
        random_tetrahedron(t);
        for (size_t s = 0; s < sizeof exponents / sizeof *exponents; s++) {
            for (size_t v = 0; v < CORNERS; v++) {
                for (size_t i = 0; i < DIMENSIONS; i++)
                    moved[v][i] = ldexp(t[v][i], exponents[s]);
            }
            assert_near(sine2(moved), sine2(t), 1e-12 * sine2(t));
            assert_near(worst_angle(moved), worst_angle(t), 1e-9);
            assert_near(volume_quality(moved), volume_quality(t), 1e-14);
        }
        for (size_t v = 0; v < CORNERS; v++) {
            for (size_t i = 0; i < DIMENSIONS; i++)
                moved[v][i] = 0.1 * t[v][i] + 1000;
        }
        assert_near(worst_angle(moved), worst_angle(t), 1e-4);
        assert_near(volume_quality(moved), volume_quality(t), 1e-8);
    }
}

/* A wedge with that angle at the edge ab, turned and shifted; its other angles are
 * between 40° and 140° for angles near 30°. */
static void wedge(tetrahedron t, double degrees, double turn, double shift)
{
    const double half = degrees / 2 * pi / 180;
    const double width = 1 / tan(half);
    const tetrahedron wanted = {{0, 0, -1}, {0, 0, 1}, {width, -1, 0}, {width, 1, 0}};
    for (size_t v = 0; v < CORNERS; v++) {
        t[v][0] = shift + cos(turn) * wanted[v][0] - sin(turn) * wanted[v][1];
        t[v][1] = shift + sin(turn) * wanted[v][0] + cos(turn) * wanted[v][1];
        t[v][2] = shift + wanted[v][2];
    }
}

static bool bad_by_dihedrals(const tetrahedron t, double limit)
{
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(t[0], t[1], t[2], t[3], angle);
    bool bad = false;
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        bad = bad || angle[e] < limit - TM_ANGLE_TOLERANCE ||
              tm_angle_above(angle[e], 180 - limit);
    return bad;
}

/* Angles of exactly 30° are not bad whichever way they are rounded; a little less is. */
static void test_the_limit(void **state)
{
    (void)state;
    static const double limits[] = {30, 20, 35};
    unsigned rounded_down = 0;
    for (size_t l = 0; l < sizeof limits / sizeof *limits; l++) {
        const double bad = tm_bad_sine2(limits[l]);
        for (int n = 0; n < 2000; n++) {
            tetrahedron t;
            const double turn = 7 * random_unit();
            const double shift = 100 * random_unit();
            wedge(t, limits[l], turn, shift);
            rounded_down += worst_angle(t) < limits[l];
            assert_false(sine2(t) < bad);
            assert_false(bad_by_dihedrals(t, limits[l]));
            wedge(t, limits[l] - 2 * TM_ANGLE_TOLERANCE, turn, shift);
            assert_true(sine2(t) < bad);
            assert_true(bad_by_dihedrals(t, limits[l]));
        }
    }
    assert_true(rounded_down > 0);
    assert_true(sine2(flat) < tm_bad_sine2(30));
    assert_true(tm_bad_sine2(0) == 0);
}

static void test_random_bad_alike(void **state)
{
    (void)state;
    const double bad = tm_bad_sine2(30);
    tetrahedron t;
    unsigned found[2] = {0, 0};
    for (int n = 0; n < 20000; n++) {
        random_tetrahedron(t);
        assert_int_equal(sine2(t) < bad, bad_by_dihedrals(t, 30));
        found[sine2(t) < bad]++;
    }
    assert_true(found[0] > 0 && found[1] > 0);
}

/* The quick bound is below what is asked for, and near; where that cannot be reached, so
 * says the bound. */
static void test_bound_of_gain(void **state)
{
    (void)state;
    static const double factors[] = {1 + 1e-5, 1.1, 1.5, 2, 3, 10, 100};
    for (size_t f = 0; f < sizeof factors / sizeof *factors; f++) {
        const tm_gain gain = tm_gain_of(TM_MEASURE_DIHEDRAL, factors[f]);
        const double sine = sin(pi / 2 / factors[f]), most = sine * sine;
        assert_true(tm_gain_bound(&gain, 0) == DBL_MIN);
        for (int n = 0; n < 20000; n++) {
            double value = random_unit() * most * 1.05;
            if (n % 4 == 0)
                value *= value * value;
            double bound = tm_gain_bound(&gain, value),
                   least = tm_gain_least(&gain, value);
            assert_true(bound <= least);
            assert_true(least == HUGE_VAL ? bound == HUGE_VAL : bound > least - 0.02);
        }
    }
    const tm_gain volume = tm_gain_of(TM_MEASURE_VOLUME, 2);
    assert_true(tm_gain_bound(&volume, 0.25) == nextafter(0.5, 1));
    assert_true(tm_gain_bound(&volume, 0) == DBL_MIN);
}

#ifdef TM_FOUR_IS_THERE

TM_FOUR static void measure_four(tetrahedron t[4], double sine2_of[4],
                                 double length2[TM_TET_EDGES][4], unsigned *valid,
                                 unsigned *positive)
{
    tm_vector_four corner[CORNERS];
    for (int v = 0; v < CORNERS; v++)
        corner[v] = tm_four_points(t[0][v], t[1][v], t[2][v], t[3][v]);
    const tm_four_measure m = tm_four_sine2(corner[0], corner[1], corner[2], corner[3]);
    _mm256_storeu_pd(sine2_of, m.sine2);
    for (int e = 0; e < TM_TET_EDGES; e++)
        _mm256_storeu_pd(length2[e], m.length2[e]);
    *valid = tm_four_bits(m.valid);
    *positive = tm_four_positive(&m);
}

/* Random ones, some of them flat, nearly flat, negative, or degenerate to a triangle, an
 * edge or a point; of all scales. */
static void any_tetrahedron(tetrahedron t)
{
    random_tetrahedron(t);
    unsigned shape = random_below(8);
    for (int i = 0; i < DIMENSIONS; i++) {
        if (shape < 2)
            t[3][i] = (t[0][i] + t[1][i]) / 2 + (shape ? 1e-9 * random_unit() : 0);
        if (shape == 2)
            t[2][i] = t[1][i];
        if (shape == 3 && random_below(8) == 0)
            t[1][i] = t[2][i] = t[3][i] = t[0][i];
    }
    if (random_below(4) > 0)
        return;
    int exponent = (int)random_below(700) - 350;
    for (int v = 0; v < CORNERS; v++)
        for (int i = 0; i < DIMENSIONS; i++)
            t[v][i] = ldexp(t[v][i], exponent);
}

static void test_four_are_as_each(void **state)
{
    (void)state;
    if (!tm_has_four())
        skip();
    size_t valid_ones = 0, positive_ones = 0;
    for (int n = 0; n < 50000; n++) {
        tetrahedron t[4];
        double sine2_of[4], length2[TM_TET_EDGES][4];
        unsigned valid, positive;
        for (int k = 0; k < 4; k++)
            any_tetrahedron(t[k]);
        measure_four(t, sine2_of, length2, &valid, &positive);
        for (unsigned k = 0; k < 4; k++) {
            bool measured;
            double one =
                tm_tet_sine2_measure(t[k][0], t[k][1], t[k][2], t[k][3], &measured);
            assert_int_equal(valid >> k & 1, measured);
            assert_memory_equal(&sine2_of[k], &one, sizeof one);
            for (int e = 0; e < TM_TET_EDGES; e++)
                assert_true(length2[e][k] == tm_distance2(t[k][tm_edge_corner[e][0]],
                                                          t[k][tm_edge_corner[e][1]]));
            if (positive >> k & 1)
                assert_int_equal(tm_orient3d_exact(t[k][0], t[k][1], t[k][2], t[k][3]),
                                 1);
            valid_ones += measured;
            positive_ones += positive >> k & 1;
        }
    }
    assert_true(valid_ones > 100000 && positive_ones > 50000);
}

#else

static void test_four_are_as_each(void **state)
{
    (void)state;
    skip();
}

#endif

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_regular),
        cmocka_unit_test(test_right_corner),
        cmocka_unit_test(test_edge_order),
        cmocka_unit_test(test_bad_shapes),
        cmocka_unit_test(test_flat_and_negative),
        cmocka_unit_test(test_sine2_is_the_dihedrals),
        cmocka_unit_test(test_dihedrals_are_angles_across_edges),
        cmocka_unit_test(test_even_permutations),
        cmocka_unit_test(test_scale_and_shift),
        cmocka_unit_test(test_the_limit),
        cmocka_unit_test(test_random_bad_alike),
        cmocka_unit_test(test_bound_of_gain),
        cmocka_unit_test(test_four_are_as_each),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
