/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Leaves on their way to an octree: root by root, in Z order within each. */
#ifndef TM_FOREST_LEAF_LIST_H
#define TM_FOREST_LEAF_LIST_H

#include "octree.h"
#include "../../base/ids.h"

/* p4est counts with 31 bits, and balance needs some of them. */
#define TM_LEAVES_MAX ((size_t)TM_IDS / 4 + 1)

typedef struct tm_leaf_list {
    size_t count;
    size_t room;
    tm_leaf *leaf;
} tm_leaf_list;

/* The base-2 logarithm of a leaf's side in units of the finest level. */
static inline unsigned tm_leaf_shift(const tm_leaf *leaf)
{
    return TM_OCTREE_FINEST - (unsigned)leaf->level;
}

/* The same of the smallest octant that has all roots. */
static inline unsigned tm_octree_shift(const tm_octree *octree)
{
    unsigned shift = TM_OCTREE_FINEST;
    for (int i = 0; i < 3; i++)
        while (octree->roots[i] << TM_OCTREE_FINEST > (uint32_t)1 << shift)
            shift++;
    return shift;
}

/* The corners of the cube of 2^shift units at anchor, as all of lib/octree computes them.
 */
static inline void tm_octree_box(const tm_octree *octree, const uint32_t anchor[3],
                                 unsigned shift, double low[3], double high[3])
{
    const uint32_t side = (uint32_t)1 << shift;
    const uint32_t far[3] = {anchor[0] + side, anchor[1] + side, anchor[2] + side};
    tm_octree_point(octree, anchor, low);
    tm_octree_point(octree, far, high);
}

/* The anchor of the child at corner c of the cube of 2^shift units at anchor. */
static inline void tm_octree_child(const uint32_t anchor[3], unsigned shift, unsigned c,
                                   uint32_t child[3])
{
    const uint32_t half = (uint32_t)1 << (shift - 1);
    for (unsigned i = 0; i < 3; i++)
        child[i] = anchor[i] + ((c >> i & 1) ? half : 0);
}

/* Whether an octree can have so many leaves: TM_ERROR_SYSTEM where the machine's memory
 * would not hold it, TM_ERROR_INPUT where there are more than TM_LEAVES_MAX. */
tm_status tm_leaf_list_check(size_t count, tm_error *error);

/* Appends the leaves of another list; the same errors. */
tm_status tm_leaf_list_append(tm_leaf_list *list, const tm_leaf_list *more,
                              tm_error *error);

/* Appends a leaf. TM_ERROR_SYSTEM: memory, also that of an octree of so many leaves;
 * TM_ERROR_INPUT: there are more than TM_LEAVES_MAX. */
tm_status tm_leaf_list_add(tm_leaf_list *list, const uint32_t anchor[3], unsigned level,
                           bool crossed, tm_error *error);

#endif
