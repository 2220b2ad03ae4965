/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What p4est does: balance, and which leaves share a corner, an edge or a face. */
#ifndef TM_OCTREE_FOREST_H
#define TM_OCTREE_FOREST_H

#include "brick.h"
#include "leaf_list.h"

struct p8est;

/* A forest of the leaves, balanced over faces and edges. Leaves that balance has split
 * are replaced in the list; of all, each knows whether the surface meets it.
 * TM_ERROR_SYSTEM: memory; *forest is then NULL. O(leaves log leaves). */
tm_status tm_forest_balance(struct p8est **forest, tm_leaf_list *leaves,
                            const tm_octree *octree, const tm_brick *brick,
                            const tm_surface *surface, tm_error *error);

/* Fills octree->nodes, grid and node from the leaves and their forest. O(leaves). */
tm_status tm_forest_nodes(tm_octree *octree, struct p8est *forest, tm_error *error);

#endif
