/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leaves of one size along curves where walls meet at sharp angles: the octants that are
 * given to regions there must not be larger than those that the surface meets. */
#ifndef TM_INTERIOR_WALL_REFINEMENT_H
#define TM_INTERIOR_WALL_REFINEMENT_H

#include "../forest/octree.h"

/* Splits leaves up to two away from those that such a curve of the surface runs through
 * until none is larger. TM_ERROR_SYSTEM where memory is out, TM_ERROR_INPUT as
 * tm_octree_refine(). O(leaves) for each level that they differ by. */
tm_status tm_octree_refine_walls(tm_octree *octree, const tm_surface *surface,
                                 tm_error *error);

#endif
