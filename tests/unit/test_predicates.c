/* SPDX-License-Identifier: GPL-3.0-or-later */
/* orient3d and insphere against Gaussian elimination in rational numbers. */
#include "../../lib/geom/predicates.h"
#include "random.h"

#include <gmp.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { DIMENSIONS = 3, TETRAHEDRON = 4, SPHERE = 5 };

/* The sign of the determinant of the count × count matrix; destroys it. */
static int rational_sign(mpq_t matrix[SPHERE][SPHERE], size_t count)
{
    int sign = 1;
    mpq_t factor, product;
    mpq_inits(factor, product, NULL);
    for (size_t k = 0; k < count && sign != 0; k++) {
        size_t pivot = k;
        while (pivot < count && mpq_sgn(matrix[pivot][k]) == 0)
            pivot++;
        if (pivot == count) {
            sign = 0;
            break;
        }
        if (pivot != k) {
            sign = -sign;
            for (size_t j = 0; j < count; j++)
                mpq_swap(matrix[k][j], matrix[pivot][j]);
        }
        sign *= mpq_sgn(matrix[k][k]);
        for (size_t i = k + 1; i < count; i++) {
            mpq_div(factor, matrix[i][k], matrix[k][k]);
            for (size_t j = k; j < count; j++) {
                mpq_mul(product, factor, matrix[k][j]);
                mpq_sub(matrix[i][j], matrix[i][j], product);
            }
        }
    }
    mpq_clears(factor, product, NULL);
    return sign;
}

/* Rows (x, y, z, 1) for four points, (x, y, z, x² + y² + z², 1) for five. */
static int oracle(const double point[][DIMENSIONS], size_t count)
{
    mpq_t matrix[SPHERE][SPHERE];
    mpq_t square;
    mpq_init(square);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < count; j++)
            mpq_init(matrix[i][j]);
        for (size_t j = 0; j < DIMENSIONS; j++) {
            mpq_set_d(matrix[i][j], point[i][j]);
            if (count == SPHERE) {
                mpq_mul(square, matrix[i][j], matrix[i][j]);
                mpq_add(matrix[i][DIMENSIONS], matrix[i][DIMENSIONS], square);
            }
        }
        mpq_set_ui(matrix[i][count - 1], 1, 1);
    }
    const int sign = -rational_sign(matrix, count);
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < count; j++)
            mpq_clear(matrix[i][j]);
    }
    mpq_clear(square);
    return sign;
}

static int orientation(const double p[TETRAHEDRON][DIMENSIONS])
{
    return tm_orient3d(p[0], p[1], p[2], p[3]);
}

static int sphere(const double p[SPHERE][DIMENSIONS])
{
    return tm_insphere(p[0], p[1], p[2], p[3], p[4]);
}

/* Both predicates on five points, with and without the rounded shortcut; says how many
 * of the signs were 0. */
static unsigned check_points(const double p[SPHERE][DIMENSIONS])
{
    const int orient = oracle(p, TETRAHEDRON);
    assert_int_equal(orientation(p), orient);
    assert_int_equal(tm_orient3d_exact(p[0], p[1], p[2], p[3]), orient);
    const int inside = oracle(p, SPHERE);
    assert_int_equal(sphere(p), inside);
    assert_int_equal(tm_insphere_exact(p[0], p[1], p[2], p[3], p[4]), inside);
    return (unsigned)(orient == 0) + (unsigned)(inside == 0);
}

/* Calls check for every order of point[0 … count), with the sign of that order. */
static void permute(double point[][DIMENSIONS], size_t count, size_t first, int sign,
                    int (*predicate)(const double[][DIMENSIONS]), int expected)
{
    if (first == count) {
        assert_int_equal(predicate(point), sign * expected);
        return;
    }
    for (size_t i = first; i < count; i++) {
        double kept[DIMENSIONS];
        memcpy(kept, point[i], sizeof kept);
        memcpy(point[i], point[first], sizeof kept);
        memcpy(point[first], kept, sizeof kept);
        permute(point, count, first + 1, i == first ? sign : -sign, predicate, expected);
        memcpy(point[first], point[i], sizeof kept);
        memcpy(point[i], kept, sizeof kept);
    }
}

static void check_antisymmetry(const double p[SPHERE][DIMENSIONS])
{
    double point[SPHERE][DIMENSIONS];
    memcpy(point, p, sizeof point);
    permute(point, TETRAHEDRON, 0, 1, orientation, orientation(p));
    permute(point, SPHERE, 0, 1, sphere, sphere(p));
}

static double ulps_from(double value, int count)
{
    for (; count > 0; count--)
        value = nextafter(value, INFINITY);
    for (; count < 0; count++)
        value = nextafter(value, -INFINITY);
    return value;
}

static void test_known_signs(void **state)
{
    (void)state;
    const double p[SPHERE][DIMENSIONS] = {
        {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0.5}};
    assert_int_equal(orientation(p), 1);
    assert_int_equal(tm_orient3d(p[1], p[0], p[2], p[3]), -1);
    assert_int_equal(tm_orient3d(p[0], p[1], p[2], p[1]), 0);
    assert_int_equal(sphere(p), 1);
    assert_int_equal(tm_insphere(p[1], p[0], p[2], p[3], p[4]), -1);
    const double corner[DIMENSIONS] = {1, 1, 1};
    assert_int_equal(tm_insphere(p[0], p[1], p[2], p[3], corner), 0);
    const double outside[DIMENSIONS] = {1, 1, ulps_from(1, 1)};
    assert_int_equal(tm_insphere(p[0], p[1], p[2], p[3], outside), -1);
    const double inside[DIMENSIONS] = {1, 1, ulps_from(1, -1)};
    assert_int_equal(tm_insphere(p[0], p[1], p[2], p[3], inside), 1);
    const double far[DIMENSIONS] = {9, 9, 9};
    assert_int_equal(tm_insphere(p[0], p[1], p[2], p[3], far), -1);
}

/* Points of scale · (offset + random in the unit cube). */
static void random_points(double p[SPHERE][DIMENSIONS], double scale, double offset)
{
    for (size_t v = 0; v < SPHERE; v++) {
        for (size_t i = 0; i < DIMENSIONS; i++)
            p[v][i] = scale * (offset + random_unit());
    }
}

static void test_random_points(void **state)
{
    (void)state;
    static const double scales[] = {1,      1e-3,   1e15,   1e-60,  1e-100,
                                    1e-107, 1e-160, 1e-300, 1e-310, 1e-320,
                                    1e60,   1e150,  1e200,  1e300,  1e307};
    static const double offsets[] = {0, -0.5, 1e3, 1e8, 1e15};
    double p[SPHERE][DIMENSIONS];
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
        for (size_t o = 0; o < sizeof offsets / sizeof *offsets; o++) {
            if (scales[s] * offsets[o] > 1e307)
                continue;
            for (int i = 0; i < 40; i++) {
                random_points(p, scales[s], offsets[o]);
                check_points(p);
            }
            check_antisymmetry(p);
        }
    }
}

/* Few different coordinates make most of the signs 0: planes and spheres of a grid. */
static void check_grid(double step, double offset, unsigned size)
{
    double p[SPHERE][DIMENSIONS];
    unsigned zeros = 0;
    for (int n = 0; n < 400; n++) {
        for (size_t v = 0; v < SPHERE; v++) {
            for (size_t i = 0; i < DIMENSIONS; i++)
                p[v][i] = offset + step * random_below(size);
        }
        zeros += check_points(p);
    }
    assert_true(zeros > 0);
    check_antisymmetry(p);
}

static void test_grids(void **state)
{
    (void)state;
    check_grid(1, 0, 2);
    check_grid(1, -1, 4);
    check_grid(0.1, 0, 4);
    check_grid(0.1, 0.7, 3);
    check_grid(1, 1e15, 4);
    check_grid(0x1p-52, 1, 4);
    check_grid(0x1p-1074, 0, 4);
    check_grid(0x1p-1074, 1e-300, 3);
    check_grid(0x1p-400, 0, 3);
    check_grid(0x1p1020, 0, 3);
    check_grid(0x1p971, 0x1p1023, 3);
}

/* Corners of a cuboid lie on a sphere exactly where its sides are computed exactly; one
 * ulp more or less shows. */
static void test_cuboid_corners(void **state)
{
    (void)state;
    double p[SPHERE][DIMENSIONS];
    for (int n = 0; n < 300; n++) {
        double side[DIMENSIONS];
        const double scale = ldexp(1, (int)random_below(1900) - 1000);
        for (size_t i = 0; i < DIMENSIONS; i++)
            side[i] = scale * (1 + random_below(1000));
        for (size_t v = 0; v < SPHERE; v++) {
            const unsigned corner = random_below(8);
            for (size_t i = 0; i < DIMENSIONS; i++)
                p[v][i] = corner >> i & 1 ? side[i] : -side[i];
        }
        assert_int_equal(sphere(p), 0);
        check_points(p);
        double *moved = &p[random_below(SPHERE)][random_below(DIMENSIONS)];
        *moved = ulps_from(*moved, random_below(2) == 0 ? 1 : -1);
        check_points(p);
    }
    check_antisymmetry(p);
}

/* Shewchuk's figure of the plane predicate, in space: points on a plane or a line
 * through the origin's diagonal, each coordinate a few ulps away. */
static void test_ulps_from_a_plane(void **state)
{
    (void)state;
    double p[SPHERE][DIMENSIONS];
    for (int n = 0; n < 2000; n++) {
        for (size_t v = 0; v < SPHERE; v++) {
            const double x = v == 0 ? 0.5 : 6.0 * (double)v;
            const double y = n % 2 == 0 ? x : random_unit();
            const double planar[DIMENSIONS] = {x, y, n % 4 < 2 ? (x + y) / 2 : x};
            for (size_t i = 0; i < DIMENSIONS; i++)
                p[v][i] = ulps_from(planar[i], (int)random_below(5) - 2);
        }
        check_points(p);
    }
    check_antisymmetry(p);
}

/* Every bit pattern that is finite: exponents from subnormal to the largest. */
static void test_random_bits(void **state)
{
    (void)state;
    double p[SPHERE][DIMENSIONS];
    for (int n = 0; n < 300; n++) {
        for (size_t v = 0; v < SPHERE; v++) {
            for (size_t i = 0; i < DIMENSIONS; i++) {
                uint64_t bits;
                do {
                    bits = random_bits();
                    memcpy(&p[v][i], &bits, sizeof bits);
                } while (!isfinite(p[v][i]));
            }
        }
        check_points(p);
    }
    check_antisymmetry(p);
}

/* Coordinates whose products underflow beside ones that do not: the relative error bound
 * alone would take these rounded determinants for right. */
static void test_underflow(void **state)
{
    (void)state;
    double p[SPHERE][DIMENSIONS];
    for (int n = 0; n < 1500; n++) {
        for (size_t v = 0; v < SPHERE; v++) {
            for (size_t i = 0; i < DIMENSIONS; i++) {
                const int exponent = (int)(i * 200 + random_below(160)) - 700;
                const double value = ldexp((double)random_below(8), exponent);
                p[v][i] = random_below(3) == 0 ? 0 : value;
            }
        }
        check_points(p);
    }
    /* Determinants of some 2^-1074: orient3d has degree 3, insphere 5. */
    for (int n = 0; n < 1000; n++) {
        random_points(p, ldexp(1, (n % 2 == 0 ? -357 : -214) + (int)random_below(6)), 0);
        check_points(p);
    }
    /* bx·cy·dz - cx·by·dz is (1.25 - 1.375)·2^-574, but in products rounded to 2^-1074
     * it is (2 - 1)·2^-574. */
    const double a[DIMENSIONS] = {0, 0, 0};
    const double b[DIMENSIONS] = {0x1p501, 1.375 * 0x1p-537, 0};
    const double c[DIMENSIONS] = {0x1p500, 0.625 * 0x1p-537, 0};
    const double d[DIMENSIONS] = {0, 0, 0x1p-537};
    assert_int_equal(tm_orient3d(a, b, c, d), -1);
    assert_int_equal(tm_orient3d(a, c, b, d), 1);
}

/* Coordinates that are nearly all as large as they can be in 54 to 70 bits: there the
 * numbers of the processor end, and arrays of them begin. */
static void test_ranges(void **state)
{
    (void)state;
    double p[SPHERE][DIMENSIONS];
    for (int n = 0; n < 4000; n++) {
        const int more = 1 + n % 17;
        for (size_t v = 0; v < SPHERE; v++)
            for (size_t i = 0; i < DIMENSIONS; i++) {
                const double large = 0x1p53 - 1 - random_below(3);
                const double sign = random_below(2) == 0 ? 1 : -1;
                p[v][i] = ldexp(sign * large, random_below(8) == 0 ? 0 : more);
            }
        check_points(p);
    }
    check_antisymmetry(p);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_known_signs),
        cmocka_unit_test(test_random_points),
        cmocka_unit_test(test_grids),
        cmocka_unit_test(test_cuboid_corners),
        cmocka_unit_test(test_ulps_from_a_plane),
        cmocka_unit_test(test_random_bits),
        cmocka_unit_test(test_underflow),
        cmocka_unit_test(test_ranges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
