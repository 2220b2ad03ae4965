/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of an octree that one of several ranks has: leaves of its own, which are next
 * to each other in the order of all, and, as ghosts, those of others around them. */
#ifndef TM_SHARE_OCTREE_SHARE_H
#define TM_SHARE_OCTREE_SHARE_H

#include "../../base/extern_c.h"
#include "../forest/octree.h"

TM_EXTERN_C_BEGIN

/* Own leaves or nodes, as local numbers, that other ranks have as ghosts: those of rank r
 * are item[start[r]] …, ascending. */
typedef struct tm_share_list {
    size_t *start;  /* [ranks + 1] */
    uint32_t *item; /* [start[ranks]] */
} tm_share_list;

/* Local leaves and nodes are in the order of the whole octree: those of each rank are
 * next to each other, in the order of ranks. Where the whole octree has a node, the leaf
 * that has it first in its order has a rank: that node is this rank's own. */
typedef struct tm_octree_share {
    unsigned rank, ranks;
    tm_octree octree;           /* of the local leaves: they do not fill the brick */
    size_t own_first, own_past; /* local leaves [own_first, own_past) are its own */
    size_t all_leaves;          /* of all ranks */
    uint32_t *leaf_number;      /* [local leaves]: in the whole octree, ascending */
    size_t *first; /* [ranks + 1]: the number of each rank's first leaf; leaf_number of
                      own_first is first[rank] */
    size_t own_node_first, own_node_past; /* the same of nodes */
    size_t all_nodes;
    uint32_t *node_number;
    size_t *first_node;
    tm_share_list leaves_sent, nodes_sent;
} tm_octree_share;

/* Cuts an octree into the parts of so many ranks: first[ranks + 1]. Leaves with surface
 * count for more than others, as more is made of them. O(leaves). */
void tm_share_leaves_of(const tm_octree *whole, unsigned ranks, size_t *first);

/* The part of one rank of a whole octree, with `rings` rings of ghosts: leaves of others
 * that touch, in a face, an edge or a corner, its own; those that touch these; and so on.
 * The rows of node[] of all local leaves are those of the whole octree. TM_ERROR_SYSTEM
 * where memory is out. O(ranks × rings × leaves): for tests. */
tm_status tm_octree_share_cut(tm_octree_share *share, const tm_octree *whole,
                              unsigned rank, unsigned ranks, unsigned rings,
                              tm_error *error);

/* This rank's part of the octree that tm_octree_build() makes of the same rules, of which
 * none may be TM_RULE_LEAVES; none has more of it at any time. All ranks call it with the
 * same surface. Errors as there. O(leaves + ghosts + triangles × roots). */
tm_status tm_octree_share_build(tm_octree_share *share, const tm_surface *surface,
                                const tm_octree_rule *rule, size_t rules, unsigned rings,
                                tm_error *error);

/* The same as tm_octree_refine() makes of it: splits each leaf with split[local leaf] !=
 * 0, which is only looked at for own ones. All leaves and nodes get new numbers, and
 * ranks. All ranks call it. Errors as there; *share is empty then. */
tm_status tm_octree_share_refine(tm_octree_share *share, const tm_surface *surface,
                                 const uint8_t *split, unsigned rings, tm_error *error);

/* The same share again, with arrays of its own. TM_ERROR_SYSTEM where memory is out; the
 * copy is to be freed all the same. */
tm_status tm_octree_share_copy(tm_octree_share *copy, const tm_octree_share *share,
                               tm_error *error);

/* Frees all; a share of zeros is an empty one. */
void tm_octree_share_free(tm_octree_share *share);

/* Gives ghosts the values that their ranks have for them: value[local leaves], or
 * value[local nodes], of `size` bytes each, own ones filled. TM_ERROR_SYSTEM where memory
 * is out. All ranks call it. O(ghosts). */
tm_status tm_share_fill_leaves(const tm_octree_share *share, void *value, size_t size,
                               tm_error *error);
tm_status tm_share_fill_nodes(const tm_octree_share *share, void *value, size_t size,
                              tm_error *error);

/* Of sets of local nodes, with the smallest one as the root of each (disjoint_sets.h),
 * that ranks have joined by what they have, makes sets of the whole octree: parent[n]
 * becomes the number in the whole octree of the smallest node of its set. TM_ERROR_SYSTEM
 * where memory is out. All ranks call it; what they tell all others are the sets that
 * have nodes of several ranks. O(nodes). */
tm_status tm_share_join_sets(const tm_octree_share *share, uint32_t *parent,
                             tm_error *error);

TM_EXTERN_C_END

#endif
