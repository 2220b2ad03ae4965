/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What p4est does: balance, and which leaves share a corner, an edge or a face. */
#ifndef TM_OCTREE_FOREST_H
#define TM_OCTREE_FOREST_H

#include "brick.h"
#include "leaf_list.h"

struct p8est;

/* A forest of the leaves, balanced over faces and edges. Leaves that balance has split
 * are replaced in the list; of these, each knows whether the surface meets it.
 * TM_ERROR_SYSTEM: memory, as far as it can be foreseen: what p4est cannot allocate ends
 * the program. O(leaves log leaves). */
tm_status tm_forest_balance(struct p8est **forest, tm_leaf_list *leaves,
                            const tm_octree *octree, const tm_brick *brick,
                            const tm_surface *surface, tm_error *error);

/* Fills octree->nodes, grid and node from the leaves and their forest. O(leaves). */
tm_status tm_forest_nodes(tm_octree *octree, struct p8est *forest, tm_error *error);

/* Frees what malloc has got if there is so much of it: a try, before p4est ends the
 * program for it. */
tm_status tm_forest_memory(size_t count, size_t size, tm_error *error);

#endif
