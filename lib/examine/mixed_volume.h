/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How large a mixed element is, and which way its corners turn. */
#ifndef TM_EXAMINE_MIXED_VOLUME_H
#define TM_EXAMINE_MIXED_VOLUME_H

#include "../base/extern_c.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* The signed volume of an element of k nodes (4, 5, 6 or 8) whose quadrilaterals are
 * bilinear: the integral of the Jacobian of the trilinear hexahedron, and of what wedge
 * and pyramid are of it. It is the sum over the faces of the cones from a node to them,
 * and the cone to a bilinear face a b c d is the mean of those to the two pairs of
 * triangles that its diagonals make (the face halves the tetrahedron a b c d): (a + b + c
 * + d) · ((c - a) × (d - b)) / 24. So volumes of elements that share their faces add up
 * to the volume of the whole, but for rounding. */
double tm_mixed_volume(const double (*xyz)[3], const uint32_t *node, size_t k);

/* How many corners of an element have an exactly negative, zero and positive determinant
 * of the edges that leave it. Of the four at a pyramid's apex each is that of a corner of
 * the base; those of a tetrahedron are one. */
typedef struct tm_mixed_corners {
    unsigned negative, zero, positive;
} tm_mixed_corners;

/* Those of an element of k nodes. */
tm_mixed_corners tm_mixed_corners_of(const double (*xyz)[3], const uint32_t *node,
                                     size_t k);

TM_EXTERN_C_END

#endif
