/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Peeling: a tetrahedron that is alone at an edge between two constrained faces goes from
 * its side of the surface, which is then on the other side of it. */
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

#endif
