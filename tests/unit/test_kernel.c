/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest ball between planes: known ones, and random planes against all sets of
 * four; at any size and place, with planes twice and coplanar ones, and none at all. */
#include "../../lib/geom/vector.h"
#include "../../lib/geom/kernel.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST = 256 };

static double between(double lo, double hi)
{
    return lo + (hi - lo) * random_unit();
}

static void random_direction(double n[3])
{
    double length2;
    do {
        for (int k = 0; k < 3; k++)
            n[k] = between(-1, 1);
        length2 = tm_norm2(n);
    } while (length2 > 1 || length2 < 0.01);
    for (int k = 0; k < 3; k++)
        n[k] /= sqrt(length2);
}

static void plane_through(double plane[4], const double a[3], const double b[3],
                          const double c[3])
{
    tm_triangle_normal(plane, a, b, c);
    const double length = tm_norm(plane);
    for (int k = 0; k < 3; k++)
        plane[k] /= length;
    plane[3] = tm_dot(plane, a);
}

/* Moves what was made around the origin, size 1, to elsewhere. */
static void move(double (*plane)[4], size_t count, double size, const double to[3])
{
    for (size_t i = 0; i < count; i++)
        plane[i][3] = size * plane[i][3] + tm_dot(plane[i], to);
}

static size_t box(double (*plane)[4], double a, double b, double c)
{
    const double half[3] = {a / 2, b / 2, c / 2};
    memset(plane, 0, 6 * sizeof *plane);
    for (size_t i = 0; i < 6; i++) {
        plane[i][i / 2] = i % 2 ? 1 : -1;
        plane[i][3] = half[i / 2];
    }
    return 6;
}

static void test_box(void **state)
{
    (void)state;
    double plane[MOST][4], center[3], radius;
    size_t count = box(plane, 2, 3, 4);
    assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
    assert_true(fabs(radius - 1) < 1e-14);
    assert_true(fabs(center[0]) < 1e-14);
    count = box(plane, 1, 1, 1);
    assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
    assert_true(fabs(radius - 0.5) < 1e-14);
    assert_true(tm_norm(center) < 1e-14);
}

/* The incentre is the mean of the corners, weighted by the opposite areas. */
static void test_tetrahedra(void **state)
{
    (void)state;
    enum { ROUNDS = 2000 };
    static const int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (int round = 0; round < ROUNDS; round++) {
        double x[4][3], plane[4][4], center[3], radius, in[3] = {0}, areas = 0;
        do
            for (int v = 0; v < 4; v++)
                for (int k = 0; k < 3; k++)
                    x[v][k] = between(-1, 1);
        while (tm_tet_volume(x[0], x[1], x[2], x[3]) < 1e-3);
        for (int f = 0; f < 4; f++) {
            const double *a = x[face[f][0]], *b = x[face[f][1]], *c = x[face[f][2]];
            const double area = tm_triangle_area(a, b, c);
            plane_through(plane[f], a, b, c);
            areas += area;
            for (int k = 0; k < 3; k++)
                in[k] += area * x[f][k];
        }
        for (int k = 0; k < 3; k++)
            in[k] /= areas;
        const double size = ldexp(1, (int)random_below(40) - 20);
        const double to[3] = {between(-9, 9) * size, between(-9, 9) * size, 5 * size};
        move(plane, 4, size, to);
        assert_true(tm_kernel_ball((const double(*)[4])plane, 4, center, &radius));
        const double right = 3 * tm_tet_volume(x[0], x[1], x[2], x[3]) / areas;
        assert_true(fabs(radius / size - right) < 1e-11);
        for (int k = 0; k < 3; k++)
            assert_true(fabs((center[k] - to[k]) / size - in[k]) < 1e-10);
    }
}

static double determinant(const double *a, const double *b, const double *c)
{
    double bc[3];
    tm_cross(bc, b, c);
    return tm_dot(a, bc);
}

/* The ball that four planes touch, by Cramer's rule; false where there is none. */
static bool touching(const double (*plane)[4], const size_t at[4], double x[3], double *r)
{
    double row[3][3], right[3], column[3][3], x0[3];
    const double *first = plane[at[0]];
    for (int i = 0; i < 3; i++) {
        tm_subtract(row[i], plane[at[i + 1]], first);
        right[i] = plane[at[i + 1]][3] - first[3];
    }
    const double whole = determinant(row[0], row[1], row[2]);
    if (fabs(whole) < 1e-9)
        return false;
    for (int k = 0; k < 3; k++) {
        memcpy(column, row, sizeof row);
        for (int i = 0; i < 3; i++)
            column[i][k] = right[i];
        x0[k] = determinant(column[0], column[1], column[2]) / whole;
    }
    memcpy(x, x0, sizeof x0);
    *r = first[3] - tm_dot(first, x);
    return true;
}

/* The largest ball is one of those that four planes touch and none cuts. */
/* How deep a point is inside all half-spaces. */
static double depth_of(const double (*plane)[4], size_t count, const double x[3])
{
    double depth = HUGE_VAL;
    for (size_t i = 0; i < count; i++)
        depth = fmin(depth, plane[i][3] - tm_dot(plane[i], x));
    return depth;
}

static double brute_force(const double (*plane)[4], size_t count)
{
    double best = -HUGE_VAL, x[3], r;
    size_t at[4];
    for (at[0] = 0; at[0] < count; at[0]++)
        for (at[1] = at[0] + 1; at[1] < count; at[1]++)
            for (at[2] = at[1] + 1; at[2] < count; at[2]++)
                for (at[3] = at[2] + 1; at[3] < count; at[3]++)
                    if (touching(plane, at, x, &r) && r > best &&
                        depth_of(plane, count, x) > r - 1e-9)
                        best = r;
    return best;
}

/* Random planes around the origin in a box; with `least` below 0 it may be outside. */
static size_t random_planes(double (*plane)[4], size_t count, double least)
{
    box(plane, 4, 4, 4);
    for (size_t i = 6; i < count; i++) {
        random_direction(plane[i]);
        plane[i][3] = between(least, 1);
    }
    return count;
}

static void test_against_brute_force(void **state)
{
    (void)state;
    enum { ROUNDS = 1500, FEW = 12 };
    int empty = 0;
    for (int round = 0; round < ROUNDS; round++) {
        double plane[MOST][4], center[3], radius;
        const size_t count = random_planes(plane, 6 + random_below(FEW), -0.5);
        const double right = brute_force((const double(*)[4])plane, count);
        const double size = ldexp(1, (int)random_below(40) - 20);
        const double to[3] = {between(-9, 9) * size, between(-9, 9) * size, 5 * size};
        move(plane, count, size, to);
        assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
        assert_true(fabs(radius / size - right) < 1e-8);
        assert_true(radius == depth_of((const double(*)[4])plane, count, center));
        empty += right < 0;
    }
    assert_true(empty > 10 && empty < ROUNDS - 10);
}

/* Planes again, a little turned or moved by rounding, in another order: the same ball. */
static void test_repeated_planes(void **state)
{
    (void)state;
    enum { ROUNDS = 1000, PLANES = 60 };
    for (int round = 0; round < ROUNDS; round++) {
        double plane[MOST][4], center[3], radius, again;
        const double noise = random_below(2) ? 1e-15 : 0;
        const size_t count = random_planes(plane, PLANES, 0.1);
        assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
        for (size_t i = count; i < 3 * count; i++)
            for (int k = 0; k < 4; k++)
                plane[i][k] = plane[i % count][k] + noise * between(-1, 1);
        for (size_t i = 3 * count; i-- > 1;) {
            const size_t j = random_below((unsigned)i + 1);
            double kept[4];
            memcpy(kept, plane[i], sizeof kept);
            memcpy(plane[i], plane[j], sizeof kept);
            memcpy(plane[j], kept, sizeof kept);
        }
        assert_true(tm_kernel_ball((const double(*)[4])plane, 3 * count, center, &again));
        assert_true(fabs(again - radius) < 1e-12);
    }
}

/* A cube's faces, each as many triangles of it: their planes differ by rounding. */
static void test_coplanar(void **state)
{
    (void)state;
    enum { ROUNDS = 200, TRIANGLES = 20 };
    for (int round = 0; round < ROUNDS; round++) {
        double plane[MOST][4], center[3], radius;
        const double far = round % 2 ? 1000 : 0;
        size_t count = 0;
        for (int side = 0; side < 6; side++)
            for (int t = 0; t < TRIANGLES; t++) {
                double x[3][3], middle[3] = {0};
                for (int v = 0; v < 3; v++)
                    for (int k = 0; k < 3; k++) {
                        x[v][k] = far + (k == side / 2 ? side % 2 : random_unit());
                        middle[k] += x[v][k] / 3;
                    }
                plane_through(plane[count], x[0], x[1], x[2]);
                const double inside[3] = {far + 0.5, far + 0.5, far + 0.5};
                if (tm_dot(plane[count], inside) > plane[count][3])
                    plane_through(plane[count], x[0], x[2], x[1]);
                count += tm_triangle_area(x[0], x[1], x[2]) > 0.01;
            }
        assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
        assert_true(fabs(radius - 0.5) < 1e-10);
    }
}

static void test_empty(void **state)
{
    (void)state;
    double plane[MOST][4], center[3], radius;
    /* Two half-spaces that are apart by 1, in a box. */
    size_t count = box(plane, 8, 8, 8);
    memcpy(plane[count++], (double[4]){1, 0, 0, -0.5}, sizeof *plane);
    memcpy(plane[count++], (double[4]){-1, 0, 0, -0.5}, sizeof *plane);
    assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
    assert_true(fabs(radius + 0.5) < 1e-14);
    /* Touching: no interior. */
    plane[count - 1][3] = 0.5;
    assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
    assert_true(fabs(radius) < 1e-14);
}

static void test_unbounded(void **state)
{
    (void)state;
    double plane[MOST][4], center[3], radius = 1;
    box(plane, 2, 2, 2);
    for (size_t count = 0; count < 6; count++) {
        assert_false(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
        assert_true(radius == 0);
    }
    plane[5][3] = NAN;
    assert_false(tm_kernel_ball((const double(*)[4])plane, 6, center, &radius));
    plane[5][3] = HUGE_VAL;
    assert_false(tm_kernel_ball((const double(*)[4])plane, 6, center, &radius));
}

/* Boxes 1 by 1 by down to 1e-9: the ball is as small as that. */
static void test_flat(void **state)
{
    (void)state;
    for (int digits = 0; digits < 10; digits++) {
        double plane[MOST][4], center[3], radius;
        const double height = pow(10, -digits);
        const size_t count = box(plane, 1, 1, height);
        assert_true(tm_kernel_ball((const double(*)[4])plane, count, center, &radius));
        assert_true(fabs(radius - height / 2) < 1e-15);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_tetrahedra),
        cmocka_unit_test(test_against_brute_force),
        cmocka_unit_test(test_repeated_planes),
        cmocka_unit_test(test_coplanar),
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_unbounded),
        cmocka_unit_test(test_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
