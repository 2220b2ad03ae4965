/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of the repair, for lib/octree/repair*.c only. */
#ifndef TM_REPAIR_REPAIR_STEPS_H
#define TM_REPAIR_REPAIR_STEPS_H

#include "../../stream/stream.h"
#include "../../surface/surface.h"
#include "repair_state.h"

/* Whether the only attribute of nodes is their place: of those that are marked on a
 * patch, a curve or a corner, of others inside; or says so, and that none is off the
 * surface. */
bool tm_repair_are_places(const tm_block *node, const bool *where);
bool tm_repair_says_none_held(const tm_block *node);

/* Room for as many nodes and elements as to->mesh says, and their items. */
tm_status tm_repair_allocate(tm_repair_state *to, size_t items, tm_error *error);

/* Copies all but the octree to *to, which has zeros; it is to be freed, after an error
 * too. */
tm_status tm_repair_copy_mesh(tm_repair_state *to, const tm_repair_state *from,
                              tm_error *error);

/* Takes the mesh of another state of the same octree, which is empty then. */
void tm_repair_take_mesh(tm_repair_state *state, tm_repair_state *by);

/* How nodes are moved. */
typedef struct tm_repair_effort {
    unsigned effort; /* of tm_optimise_options */
    double aim;      /* at least: what elements are to be, whatever the threshold is */
    double share;    /* of that: what nodes that come to the surface may leave of elements
                        on the way; 0: they stay where they are */
    size_t measured; /* elements, at most, for each that is bad and each node off the
                        surface … */
    size_t at_least; /* … and so many in any case */
} tm_repair_effort;

/* The whole mesh is taken to move nodes unless so many times less is bad. */
enum { TM_REPAIR_PART_LESS = 100 };

/* Moves nodes so that bad elements become good and nodes that are off the surface come to
 * it. *score is that of the state, before and after; what does not become better in one
 * place is as it was there. */
tm_status tm_repair_move(tm_repair_state *state, const tm_surface *surface,
                         double threshold, tm_repair_effort effort,
                         tm_repair_score *score, tm_error *error);

/* Takes back what has moved since `before` was saved, piece by piece, where it is not
 * better by tm_repair_better(), or an element fell below max(half of the worst J_ENS
 * there, TM_REPAIR_FLAT), but for fewer invalid ones; `worst` is the J_ENS of all the
 * mesh before. O(elements). */
tm_status tm_repair_take_back(tm_repair_state *state, const tm_repair_points *before,
                              double threshold, double worst, tm_error *error);

/* Makes elements at sharp tips of the surface anew (sharp_corner.h), where that makes
 * those around better; *count counts. */
tm_status tm_repair_sharp_corners(tm_repair_state *state, const tm_surface *surface,
                                  double threshold, tm_repair_score *score, size_t *count,
                                  tm_error *error);

/* Divides bad elements that are no tetrahedra from a node in their middle where the worst
 * part is better than they are and one at most is bad, a quadrilateral on the boundary
 * along a diagonal where that is better still; then nodes move. *divided counts elements
 * that are divided. */
tm_status tm_repair_divide(tm_repair_state *state, const tm_surface *surface,
                           double threshold, tm_repair_score *score, size_t *divided,
                           tm_error *error);

/* Makes *to, which must be zeros, of the octree with those octants split once, balanced
 * and meshed again; with `layer` also those between them and the surface. It is to be
 * freed, after an error too. */
tm_status tm_repair_remake(tm_repair_state *to, const tm_repair_state *from,
                           tm_surface *surface, const uint32_t *octant, size_t count,
                           bool layer, tm_error *error);

#endif
