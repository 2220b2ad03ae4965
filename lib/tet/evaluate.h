/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh's node attributes as a function that is linear in each tetrahedron, and its
 * values at the nodes of another mesh of the same domain. */
#ifndef TM_TET_EVALUATE_H
#define TM_TET_EVALUATE_H

#include "mesh.h"

TM_EXTERN_C_BEGIN

/* Sets the attributes of the nodes of `node` that are at no node of `from` and not
 * known[v] (NULL: none is); `ele` has the tetrahedra between them. `node` has as many
 * attributes as `from`. A node that is in no tetrahedron of `from` gets those of one that
 * it is nearly in, as at the nearest place there by barycentric coordinates.
 *
 * Each search begins where a neighbour was found, and goes on over the faces that the
 * node is beyond: the edge between the two is in the domain, so that it need not leave
 * it. TM_ERROR_SYSTEM where memory is out. Expected O(nodes) where both meshes are alike,
 * at most O(nodes · tetrahedra). */
tm_status tm_tet_evaluate(const tm_tet_mesh *from, tm_block *node, const tm_block *ele,
                          const bool *known, tm_error *error);

TM_EXTERN_C_END

#endif
