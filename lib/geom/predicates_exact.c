/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The determinants of predicates.h in integers. Every finite double is an integer times
 * a power of two; with one power for all coordinates the determinants have the sign of
 * the same determinants of those integers, of at most some 2100 bits. */
#include "predicates.h"

#include <gmp.h>
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

enum { DIMENSIONS = 3, MANTISSA_BITS = 53, MAX_POINTS = 5 };

/* The largest power of two that divides every coordinate into integers of at least 53
 * bits; 0 where all coordinates are 0. */
static int common_exponent(const double *const *point, size_t points)
{
    int least = INT_MAX;
    for (size_t v = 0; v < points; v++) {
        for (size_t i = 0; i < DIMENSIONS; i++) {
            int exponent;
            if (frexp(point[v][i], &exponent) != 0 && exponent < least)
                least = exponent;
        }
    }
    return least == INT_MAX ? 0 : least - MANTISSA_BITS;
}

/* integer = value / 2^unit, where unit is at most the exponent of value's last bit. */
static void set_scaled(mpz_t integer, double value, int unit)
{
    int exponent;
    const double fraction = frexp(value, &exponent);
    mpz_set_d(integer, ldexp(fraction, MANTISSA_BITS));
    if (fraction != 0)
        mpz_mul_2exp(integer, integer, (mp_bitcnt_t)(exponent - MANTISSA_BITS - unit));
}

/* Differences of point[0 … count) to origin, scaled to integers; initialises them. */
static void differences(mpz_t difference[][DIMENSIONS], const double *const *point,
                        size_t count, const double origin[DIMENSIONS], int unit)
{
    mpz_t base;
    mpz_init(base);
    for (size_t i = 0; i < DIMENSIONS; i++) {
        set_scaled(base, origin[i], unit);
        for (size_t v = 0; v < count; v++) {
            mpz_init(difference[v][i]);
            set_scaled(difference[v][i], point[v][i], unit);
            mpz_sub(difference[v][i], difference[v][i], base);
        }
    }
    mpz_clear(base);
}

static void clear_differences(mpz_t difference[][DIMENSIONS], size_t count)
{
    for (size_t v = 0; v < count; v++) {
        for (size_t i = 0; i < DIMENSIONS; i++)
            mpz_clear(difference[v][i]);
    }
}

/* out = det(p, q, r), initialised by the caller. */
static void determinant3(mpz_t out, mpz_t p[DIMENSIONS], mpz_t q[DIMENSIONS],
                         mpz_t r[DIMENSIONS])
{
    mpz_t minor;
    mpz_init(minor);
    mpz_set_ui(out, 0);
    for (size_t i = 0; i < DIMENSIONS; i++) {
        const size_t j = (i + 1) % DIMENSIONS;
        const size_t k = (i + 2) % DIMENSIONS;
        mpz_mul(minor, q[j], r[k]);
        mpz_submul(minor, q[k], r[j]);
        mpz_addmul(out, p[i], minor);
    }
    mpz_clear(minor);
}

static void square_length(mpz_t out, mpz_t p[DIMENSIONS])
{
    mpz_mul(out, p[0], p[0]);
    for (size_t i = 1; i < DIMENSIONS; i++)
        mpz_addmul(out, p[i], p[i]);
}

/* Whether all points have one x, one y or one z: then they are coplanar. In made meshes
 * this is by far the most frequent case that rounding cannot decide. */
static bool on_axis_plane(const double *const *point, size_t points)
{
    for (size_t i = 0; i < DIMENSIONS; i++) {
        size_t same = 1;
        while (same < points && point[same][i] == point[0][i])
            same++;
        if (same == points)
            return true;
    }
    return false;
}

int tm_orient3d_exact(const double a[3], const double b[3], const double c[3],
                      const double d[3])
{
    enum { POINTS = 4, EDGES = 3 };
    const double *const point[POINTS] = {b, c, d, a};
    if (on_axis_plane(point, POINTS))
        return 0;
    mpz_t edge[EDGES][DIMENSIONS];
    differences(edge, point, EDGES, a, common_exponent(point, POINTS));
    mpz_t determinant;
    mpz_init(determinant);
    determinant3(determinant, edge[0], edge[1], edge[2]);
    const int sign = mpz_sgn(determinant);
    mpz_clear(determinant);
    clear_differences(edge, EDGES);
    return sign;
}

int tm_insphere_exact(const double a[3], const double b[3], const double c[3],
                      const double d[3], const double e[3])
{
    enum { CORNERS = MAX_POINTS - 1 };
    /* det of the rows (x, y, z, x² + y² + z²) expanded by the last column: the minor of
     * row v has the other three rows in this order, which makes it count as +. */
    static const size_t others[CORNERS][DIMENSIONS] = {
        {1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {0, 2, 1}};
    const double *const point[MAX_POINTS] = {a, b, c, d, e};
    mpz_t edge[CORNERS][DIMENSIONS];
    differences(edge, point, CORNERS, e, common_exponent(point, MAX_POINTS));
    mpz_t determinant, minor, square;
    mpz_inits(determinant, minor, square, NULL);
    for (size_t v = 0; v < CORNERS; v++) {
        const size_t *other = others[v];
        determinant3(minor, edge[other[0]], edge[other[1]], edge[other[2]]);
        square_length(square, edge[v]);
        mpz_addmul(determinant, minor, square);
    }
    const int sign = mpz_sgn(determinant);
    mpz_clears(determinant, minor, square, NULL);
    clear_differences(edge, CORNERS);
    return sign;
}
