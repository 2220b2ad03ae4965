/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Peeling: a tetrahedron goes from its side of the surface, which is then on the other
 * side of it. One that is alone at an edge between two constrained faces, or that has one
 * face on the outside and its fourth node inside. */
#ifndef TM_OPERATION_PEEL_H
#define TM_OPERATION_PEEL_H

#include "../star.h"
#include "replacement.h"

/* Whether the one tetrahedron of an open star, or of a part of one, may go: its other two
 * faces have tetrahedra beyond, and their common edge is inside, without a marker. The
 * memory is in *around. False where there is none, too. */
bool tm_peel_is_possible(const tm_tet_mesh *mesh, const tm_star *star, tm_star *around);

/* Takes it away. renewal says what the two faces at the edge become; with `first` false
 * they are so already. beyond[0] and beyond[1] are the tetrahedra that were beyond the
 * other two. */
void tm_peel(tm_tet_mesh *mesh, const tm_star *star, const tm_face_renewal renewal[2],
             bool first, uint32_t beyond[2]);

/* Whether tetrahedron t, whose face i is on the outside, may go as far as it is
 * concerned: its other faces have tetrahedra beyond. */
bool tm_peel_face_is_possible(const tm_tet_mesh *mesh, uint32_t t, uint32_t i);

/* Takes it away. Its other faces are constrained then: face[0 … 3), of which the first is
 * what face i was; its fourth node gets the marker of that. beyond[0 … 3) are the
 * tetrahedra that were beyond. There must be room for two faces. */
void tm_peel_face(tm_tet_mesh *mesh, uint32_t t, uint32_t i, uint32_t face[3],
                  uint32_t beyond[3]);

#endif
