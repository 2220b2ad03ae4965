/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The octants above the leaves, up to one that has all roots. */
#ifndef TM_FOREST_LEAF_TREE_H
#define TM_FOREST_LEAF_TREE_H

#include "octree.h"

/* A cell of the tree: a leaf of the octree with this bit, an octant that is split without
 * it, or TM_NONE, which has none: it is outside the brick, or other ranks have its. */
#define TM_LEAF_BIT ((uint32_t)1 << 31)

typedef struct tm_leaf_tree {
    uint32_t top;
    size_t octants;
    size_t room;
    uint32_t (*child)[8]; /* [octants]: cells, in the order of corners */
} tm_leaf_tree;

/* Whether a cell is split. */
static inline bool tm_is_split(uint32_t cell)
{
    return cell < TM_LEAF_BIT;
}

static inline bool tm_is_leaf(uint32_t cell)
{
    return cell >= TM_LEAF_BIT && cell != TM_NONE;
}

/* Makes the tree of leaves in order. O(leaves). */
tm_status tm_leaf_tree_make(tm_leaf_tree *tree, const tm_octree *octree, tm_error *error);

void tm_leaf_tree_free(tm_leaf_tree *tree);

#endif
