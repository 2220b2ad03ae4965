/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quality of tetrahedra, pyramids, wedges and hexahedra: the scaled Jacobian of a corner
 * and the element-normalised one, J_ENS.
 *
 * The scaled Jacobian J_S of a corner is the determinant of the three edge vectors that
 * leave it, each of length 1, in the element's positive order: in [-1, 1], negative where
 * the corner is inverted. J_ENS is 1 where J_S is the K that the corner has in a regular
 * element:
 *
 *     J_ENS =  (1 + K) - J_S   if J_S >  K
 *           =   J_S / K        if -K <= J_S <= K
 *           = -(1 + K) - J_S   if J_S < -K
 *
 * (S. Donoso, 2022, after E. Daines and C. Lobos, 2018). An element is as good as its
 * worst corner. A corner with an edge of length 0 has J_S = 0, as a flat one has: it is
 * not inverted, nor is it valid. So is one whose edges overflow.
 *
 * The nodes of elements are in the order of shape.h, by which positive means with a
 * positive volume. */
#ifndef TM_ELEMENT_JENS_H
#define TM_ELEMENT_JENS_H

#include "../base/extern_c.h"
#include "shape.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* J_ENS of a corner with that J_S. */
static inline double tm_jens_of(double jacobian, double k)
{
    if (jacobian > k)
        return (1 + k) - jacobian;
    return jacobian >= -k ? jacobian / k : -(1 + k) - jacobian;
}

/* J_S of every corner, in the order of the shape, which is one of tm_element_shapes; item
 * are the element's nodes. */
void tm_scaled_jacobians(const tm_element_shape *shape, const double (*xyz)[3],
                         const uint32_t *item, double jacobian[TM_ELEMENT_CORNERS]);

/* J_ENS of an element of so many nodes, 4, 5, 6 or 8: the least of its corners. */
double tm_jens(size_t nodes, const double (*xyz)[3], const uint32_t *item);

/* The least scaled Jacobian of its corners. */
double tm_least_scaled_jacobian(size_t nodes, const double (*xyz)[3],
                                const uint32_t *item);

/* J_S of the corner at p with the neighbours a, b, c in positive order. */
double tm_scaled_jacobian(const double p[3], const double a[3], const double b[3],
                          const double c[3]);

/* The same with slope[i] its derivative with respect to p, a, b, c (i = 0 … 3), which is
 * 0 where the value is no derivative of anything: an edge of length 0. */
double tm_scaled_jacobian_slope(const double p[3], const double a[3], const double b[3],
                                const double c[3], double slope[4][3]);

TM_EXTERN_C_END

#endif
