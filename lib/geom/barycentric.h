/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a point is in a tetrahedron. */
#ifndef TM_GEOM_BARYCENTRIC_H
#define TM_GEOM_BARYCENTRIC_H

#include "../base/extern_c.h"

TM_EXTERN_C_BEGIN

/* Writes the weights of the four corners that make p; they add up to 1. A tetrahedron
 * that is flat to the rounding of its coordinates is the triangle (the edge, the point)
 * of its corners that are the farthest from each other, and the weights make the point of
 * that plane (line) that is closest to p: so Σ weight·corner is p but for such a rounding
 * wherever p is in the tetrahedron, however thin.
 *
 * Returns how deep p is: the least weight, negative outside; in a flat one that is at
 * most 0, and at most minus the distance to it, in edges. Nothing is allocated; by Gram
 * and Schmidt with pivots, some hundred operations. */
double tm_barycentric(const double *const corner[4], const double p[3], double weight[4]);

TM_EXTERN_C_END

#endif
