/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of which each of several ranks has a part: that of a share of an octree. */
#ifndef TM_LAYER_OCTREE_MESH_RANKS_H
#define TM_LAYER_OCTREE_MESH_RANKS_H

#include "../../base/extern_c.h"
#include "mesh_choice.h"
#include "mesh_share.h"

TM_EXTERN_C_BEGIN

/* The same as tm_octree_mesh_make_of(), of a share with one ring of ghosts, of which
 * *interior says what is chosen, of ghosts too. *alone says that it is not made: where
 * the boundary has hollows that may be regions, that is for one process. All ranks call
 * it. */
tm_status tm_octree_mesh_make_on_ranks(tm_octree_mesh *mesh, const tm_octree_share *share,
                                       tm_interior *interior, tm_surface *surface,
                                       const tm_progress *progress, bool *alone,
                                       tm_error *error);

/* As tm_octree_mesh_choose() of a surface without walls, and rules without lists. */
tm_status tm_octree_mesh_choose_on_ranks(tm_octree_mesh *mesh, tm_octree_share *share,
                                         tm_surface *surface, const tm_mesh_plan *plan,
                                         bool *alone, tm_error *error);

/* The deepest level of a leaf of any rank. */
unsigned tm_octree_share_deepest(const tm_octree_share *share);

TM_EXTERN_C_END

#endif
