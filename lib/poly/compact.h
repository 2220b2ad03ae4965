/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compact cells of even size: from runs along a curve, those at borders change sides
 * while that makes the cells more compact. What is made small is
 *
 *     Σ over the cells of ∫ |x - centroid|² dx  +  price · area between cells:
 *
 * the first term, as in k-means (J. A. Hartigan, M. A. Wong, Algorithm AS 136, 1979),
 * asks for round cells of even size; the second one, which comes when the first is
 * settled, for smooth borders. */
#ifndef TM_POLY_COMPACT_H
#define TM_POLY_COMPACT_H

#include "partition.h"

/* Items that cells are made of, and what is beside them: item i has centre[i], its
 * centroid and its volume, and is beside beside[start[i] … start[i + 1]), across faces of
 * area[…]; TM_NONE at the boundary and where nothing is to be joined. */
typedef struct tm_compact_items {
    size_t items;
    double (*centre)[4];
    const size_t *start; /* [items + 1]; NULL: four each */
    uint32_t *beside;
    double *area;
} tm_compact_items;

/* Labels items, in the order of a curve, by about `cells` regions, or with 0 such of the
 * volume of a cube with side `size`; none goes across TM_NONE, and one may be in pieces.
 * O(faces) for each of some ten sweeps. */
tm_status tm_compact_label(const tm_compact_items *items, size_t cells, double size,
                           const tm_progress *progress, uint32_t *label, size_t *regions,
                           tm_error *error);

/* Labels the tetrahedra of a sorted mesh so, by options->cells and options->size. */
tm_status tm_poly_compact(const tm_tet_mesh *mesh, const tm_poly_options *options,
                          uint32_t *label, size_t *regions, tm_error *error);

#endif
