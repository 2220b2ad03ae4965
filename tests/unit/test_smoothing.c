/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What smoothing is made of: slopes against differences, the shortest vector against a
 * slow method that cannot be wrong, and climbs to optima that are known. */
#include "../../lib/geom/vector.h"
#include "../../lib/element/tet_slope.h"
#include "../../lib/tet/operation/shortest_vector.h"
#include "../../lib/tet/operation/cavity_boundary.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A random tetrahedron of a random size, positive and not too flat. */
static void random_tet(double x[4][3], double *size)
{
    const double flat = 0.02;
    *size = ldexp(1, (int)random_below(290) - 145);
    do
        for (int v = 0; v < 4; v++)
            for (int k = 0; k < 3; k++)
                x[v][k] = *size * (2 * random_unit() - 1);
    while (tm_tet_volume(x[0], x[1], x[2], x[3]) < flat * *size * *size * *size);
}

/* The functions whose slopes tm_tet_slopes() gives, in its order. */
static void values_at(tm_tet_measure measure, double x[4][3], double value[TM_SLOPES])
{
    static const int edge[TM_SLOPES] = {3, 1, 0, 2, 4, 5}; /* bc ac ab ap bp cp */
    const double half_turn = 180, pi = acos(-1);
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(x[0], x[1], x[2], x[3], angle);
    for (int i = 0; i < TM_SLOPES; i++)
        value[i] = sin(angle[edge[i]] * pi / half_turn);
    if (measure == TM_MEASURE_VOLUME)
        value[0] = tm_tet_volume_quality(x[0], x[1], x[2], x[3]);
}

static void check_slopes(tm_tet_measure measure)
{
    const double close = 1e-5, all = 2;
    tm_slope slope[TM_SLOPES], below[TM_SLOPES];
    double x[4][3], size, value[TM_SLOPES], more[TM_SLOPES], less[TM_SLOPES];
    random_tet(x, &size);
    values_at(measure, x, value);
    size_t count = tm_tet_slopes(measure, x[0], x[1], x[2], x[3], all, slope);
    assert_int_equal(count, measure == TM_MEASURE_DIHEDRAL ? TM_SLOPES : 1);
    const double step = 1e-6 * size;
    for (int k = 0; k < 3; k++) {
        double at = x[3][k];
        x[3][k] = at + step;
        values_at(measure, x, more);
        x[3][k] = at - step;
        values_at(measure, x, less);
        x[3][k] = at;
        for (size_t i = 0; i < count; i++) {
            double difference = (more[i] - less[i]) / (2 * step) * size;
            double gradient = slope[i].gradient[k] * size;
            /* The longest edge may be another one on one side. */
            if (measure == TM_MEASURE_DIHEDRAL)
                assert_true(fabs(gradient - difference) < close * (1 + fabs(gradient)));
            else
                assert_true(fabs(gradient) < 100);
        }
    }
    size_t fewer = 0;
    double limit = random_unit();
    for (size_t i = 0; i < count; i++) {
        assert_true(fabs(slope[i].value - value[i]) < close);
        fewer += slope[i].value < limit;
    }
    assert_int_equal(tm_tet_slopes(measure, x[0], x[1], x[2], x[3], limit, below), fewer);
}

static void test_slopes(void **state)
{
    (void)state;
    for (int k = 0; k < 20000; k++)
        check_slopes(k % 4 ? TM_MEASURE_DIHEDRAL : TM_MEASURE_VOLUME);
}

/* The volume quality of a tetrahedron whose longest edge is not at p, and of one whose
 * is. */
static void test_slope_of_volume(void **state)
{
    (void)state;
    const double close = 1e-6, step = 1e-6;
    double x[2][4][3] = {{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0.3, 0.4, 1}},
                         {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.2, 4}}};
    for (int t = 0; t < 2; t++) {
        tm_slope slope[TM_SLOPES];
        assert_int_equal(tm_tet_slopes(TM_MEASURE_VOLUME, x[t][0], x[t][1], x[t][2],
                                       x[t][3], 2, slope),
                         1);
        for (int k = 0; k < 3; k++) {
            double p[3], q[3];
            memcpy(p, x[t][3], sizeof p);
            memcpy(q, x[t][3], sizeof q);
            p[k] += step;
            q[k] -= step;
            double difference = (tm_tet_volume_quality(x[t][0], x[t][1], x[t][2], p) -
                                 tm_tet_volume_quality(x[t][0], x[t][1], x[t][2], q)) /
                                (2 * step);
            assert_true(fabs(slope->gradient[k] - difference) < close);
        }
    }
}

static void test_degenerate_slopes(void **state)
{
    (void)state;
    tm_slope slope[TM_SLOPES];
    const double a[3] = {0, 0, 0}, b[3] = {1, 0, 0}, c[3] = {0, 1, 0};
    const double below[3] = {0.2, 0.2, -1}, on_edge[3] = {0.5, 0, 0};
    assert_int_equal(tm_tet_slopes(TM_MEASURE_DIHEDRAL, a, b, c, below, 1, slope), 6);
    for (int i = 0; i < TM_SLOPES; i++)
        assert_true(slope[i].value < 0);
    assert_int_equal(tm_tet_slopes(TM_MEASURE_DIHEDRAL, a, b, c, on_edge, 1, slope), 0);
    assert_int_equal(tm_tet_slopes(TM_MEASURE_DIHEDRAL, a, b, c, a, 1, slope), 0);
}

/* A point of the boundary of the vectors that is nearly nearest to the origin: M. Frank
 * and P. Wolfe's method, slow and simple. */
static double slow_shortest(const double *const *vector, size_t count)
{
    enum { ROUNDS = 4000 };
    double p[3];
    memcpy(p, vector[0], sizeof p);
    for (int r = 0; r < ROUNDS; r++) {
        const double *lowest = vector[0];
        for (size_t k = 1; k < count; k++)
            if (tm_dot(p, vector[k]) < tm_dot(p, lowest))
                lowest = vector[k];
        double way[3];
        tm_subtract(way, lowest, p);
        if (!(tm_norm2(way) > 0))
            break;
        double step = fmin(fmax(-tm_dot(p, way) / tm_norm2(way), 0), 1);
        for (int x = 0; x < 3; x++)
            p[x] += step * way[x];
    }
    return tm_norm(p);
}

static void test_shortest_vector(void **state)
{
    (void)state;
    enum { MOST = 30 };
    const double close = 0.02, exact = 1e-6;
    for (int k = 0; k < 3000; k++) {
        double v[MOST][3], p[3];
        const double *vector[MOST];
        size_t count = 1 + random_below(MOST);
        double away = 2 * random_unit();
        for (size_t i = 0; i < count; i++) {
            for (int x = 0; x < 3; x++)
                v[i][x] = 2 * random_unit() - 1 + (x == 0 ? away : 0);
            vector[i] = v[i];
        }
        tm_shortest_vector(vector, count, p);
        /* No point of the boundary is nearer, and some are as near. */
        for (size_t i = 0; i < count; i++)
            assert_true(tm_dot(p, v[i]) >= tm_norm2(p) - exact);
        assert_true(fabs(tm_norm(p) - slow_shortest(vector, count)) < close);
    }
}

/* An octahedron with radius 1. */
static const double corner[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                    {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
static const uint32_t face[8][3] = {{0, 4, 2}, {2, 4, 1}, {1, 4, 3}, {3, 4, 0},
                                    {2, 5, 0}, {1, 5, 2}, {3, 5, 1}, {0, 5, 3}};
static const tm_cavity_boundary octahedron = {corner, face, 8};

/* The best place is the centre, in all that the point is free to follow. */
static void test_climb(void **state)
{
    (void)state;
    enum { STEPS = 40 };
    for (int k = 0; k < 2000; k++) {
        tm_freedom freedom = {.dimension = 1 + (int)random_below(3),
                              .direction = {0, 0.6, 0.8}};
        tm_tet_measure measure =
            random_below(4) ? TM_MEASURE_DIHEDRAL : TM_MEASURE_VOLUME;
        double p[3], from[3], moved[3];
        for (int x = 0; x < 3; x++)
            p[x] = random_unit() - 0.5;
        double plane = tm_dot(p, freedom.direction);
        memcpy(from, p, sizeof p);
        double before = tm_cavity_boundary_quality(&octahedron, measure, p, 0);
        tm_cavity_boundary_climb(&octahedron, measure, &freedom, HUGE_VAL, STEPS, p);
        double after = tm_cavity_boundary_quality(&octahedron, measure, p, 0);
        assert_true(after >= before);
        tm_subtract(moved, p, from);
        double along = tm_dot(moved, freedom.direction);
        if (freedom.dimension == 3 && measure == TM_MEASURE_DIHEDRAL && before > 0)
            assert_true(after > 0.9 * tm_cavity_boundary_quality(
                                          &octahedron, measure, (double[3]){0, 0, 0}, 0));
        if (freedom.dimension == 2)
            assert_true(fabs(tm_dot(p, freedom.direction) - plane) < 1e-12);
        if (freedom.dimension == 1)
            assert_true(fabs(tm_norm2(moved) - along * along) < 1e-12);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes),
        cmocka_unit_test(test_slope_of_volume),
        cmocka_unit_test(test_degenerate_slopes),
        cmocka_unit_test(test_shortest_vector),
        cmocka_unit_test(test_climb),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
