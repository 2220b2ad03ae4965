/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact signs of the orientation and in-sphere determinants, for all finite doubles,
 * from subnormal numbers to the largest ones. Threads may call them at the same time.
 *
 * A rounded determinant decides when it is farther from 0 than its error can be; else
 * integers do (predicates_exact.c); nothing is allocated. The relative part of the error
 * bound is stage A of J. R. Shewchuk, Adaptive precision floating-point arithmetic and
 * fast robust geometric predicates, Discrete & Computational Geometry 18 (1997), section
 * 4. His bounds hold while nothing underflows. Here each bound has a second term for
 * that: a difference of doubles never underflows inexactly, and a product that does is
 * wrong by at most u = 2^-1075 more than its rounding error. Following these u through
 * the remaining products gives the second terms below; both use 2^-960 instead of u,
 * which also pays for rounding and underflow in the bound itself and is still far below
 * what coordinates above 1e-90 lead to. Overflow makes the bound infinite or NaN, which
 * decides nothing.
 */
#ifndef TM_GEOM_PREDICATES_H
#define TM_GEOM_PREDICATES_H

#include <math.h>

/* Half an ulp of 1. */
#define TM_HALF_ULP 0x1p-53

/* Far above what one underflow loses; see the top. */
#define TM_UNDERFLOW 0x1p-960

/* The sign of det(b-a, c-a, d-a) without the rounded shortcut. */
int tm_orient3d_exact(const double a[3], const double b[3], const double c[3],
                      const double d[3]);

/* The sign (-1, 0, +1) of det(b-a, c-a, d-a): +1 where d lies on the side that
 * (b-a) × (c-a) points to, as in every tetrahedron of a stream; 0 where the four points
 * are coplanar. Coordinates must be finite. About 5 ns unless nearly coplanar.
 *
 * Error: Shewchuk's (7 + 56ε)ε times the permanent (his o3derrboundA). Underflow: in
 * x·(p - q) the two products lose 2u|x| and the outer one u; the sum over three rows is
 * below 4u (1 + |x1| + |x2| + |x3|). */
static inline int tm_orient3d(const double a[3], const double b[3], const double c[3],
                              const double d[3])
{
    const double relative_error = (7 + 56 * TM_HALF_ULP) * TM_HALF_ULP;
    const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
    const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
    const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];

    const double cydz = cy * dz, czdy = cz * dy;
    const double dybz = dy * bz, dzby = dz * by;
    const double bycz = by * cz, bzcy = bz * cy;
    const double determinant =
        bx * (cydz - czdy) + cx * (dybz - dzby) + dx * (bycz - bzcy);

    const double permanent = fabs(bx) * (fabs(cydz) + fabs(czdy)) +
                             fabs(cx) * (fabs(dybz) + fabs(dzby)) +
                             fabs(dx) * (fabs(bycz) + fabs(bzcy));
    const double bound =
        relative_error * permanent + TM_UNDERFLOW * (1 + fabs(bx) + fabs(cx) + fabs(dx));
    if (determinant > bound)
        return 1;
    if (determinant < -bound)
        return -1;
    return tm_orient3d_exact(a, b, c, d);
}

/* The sign of det(b-a, c-a) without the rounded shortcut. */
static inline int tm_orient2d_exact(const double a[2], const double b[2],
                                    const double c[2])
{
    const double a3[3] = {a[0], a[1], 0};
    const double b3[3] = {b[0], b[1], 0};
    const double c3[3] = {c[0], c[1], 0};
    const double over[3] = {a[0], a[1], 1};
    return tm_orient3d_exact(a3, b3, c3, over);
}

/* The sign (-1, 0, +1) of det(b-a, c-a): +1 where a, b, c turn counter-clockwise, 0 where
 * they are on a line. Coordinates must be finite. Error: Shewchuk's (3 + 16ε)ε times the
 * permanent (his ccwerrboundA); two products lose at most one u each. */
static inline int tm_orient2d(const double a[2], const double b[2], const double c[2])
{
    const double relative_error = (3 + 16 * TM_HALF_ULP) * TM_HALF_ULP;
    const double left = (b[0] - a[0]) * (c[1] - a[1]);
    const double right = (b[1] - a[1]) * (c[0] - a[0]);
    const double bound = relative_error * (fabs(left) + fabs(right)) + TM_UNDERFLOW;
    if (left - right > bound)
        return 1;
    if (left - right < -bound)
        return -1;
    return tm_orient2d_exact(a, b, c);
}

/* The sign of the in-sphere determinant without the rounded shortcut. */
int tm_insphere_exact(const double a[3], const double b[3], const double c[3],
                      const double d[3], const double e[3]);

/* Where e lies to the sphere through a, b, c, d, for tm_orient3d(a, b, c, d) > 0:
 * +1 strictly inside, -1 outside, 0 on it. The sign turns with that of abcd; for
 * coplanar abcd it is that of the determinant, which is 0 if all five are on a common
 * sphere or plane. Coordinates must be finite. About 20 ns unless nearly cospherical. */
int tm_insphere(const double a[3], const double b[3], const double c[3],
                const double d[3], const double e[3]);

#endif
