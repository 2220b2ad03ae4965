/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of the repair, for lib/octree/repair*.c only. */
#ifndef TM_REPAIR_REPAIR_STEPS_H
#define TM_REPAIR_REPAIR_STEPS_H

#include "../../surface/surface.h"
#include "repair_state.h"

/* Moves nodes, with that effort, so that bad elements become good; nodes that are off
 * the surface may leave elements of `off_surface_threshold` behind. *score is that of the
 * state, before and after; it does not become worse. */
tm_status tm_repair_move(tm_repair_state *state, const tm_surface *surface,
                         double threshold, double off_surface_threshold, unsigned effort,
                         tm_repair_score *score, tm_error *error);

/* Makes elements at sharp tips of the surface anew (sharp_corner.h), where that makes
 * those around better; *count counts. */
tm_status tm_repair_sharp_corners(tm_repair_state *state, const tm_surface *surface,
                                  double threshold, tm_repair_score *score, size_t *count,
                                  tm_error *error);

/* Divides bad elements that are no tetrahedra from a node in their middle where the worst
 * part is better than they are, a quadrilateral on the boundary along a diagonal where
 * that is better still; then nodes move. All is as it was where that does not make the
 * state better; *divided counts elements that are divided. */
tm_status tm_repair_divide(tm_repair_state *state, const tm_surface *surface,
                           double threshold, tm_repair_score *score, size_t *divided,
                           tm_error *error);

/* Makes *to, which must be zeros, of the octree with those octants split once, balanced
 * and meshed again. It is to be freed, after an error too. */
tm_status tm_repair_remake(tm_repair_state *to, const tm_repair_state *from,
                           tm_surface *surface, const uint32_t *octant, size_t count,
                           tm_error *error);

#endif
