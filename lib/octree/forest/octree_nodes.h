/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nodes of an octree. */
#ifndef TM_FOREST_OCTREE_NODES_H
#define TM_FOREST_OCTREE_NODES_H

#include "octree.h"

/* Fills nodes, grid and node of an octree whose leaves are in order, fill the brick and
 * are balanced over faces and edges. TM_ERROR_INPUT: 32-bit ids do not do. O(leaves). */
tm_status tm_octree_number_nodes(tm_octree *octree, tm_error *error);

#endif
