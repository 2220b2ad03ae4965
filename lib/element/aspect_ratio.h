/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How long and how flat an element is: the shortest of some lengths across it over the
 * longest of them, 1 for the best and 0 for a flat one (E. Daines and C. Lobos, 2018, as
 * given by S. Donoso, 2022). Orientation does not count. */
#ifndef TM_ELEMENT_ASPECT_RATIO_H
#define TM_ELEMENT_ASPECT_RATIO_H

#include "../base/extern_c.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Of an element of so many nodes, 4, 5, 6 or 8, in the order of shape.h.
 * The lengths are:
 *
 * - hexahedron: between the centres of opposite faces, three;
 * - pyramid: between the midpoints of opposite edges of the base, two, and the height of
 *   the apex over the plane through all four of these;
 * - wedge: in each quadrilateral between the midpoints of opposite edges, and from its
 *   centre to the midpoint of the lateral edge opposite, nine. A regular one has √3/2.
 *
 * A tetrahedron has the inverse of its aspect ratio gamma, 6√2 V / l³ with l² the mean of
 * the six squared edges: 1 for the regular one. In [0, 1], but for rounding; 0 where
 * all lengths are 0 or one overflows. O(1). */
double tm_aspect_ratio(size_t nodes, const double (*xyz)[3], const uint32_t *item);

TM_EXTERN_C_END

#endif
