/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of a mesh that a rank has: of the leaves of its share of the octree, and of
 * the ghosts around them. */
#ifndef TM_LAYER_MESH_SHARE_H
#define TM_LAYER_MESH_SHARE_H

#include "../../base/extern_c.h"
#include "../share/mesh_ghosts.h"
#include "assemble.h"

TM_EXTERN_C_BEGIN

/* Own things, which are next to each other: first … past - 1 here; in the whole mesh the
 * first of them has a number, and there are `all`. */
typedef struct tm_own_range {
    size_t first, past, number, all;
} tm_own_range;

/* Of an ascending list of places those that are [first, past), behind those of the ranks
 * before this one. All ranks call it. */
tm_own_range tm_own_range_of(const uint32_t *place, size_t count, size_t first,
                             size_t past);

/* Nodes and elements are in the order of the whole mesh. A node is of the rank that has
 * its node of the octree, or its leaf, which has all elements around it. */
typedef struct tm_mesh_share {
    const tm_octree_share *of;
    tm_own_range core, outer, middles; /* nodes, outer ones as of the interior boundary,
                                          middles by the assembly's number of them */
    tm_own_range elements, faces;      /* faces of the interior boundary */
    size_t nodes;                      /* of the whole mesh */
    uint32_t *number;                  /* [nodes of the mesh]: in the whole mesh */
    tm_mesh_ghosts ghosts;             /* of its nodes */
} tm_mesh_share;

/* Finds it, of an assembly in one part. TM_ERROR_SYSTEM where memory is out, or the whole
 * mesh is too large for 32-bit numbers; to be freed, after an error too. All ranks call
 * it. O(nodes). */
tm_status tm_mesh_share_find(tm_mesh_share *share, const tm_octree_share *of,
                             const tm_assembly *assembly,
                             const tm_interior_boundary *boundary, tm_error *error);
void tm_mesh_share_free(tm_mesh_share *share);

/* The node here that has that number, or TM_NONE. O(log nodes). */
uint32_t tm_mesh_share_node(const tm_mesh_share *share, const tm_assembly *assembly,
                            uint32_t number);

TM_EXTERN_C_END

#endif
