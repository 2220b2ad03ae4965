/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Barycentric coordinates: they make the point again, of tetrahedra of any height, down
 * to those that are flat to rounding, at any size and place. */
#include "../../lib/geom/barycentric.h"
#include "../../lib/geom/vector.h"
#include "random.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { TRIES = 20000 };

typedef struct {
    double x[4][3], size, far;
} tetrahedron;

static const double *const *corners_of(const tetrahedron *t, const double *corner[4])
{
    for (int i = 0; i < 4; i++)
        corner[i] = t->x[i];
    return corner;
}

/* Corner i is moved towards the point that the others make with random weights, until
 * `height` of the way is left. */
static void flatten(tetrahedron *t, int i, int others, double height)
{
    double to[3] = {0}, sum = 0;
    for (int k = 1; k <= others; k++) {
        const double w = random_unit() - 0.2;
        sum += w;
        for (int x = 0; x < 3; x++)
            to[x] += w * t->x[(i + k) % 4][x];
    }
    for (int x = 0; x < 3 && fabs(sum) > 0.1; x++)
        t->x[i][x] = to[x] / sum + height * (t->x[i][x] - to[x] / sum);
}

static tetrahedron random_tetrahedron(void)
{
    static const double heights[] = {1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1e-16, 0};
    tetrahedron t = {.size = pow(10, (double)random_below(60) - 30)};
    t.far = random_below(2) ? pow(10, random_below(7)) : 0;
    const int first = (int)random_below(4);
    for (int i = 0; i < 4; i++)
        for (int x = 0; x < 3; x++)
            t.x[i][x] = random_unit();
    if (random_below(3) == 0) /* a needle, too */
        flatten(&t, (first + 1) % 4, 2, heights[random_below(8)]);
    flatten(&t, first, 3, heights[random_below(8)]);
    for (int i = 0; i < 4; i++)
        for (int x = 0; x < 3; x++)
            t.x[i][x] = (t.x[i][x] + t.far) * t.size;
    return t;
}

/* With how many times the rounding of its coordinates p is missed. */
static double miss(const tetrahedron *t, const double p[3], const double weight[4])
{
    double off[3] = {-p[0], -p[1], -p[2]};
    for (int i = 0; i < 4; i++)
        for (int x = 0; x < 3; x++)
            off[x] += weight[i] * t->x[i][x];
    return tm_norm(off) / (DBL_EPSILON * t->size * (1 + t->far));
}

static void test_the_point_is_made(void **state)
{
    (void)state;
    double worst = 0;
    for (int k = 0; k < TRIES; k++) {
        const tetrahedron t = random_tetrahedron();
        const double *corner[4];
        double given[4], sum = 0, p[3] = {0}, weight[4], total = 0;
        for (int i = 0; i < 4; i++)
            sum += given[i] = 0.01 + random_unit();
        for (int i = 0; i < 4; i++)
            for (int x = 0; x < 3; x++)
                p[x] += given[i] / sum * t.x[i][x];
        const double depth = tm_barycentric(corners_of(&t, corner), p, weight);
        for (int i = 0; i < 4; i++) {
            assert_true(fabs(weight[i]) < 4); /* the extrapolation is small */
            total += weight[i];
        }
        assert_true(fabs(total - 1) < 1e-14);
        assert_true(depth <= 1);
        worst = fmax(worst, miss(&t, p, weight));
    }
    if (!(worst < 64))
        fail_msg("missed by %g roundings", worst);
}

/* Those of a tetrahedron that is not thin are the ones that made the point. */
static void test_the_weights_are_right(void **state)
{
    (void)state;
    const double x[4][3] = {{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {1, 1, 2}};
    const double *corner[4] = {x[0], x[1], x[2], x[3]};
    for (int k = 0; k < TRIES; k++) {
        double given[4] = {1}, p[3] = {0}, weight[4], least;
        for (int i = 1; i < 4; i++)
            given[0] -= given[i] = 3 * random_unit() - 1;
        least = fmin(fmin(given[0], given[1]), fmin(given[2], given[3]));
        for (int i = 0; i < 4; i++)
            for (int c = 0; c < 3; c++)
                p[c] += given[i] * x[i][c];
        assert_true(fabs(tm_barycentric(corner, p, weight) - least) < 1e-13);
        for (int i = 0; i < 4; i++)
            assert_true(fabs(weight[i] - given[i]) < 1e-13);
    }
}

/* What is flat takes the closest point, and is not deeper than that is far away. */
static void test_flat(void **state)
{
    (void)state;
    const double x[4][3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}};
    const double *square[4] = {x[0], x[1], x[2], x[3]},
                 *line[4] = {x[0], x[1], x[1], x[0]};
    const double *point[4] = {x[1], x[1], x[1], x[1]};
    const double above[3] = {1, 2, 2}, inside[3] = {1, 2, 0};
    double weight[4];
    assert_true(tm_barycentric(square, above, weight) <= -0.25);
    assert_true(fabs(4 * weight[1] + weight[3] - 1) < 1e-14);
    assert_true(fabs(4 * weight[2] + weight[3] - 2) < 1e-14);
    assert_true(tm_barycentric(square, inside, weight) == 0);
    assert_true(tm_barycentric(line, above, weight) < 0);
    assert_true(fabs(weight[1] + weight[2] - 0.25) < 1e-14);
    assert_true(tm_barycentric(point, above, weight) < 0);
    assert_true(weight[0] == 1 && weight[1] == 0);
    assert_true(tm_barycentric(point, x[1], weight) == 0);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_the_point_is_made),
                                       cmocka_unit_test(test_the_weights_are_right),
                                       cmocka_unit_test(test_flat)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
