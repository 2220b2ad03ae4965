/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interior boundary of all ranks: it is small against the mesh. */
#ifndef TM_LAYER_SKIN_H
#define TM_LAYER_SKIN_H

#include "../interior/interior_boundary.h"
#include "mesh_share.h"

/* What a rank has of the interior boundary: nodes and faces in the order of the whole
 * one, those of its own octree nodes and leaves its own. */
typedef struct tm_boundary_share {
    tm_own_range nodes, faces;
    uint32_t *number;      /* [nodes of the boundary]: in the whole one */
    uint32_t *face_number; /* [faces of the boundary] */
    tm_mesh_ghosts ghosts; /* of its nodes */
} tm_boundary_share;

/* Finds it of the boundary of a share's leaves. TM_ERROR_SYSTEM where memory is out; to
 * be freed, after an error too. */
tm_status tm_boundary_share_find(tm_boundary_share *share, const tm_octree_share *of,
                                 const tm_interior_boundary *boundary, tm_error *error);
void tm_boundary_share_free(tm_boundary_share *share);

/* The whole one, without what only an octree has (grid_node, leaf, piece), on all ranks.
 */
tm_status tm_skin_share(tm_interior_boundary *skin, const tm_boundary_share *share,
                        const tm_interior_boundary *boundary, tm_error *error);

/* Of own items, `size` bytes each, of all ranks: *all, on all ranks, to be freed. */
tm_status tm_own_share(tm_own_range own, const void *items, size_t size, void **all,
                       tm_error *error);

#endif
