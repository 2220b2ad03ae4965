/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contraction of an edge: a node goes, and what was joined to it is joined to the other
 * end of the edge. The tetrahedra around the edge go with it. */
#ifndef TM_OPERATION_CONTRACTION_H
#define TM_OPERATION_CONTRACTION_H

#include "../../element/tet_measure.h"
#include "ball.h"

/* What the tetrahedra of the ball that stay would cost with node b in the place of the
 * ball's own; HUGE_VAL where one would be below `least`, or not exactly positive, or the
 * sum not below `most`. *gone is how many have b already. O(size).
 *
 * The tetrahedra that stay fill the ball exactly if they are positive and b is in every
 * constrained face's plane that the node is in: the ball is bounded by their outer faces,
 * the faces that b has, and those flat ones. Where the surface moves, other things have
 * to hold, which the caller sees to; then a tetrahedron with b may go also where its face
 * opposite b is constrained. */
double tm_contraction_cost(const tm_tet_mesh *mesh, const tm_ball *ball, uint32_t b,
                           bool surface_moves, const tm_cost *cost, double least,
                           double most, size_t *gone);

/* Contracts the ball's node into b. Constrained faces and edges of .edge move along or
 * go. The tetrahedra that are changed, ball->size at most, go to created; returns how
 * many. O(size). */
size_t tm_contract(tm_tet_mesh *mesh, const tm_ball *ball, uint32_t b, uint32_t *created);

#endif
