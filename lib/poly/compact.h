/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compact cells of even size: from runs of tetrahedra along the curve, those at borders
 * change sides while that makes the cells more compact. What is made small is
 *
 *     Σ over the cells of ∫ |x - centroid|² dx  +  price · area between cells:
 *
 * the first term, as in k-means (J. A. Hartigan, M. A. Wong, Algorithm AS 136, 1979),
 * asks for round cells of even size; the second one, which comes when the first is
 * settled, for smooth borders. */
#ifndef TM_POLY_COMPACT_H
#define TM_POLY_COMPACT_H

#include "partition.h"

/* Labels the tetrahedra of a sorted mesh by about options->cells regions, or such of the
 * volume of a cube with the side options->size; none goes across a kept face, and one may
 * be in pieces. O(tetrahedra) for each of some ten sweeps. */
tm_status tm_poly_compact(const tm_tet_mesh *mesh, const tm_poly_options *options,
                          uint32_t *label, size_t *regions, tm_error *error);

#endif
