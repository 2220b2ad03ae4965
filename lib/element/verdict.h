/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two measures as VTK's vtkMeshQuality gives them, which are those of the library Verdict
 * (Sandia National Laboratories; C. Stimpson, C. Ernst, P. Knupp, P. Pébay, D. Thompson,
 * The Verdict geometric quality library, SAND2007-1751), for comparison with it. Both are
 * 1 for what Verdict takes for regular: all edges alike, at right angles in hexahedra.
 *
 * They differ from VTK in what VTK does not say of use: where an edge has length 0 its
 * functions may return ±1e30, these 0. VTK's own node order of wedges, which .mix has, is
 * not Verdict's: the triangle 0 1 2 is seen to turn the other way, so that Verdict
 * returns -1 for a regular wedge of VTK's. Here it is 1. */
#ifndef TM_ELEMENT_VERDICT_H
#define TM_ELEMENT_VERDICT_H

#include "../base/extern_c.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* The scaled Jacobian, of an element of 4, 5, 6 or 8 nodes in the order of
 * shape.h. With J_S of jens.h:
 *
 * - hexahedron: the least J_S of the eight corners and of the centre, where it is that of
 *   the three sums of parallel edges;
 * - wedge: 2/√3 times the least J_S;
 * - tetrahedron: √2 times the J_S nearest to 0, which is the least one unless inverted;
 * - pyramid: √2 times the least of those values of its four tetrahedra, two for each
 *   diagonal of the base, where it is above 1 then 2 less it, and 0 where it is negative.
 *
 * In [-2/√3, 2/√3] for wedges, [-√2, √2] for tetrahedra, [-1, 1] else. */
double tm_verdict_scaled_jacobian(size_t nodes, const double (*xyz)[3],
                                  const uint32_t *item);

/* The shape: the least 3 (w det)^(2/3) / (|a|² + |b|² + |c|²) of the corners with edges
 * a, b, c, with w = 1 for hexahedra, 2/√3 for wedges; 0 where a determinant is not
 * positive. Of a tetrahedron 3 (√2 det)^(2/3) over half the sum of its six squared edges.
 * Of a pyramid the product of three: the shape of the base, the least 2 area / (|a|² +
 * |b|²) of its corners; the cosine of the angle between the base's normal at node 0 and
 * the line from the base's centre to the apex; the distance of the apex along that normal
 * over 1/√2 of the longest edge, or that over it if it is less. (VTK to 9.3 may leave the
 * edge 0 1 out of the longest.) In [0, 1]. */
double tm_verdict_shape(size_t nodes, const double (*xyz)[3], const uint32_t *item);

TM_EXTERN_C_END

#endif
