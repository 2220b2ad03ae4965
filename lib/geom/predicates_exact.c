/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The determinants of predicates.h in integers. Every finite double is an integer times
 * a power of two; with one power for all coordinates the determinants have the sign of
 * the same determinants of those integers.
 *
 * In most meshes the differences of coordinates have at most 61 bits: then the
 * determinant is one of numbers of the processor. Else it is one of arrays of limbs, with
 * which GMP's functions for arrays calculate. Between the last bit of the smallest and
 * the first one of the largest double are 2098 bits, so that determinants of three
 * differences have at most 6 300 bits and the in-sphere determinant 10 510: the arrays
 * are on the stack, and nothing is allocated. */
#include "predicates.h"

#include <gmp.h>
#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { DIMENSIONS = 3, MAX_POINTS = 5, SMALL_BITS = 60 };
enum { LIMB_BITS = 64, LIMBS = 10510 / LIMB_BITS + 3 };

_Static_assert(GMP_NUMB_BITS == LIMB_BITS, "limbs of 64 bits");

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

typedef struct integer {
    int sign;
    mp_size_t size; /* limb[size - 1] is not 0; 0 where sign is */
    mp_limb_t limb[LIMBS];
} integer;

static void trim(integer *n)
{
    while (n->size > 0 && n->limb[n->size - 1] == 0)
        n->size--;
    if (n->size == 0)
        n->sign = 0;
}

/* value = ± mantissa · 2^exponent. */
typedef struct parts {
    uint64_t mantissa;
    int exponent;
    int sign;
} parts;

static inline parts take_apart(double value)
{
    enum { FRACTION_BITS = 52, EXPONENTS = 0x7ff, SMALLEST = -1074 };
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint64_t fraction = bits & (((uint64_t)1 << FRACTION_BITS) - 1);
    const int biased = (int)(bits >> FRACTION_BITS & EXPONENTS);
    const bool normal = biased > 0;
    const uint64_t mantissa = fraction | (uint64_t)normal << FRACTION_BITS;
    return (parts){mantissa, SMALLEST + biased - normal,
                   mantissa == 0             ? 0
                   : bits >> (LIMB_BITS - 1) ? -1
                                             : 1};
}

/* n = value / 2^unit, an integer. */
static void scale(integer *n, double value, int unit)
{
    parts of = take_apart(value);
    n->sign = of.sign;
    n->size = 0;
    if (of.sign == 0)
        return;
    const int zeros = __builtin_ctzll(of.mantissa);
    of.mantissa >>= zeros;
    const int shift = of.exponent + zeros - unit, bits = shift % LIMB_BITS;
    n->size = shift / LIMB_BITS;
    memset(n->limb, 0, (size_t)n->size * sizeof *n->limb);
    n->limb[n->size++] = of.mantissa << bits;
    n->limb[n->size++] = bits > 0 ? of.mantissa >> (LIMB_BITS - bits) : 0;
    trim(n);
}

static void set_zero(integer *n)
{
    n->sign = 0;
    n->size = 0;
}

static void copy(integer *to, const integer *from, int sign)
{
    to->sign = from->sign * sign;
    to->size = from->size;
    memcpy(to->limb, from->limb, (size_t)from->size * sizeof *from->limb);
}

static bool is_smaller(const integer *p, const integer *q)
{
    return p->size != q->size ? p->size < q->size
                              : mpn_cmp(p->limb, q->limb, p->size) < 0;
}

/* p += q * sign. */
static void add(integer *p, const integer *q, int sign)
{
    if (q->sign == 0)
        return;
    if (p->sign == 0) {
        copy(p, q, sign);
        return;
    }
    const int q_sign = q->sign * sign;
    const bool swap = is_smaller(p, q);
    const integer *large = swap ? q : p, *small = swap ? p : q;
    const mp_size_t size = large->size;
    if (p->sign == q_sign) {
        p->limb[size] = mpn_add(p->limb, large->limb, size, small->limb, small->size);
        p->size = size + 1;
    } else {
        mpn_sub(p->limb, large->limb, size, small->limb, small->size);
        p->size = size;
        p->sign = swap ? q_sign : p->sign;
    }
    trim(p);
}

/* product = p * q, which is another one. */
static void multiply(integer *product, const integer *p, const integer *q)
{
    product->sign = p->sign * q->sign;
    product->size = 0;
    if (product->sign == 0)
        return;
    const bool swap = p->size < q->size;
    const integer *large = swap ? q : p, *small = swap ? p : q;
    mpn_mul(product->limb, large->limb, large->size, small->limb, small->size);
    product->size = p->size + q->size;
    trim(product);
}

/* The largest power of two of which all coordinates are multiples, and how many bits they
 * have then. */
typedef struct range {
    int unit;
    int bits;
} range;

static range find_range(const double *const *point, size_t points)
{
    int least = INT_MAX, past = INT_MIN;
    for (size_t v = 0; v < points; v++)
        for (size_t i = 0; i < DIMENSIONS; i++) {
            const parts of = take_apart(point[v][i]);
            if (of.sign == 0)
                continue;
            const int last = of.exponent + __builtin_ctzll(of.mantissa);
            const int first = of.exponent + LIMB_BITS - __builtin_clzll(of.mantissa);
            least = last < least ? last : least;
            past = first > past ? first : past;
        }
    return least == INT_MAX ? (range){0, 0} : (range){least, past - least};
}

/* Small ones ------------------------------------------------------------------------ */

/* A determinant of three differences below 2^61: high·2^64 + low. */
typedef struct small {
    int128 high;
    uint64_t low;
} small;

/* value / 2^unit. */
static inline int64_t small_scaled(double value, int unit)
{
    const parts of = take_apart(value);
    const int shift = of.exponent - unit; /* below 0 where zeros end the mantissa */
    const int64_t amount = (int64_t)(shift >= 0 ? of.mantissa << (shift % LIMB_BITS)
                                                : of.mantissa >> (-shift % LIMB_BITS));
    return of.sign < 0 ? -amount : amount;
}

static inline void small_differences(int64_t difference[][DIMENSIONS],
                                     const double *const *point, size_t count, int unit)
{
    for (size_t i = 0; i < DIMENSIONS; i++) {
        const int64_t base = small_scaled(point[count][i], unit);
        for (size_t v = 0; v < count; v++)
            difference[v][i] = small_scaled(point[v][i], unit) - base;
    }
}

static inline small small_determinant3(const int64_t p[DIMENSIONS],
                                       const int64_t q[DIMENSIONS],
                                       const int64_t r[DIMENSIONS])
{
    int128 high = 0, low = 0; /* of 2^64: below 2^124 each, and 2^127 */
    for (size_t i = 0; i < DIMENSIONS; i++) {
        const size_t j = (i + 1) % DIMENSIONS;
        const size_t k = (i + 2) % DIMENSIONS;
        const int128 cofactor = (int128)q[j] * r[k] - (int128)q[k] * r[j];
        high += p[i] * (cofactor >> LIMB_BITS);
        low += p[i] * (int128)(uint64_t)cofactor;
    }
    return (small){high + (low >> LIMB_BITS), (uint64_t)low};
}

static inline int small_sign(small n)
{
    return n.high < 0 ? -1 : n.high > 0 || n.low > 0;
}

static void small_to_integer(integer *n, small from)
{
    n->sign = small_sign(from);
    const uint128 high = n->sign < 0 ? ~(uint128)from.high : (uint128)from.high;
    const uint64_t low = n->sign < 0 ? ~from.low + 1 : from.low;
    const uint128 amount = high + (n->sign < 0 && from.low == 0);
    n->limb[0] = low;
    n->limb[1] = (uint64_t)amount;
    n->limb[2] = (uint64_t)(amount >> LIMB_BITS);
    n->size = 3;
    trim(n);
}

static void small_square_length(integer *n, const int64_t p[DIMENSIONS])
{
    uint128 square = 0;
    for (size_t i = 0; i < DIMENSIONS; i++)
        square += (uint128)((int128)p[i] * p[i]);
    n->sign = 1;
    n->limb[0] = (uint64_t)square;
    n->limb[1] = (uint64_t)(square >> LIMB_BITS);
    n->size = 2;
    trim(n);
}

/* Large ones ------------------------------------------------------------------------ */

/* Differences of point[0 … count) to point[count]. */
static void differences(integer difference[][DIMENSIONS], const double *const *point,
                        size_t count, int unit)
{
    integer base;
    for (size_t i = 0; i < DIMENSIONS; i++) {
        scale(&base, point[count][i], unit);
        for (size_t v = 0; v < count; v++) {
            scale(&difference[v][i], point[v][i], unit);
            add(&difference[v][i], &base, -1);
        }
    }
}

/* out = det(p, q, r). */
static void determinant3(integer *out, const integer p[DIMENSIONS],
                         const integer q[DIMENSIONS], const integer r[DIMENSIONS])
{
    integer cofactor, product;
    set_zero(out);
    for (size_t i = 0; i < DIMENSIONS; i++) {
        const size_t j = (i + 1) % DIMENSIONS;
        const size_t k = (i + 2) % DIMENSIONS;
        multiply(&cofactor, &q[j], &r[k]);
        multiply(&product, &q[k], &r[j]);
        add(&cofactor, &product, -1);
        multiply(&product, &p[i], &cofactor);
        add(out, &product, 1);
    }
}

static void square_length(integer *out, const integer p[DIMENSIONS])
{
    integer square;
    set_zero(out);
    for (size_t i = 0; i < DIMENSIONS; i++) {
        multiply(&square, &p[i], &p[i]);
        add(out, &square, 1);
    }
}

/* Both ------------------------------------------------------------------------------ */

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
    enum { EDGES = 3 };
    const double *const point[EDGES + 1] = {b, c, d, a};
    if (on_axis_plane(point, EDGES + 1))
        return 0;
    const range found = find_range(point, EDGES + 1);
    if (found.bits <= SMALL_BITS) {
        int64_t edge[EDGES][DIMENSIONS];
        small_differences(edge, point, EDGES, found.unit);
        return small_sign(small_determinant3(edge[0], edge[1], edge[2]));
    }
    integer edge[EDGES][DIMENSIONS], determinant;
    differences(edge, point, EDGES, found.unit);
    determinant3(&determinant, edge[0], edge[1], edge[2]);
    return determinant.sign;
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
    const range found = find_range(point, MAX_POINTS);
    const bool is_small = found.bits <= SMALL_BITS;
    int64_t near[CORNERS][DIMENSIONS];
    integer edge[CORNERS][DIMENSIONS], determinant, cofactor, square, product;
    if (is_small)
        small_differences(near, point, CORNERS, found.unit);
    else
        differences(edge, point, CORNERS, found.unit);
    set_zero(&determinant);
    for (size_t v = 0; v < CORNERS; v++) {
        const size_t i = others[v][0], j = others[v][1], k = others[v][2];
        if (is_small) {
            small_to_integer(&cofactor, small_determinant3(near[i], near[j], near[k]));
            small_square_length(&square, near[v]);
        } else {
            determinant3(&cofactor, edge[i], edge[j], edge[k]);
            square_length(&square, edge[v]);
        }
        multiply(&product, &cofactor, &square);
        add(&determinant, &product, 1);
    }
    return determinant.sign;
}
