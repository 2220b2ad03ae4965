/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interior of an octree of which each rank has a share. What it is at ghosts is what
 * it is where these are own ones. All ranks call these functions; those that return a
 * tm_status return the same one. */
#ifndef TM_INTERIOR_INTERIOR_SHARE_H
#define TM_INTERIOR_INTERIOR_SHARE_H

#include "../share/octree_share.h"
#include "interior_leaves.h"

/* Chooses local leaves as tm_interior_choose() does of the whole octree, over a surface
 * without walls and with an inside (not by_winding). count, filled and removed are those
 * of all ranks. What all have at a time are the leaves at nodes with a mask that is not
 * good. */
tm_status tm_interior_choose_on_ranks(tm_interior *interior, const tm_octree_share *share,
                                      const tm_surface *surface, tm_error *error);

/* used, and count of all ranks, from what is chosen. */
tm_status tm_interior_find_used_on_ranks(tm_interior *interior,
                                         const tm_octree_share *share, tm_error *error);

/* What tm_interior_find_enclosed() finds. */
tm_status tm_interior_find_enclosed_on_ranks(tm_interior *enclosed, tm_interior *interior,
                                             const tm_octree_share *share,
                                             const tm_surface *surface, tm_error *error);

#endif
