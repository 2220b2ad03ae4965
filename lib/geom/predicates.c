/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "predicates.h"

#include <gmp.h>
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

/* A point seen from the one that is tested, with its squared distance. */
typedef struct lifted {
    double x, y, z;
    double square;
} lifted;

static inline lifted lift(const double point[3], const double origin[3])
{
    const double x = point[0] - origin[0];
    const double y = point[1] - origin[1];
    const double z = point[2] - origin[2];
    return (lifted){x, y, z, x * x + y * y + z * z};
}

/* A 2×2 determinant of x and y, and the sum of its products' absolute values. */
typedef struct minor {
    double value;
    double permanent;
} minor;

static inline minor minor2(lifted p, lifted q)
{
    const double left = p.x * q.y;
    const double right = q.x * p.y;
    return (minor){left - right, fabs(left) + fabs(right)};
}

/* det(p, q, r), expanded by z, from the minors qr, rp, pq. */
static inline minor minor3(lifted p, lifted q, lifted r, minor qr, minor rp, minor pq)
{
    return (minor){p.z * qr.value + q.z * rp.value + r.z * pq.value,
                   fabs(p.z) * qr.permanent + fabs(q.z) * rp.permanent +
                       fabs(r.z) * pq.permanent};
}

static inline minor negative(minor m)
{
    return (minor){-m.value, m.permanent};
}

/* Error: Shewchuk's (16 + 224ε)ε times the permanent (his isperrboundA). Underflow: let
 * no difference be larger than m. Then a square loses 3u, a 3×3 minor (at most 6m³)
 * 6um + 3u, so that the four products square · minor lose 4 (18um³ + 3m²(6um + 3u) + u),
 * which is below 200u (1 + m³) ≤ 400u (1 + s)² with s the sum of the squares. */
int tm_insphere(const double a[3], const double b[3], const double c[3],
                const double d[3], const double e[3])
{
    const double relative_error = (16 + 224 * TM_HALF_ULP) * TM_HALF_ULP;
    const lifted pa = lift(a, e);
    const lifted pb = lift(b, e);
    const lifted pc = lift(c, e);
    const lifted pd = lift(d, e);

    const minor ab = minor2(pa, pb);
    const minor bc = minor2(pb, pc);
    const minor cd = minor2(pc, pd);
    const minor da = minor2(pd, pa);
    const minor ac = minor2(pa, pc);
    const minor bd = minor2(pb, pd);

    const minor abc = minor3(pa, pb, pc, bc, negative(ac), ab);
    const minor bcd = minor3(pb, pc, pd, cd, negative(bd), bc);
    const minor cda = minor3(pc, pd, pa, da, ac, cd);
    const minor dab = minor3(pd, pa, pb, ab, bd, da);

    const double determinant = (pa.square * bcd.value - pb.square * cda.value) +
                               (pc.square * dab.value - pd.square * abc.value);
    const double permanent = pa.square * bcd.permanent + pb.square * cda.permanent +
                             pc.square * dab.permanent + pd.square * abc.permanent;
    const double squares = 1 + pa.square + pb.square + pc.square + pd.square;
    const double bound = relative_error * permanent + TM_UNDERFLOW * squares * squares;
    if (determinant > bound)
        return 1;
    if (determinant < -bound)
        return -1;
    return tm_insphere_exact(a, b, c, d, e);
}

/* The determinants of predicates.h in integers. Every finite double is an integer times
 * a power of two; with one power for all coordinates the determinants have the sign of
 * the same determinants of those integers, of at most some 2100 bits. */

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
    mpz_t cofactor;
    mpz_init(cofactor);
    mpz_set_ui(out, 0);
    for (size_t i = 0; i < DIMENSIONS; i++) {
        const size_t j = (i + 1) % DIMENSIONS;
        const size_t k = (i + 2) % DIMENSIONS;
        mpz_mul(cofactor, q[j], r[k]);
        mpz_submul(cofactor, q[k], r[j]);
        mpz_addmul(out, p[i], cofactor);
    }
    mpz_clear(cofactor);
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
    /* det of the rows (x, y, z, x² + y² + z²) expanded by the last column: the cofactor
     * of row v has the other three rows in this order, which makes it count as +. */
    static const size_t others[CORNERS][DIMENSIONS] = {
        {1, 2, 3}, {0, 3, 2}, {3, 0, 1}, {0, 2, 1}};
    const double *const point[MAX_POINTS] = {a, b, c, d, e};
    mpz_t edge[CORNERS][DIMENSIONS];
    differences(edge, point, CORNERS, e, common_exponent(point, MAX_POINTS));
    mpz_t determinant, cofactor, square;
    mpz_inits(determinant, cofactor, square, NULL);
    for (size_t v = 0; v < CORNERS; v++) {
        const size_t *other = others[v];
        determinant3(cofactor, edge[other[0]], edge[other[1]], edge[other[2]]);
        square_length(square, edge[v]);
        mpz_addmul(determinant, cofactor, square);
    }
    const int sign = mpz_sgn(determinant);
    mpz_clears(determinant, cofactor, square, NULL);
    clear_differences(edge, CORNERS);
    return sign;
}
