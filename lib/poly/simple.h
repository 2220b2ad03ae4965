/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The complete test whether a set of tetrahedra is a ball: each edge of its boundary has
 * two boundary faces, the faces around each boundary node are one fan, the boundary is
 * connected, and V - E + F = 2. Together they say that the boundary is a sphere. Euler's
 * formula alone does not: it holds for some sets that touch themselves. */
#ifndef TM_POLY_SIMPLE_H
#define TM_POLY_SIMPLE_H

#include "../tet/mesh.h"

/* Whether the tetrahedra tet[0 … count), which are those with piece[t] == id, are a ball.
 * No kept face is between two of them. *simple is the answer. Expected O(count). */
tm_status tm_tets_are_simple(const tm_tet_mesh *mesh, const uint32_t *piece, uint32_t id,
                             const uint32_t *tet, size_t count, bool *simple,
                             tm_error *error);

#endif
