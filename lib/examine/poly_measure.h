/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Volume and areas of a polyhedron by its boundary. */
#ifndef TM_EXAMINE_POLY_MEASURE_H
#define TM_EXAMINE_POLY_MEASURE_H

#include "poly_boundary.h"

/* The vector area of a polygon, ½ Σ (x_i - x_0) × (x_(i+1) - x_0): normal to it, as long
 * as its area where it is plane. O(count). */
void tm_polygon_area(const double (*xyz)[3], const uint32_t *node, size_t count,
                     double area[3]);

/* The volume that the faces enclose, positive if their normals point outward: the sum of
 * the tetrahedra of a node and the triangles into which each facet falls around its
 * first node, which are the same for both its cells. *uncertain is what rounding may
 * have made of it: 16 units of rounding of the sum of all magnitudes. O(corners). */
double tm_poly_volume(const tm_poly_boundary *b, const double (*xyz)[3],
                      double *uncertain);

/* The sign of the volume: 0 where |volume| is at most *uncertain; a tetrahedron's sign is
 * exact. The volume is written to *volume. O(corners). */
int tm_poly_sign(const tm_poly_boundary *b, const double (*xyz)[3], double *volume);

#endif
