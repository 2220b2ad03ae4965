/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_parts.h"

#include "../../base/array.h"
#include "p4est_call.h"

#include <p8est_extended.h>
#include <p8est_io.h>
#include <stdlib.h>

/* p4est's grid is one level finer than ours. */
enum { FINER = P8EST_MAXLEVEL - TM_OCTREE_FINEST, FIELDS = 4 };

_Static_assert(TM_OCTREE_FINEST == P8EST_QMAXLEVEL, "the deepest level of p4est");

/* Leaves on their way into a forest; until[t]: how many there are up to tree t. */
typedef struct inflation {
    const tm_leaf_list *leaves;
    const tm_brick *brick;
    p4est_gloidx_t *until; /* [trees + 1] */
    p8est_t *forest;
} inflation;

/* The tree that the leaf is in, from the one that the leaf before it is in. */
static size_t tree_of(const tm_brick *brick, size_t tree, const uint32_t anchor[3])
{
    for (;; tree++) {
        const uint32_t *root = brick->root[tree];
        if (anchor[0] >> TM_OCTREE_FINEST == root[0] &&
            anchor[1] >> TM_OCTREE_FINEST == root[1] &&
            anchor[2] >> TM_OCTREE_FINEST == root[2])
            return tree;
    }
}

/* x y z level of each leaf in its tree. */
static void deflate(const inflation *in, p4est_qcoord_t *out)
{
    const uint32_t within = ((uint32_t)1 << TM_OCTREE_FINEST) - 1;
    const tm_leaf_list *leaves = in->leaves;
    size_t tree = 0;
    for (size_t i = 0; i < leaves->count; i++) {
        const tm_leaf *leaf = &leaves->leaf[i];
        for (const size_t now = tree_of(in->brick, tree, leaf->anchor); tree < now;)
            in->until[++tree] = (p4est_gloidx_t)i;
        for (int k = 0; k < 3; k++)
            *out++ = (p4est_qcoord_t)((leaf->anchor[k] & within) << FINER);
        *out++ = leaf->level;
    }
    while (tree < in->brick->count)
        in->until[++tree] = (p4est_gloidx_t)leaves->count;
}

static void inflate(void *user)
{
    inflation *in = user;
    const size_t count = in->leaves->count;
    sc_array_t *quadrants = sc_array_new_count(sizeof(p4est_qcoord_t), FIELDS * count);
    deflate(in, (p4est_qcoord_t *)(void *)quadrants->array);
    const p4est_gloidx_t first[2] = {0, (p4est_gloidx_t)count};
    in->forest = p8est_inflate(sc_MPI_COMM_SELF, in->brick->trees, first, in->until,
                               quadrants, NULL, NULL);
    sc_array_destroy(quadrants);
}

static void balance(void *forest)
{
    p8est_balance(forest, P8EST_CONNECT_EDGE, NULL);
}

/* A balanced forest of the leaves. */
static tm_status plant(p8est_t **forest, const tm_leaf_list *leaves,
                       const tm_brick *brick, tm_error *error)
{
    inflation in = {.leaves = leaves, .brick = brick};
    in.until = calloc(brick->count + 1, sizeof *in.until);
    tm_status status =
        in.until ? tm_p4est_call(inflate, &in, error) : tm_fail_memory(error);
    free(in.until);
    if (status == TM_OK)
        status = tm_p4est_call(balance, in.forest, error);
    if (status == TM_OK)
        *forest = in.forest;
    return status;
}

static void leaf_of(const p8est_quadrant_t *q, const uint32_t root[3], tm_leaf *leaf)
{
    *leaf =
        (tm_leaf){.anchor = {(root[0] << TM_OCTREE_FINEST) + ((uint32_t)q->x >> FINER),
                             (root[1] << TM_OCTREE_FINEST) + ((uint32_t)q->y >> FINER),
                             (root[2] << TM_OCTREE_FINEST) + ((uint32_t)q->z >> FINER)},
                  .level = (uint8_t)q->level};
}

/* Whether the leaf is the old one or a part of it. */
static bool within(const tm_leaf *leaf, const tm_leaf *old)
{
    const unsigned shift = TM_OCTREE_FINEST - old->level;
    for (int i = 0; i < 3; i++)
        if (leaf->anchor[i] >> shift != old->anchor[i] >> shift)
            return false;
    return true;
}

static bool crossed(const tm_leaf *leaf, const tm_leaf *old, const tm_octree *octree,
                    const tm_surface *surface)
{
    if (!old->crossed || leaf->level == old->level)
        return old->crossed;
    double low[3], high[3];
    tm_octree_box(octree, leaf->anchor, tm_leaf_shift(leaf), low, high);
    return tm_surface_meets_box(surface, low, high);
}

/* The leaves of the forest, in place of those that it was made of. */
static void replace(tm_leaf_list *leaves, tm_leaf *now, p8est_t *forest,
                    const tm_octree *octree, const tm_brick *brick,
                    const tm_surface *surface)
{
    const tm_leaf *old = leaves->leaf;
    size_t count = 0;
    for (size_t tree = 0; tree < brick->count; tree++) {
        p8est_tree_t *t = p8est_tree_array_index(forest->trees, (p4est_topidx_t)tree);
        for (size_t i = 0; i < t->quadrants.elem_count; i++) {
            tm_leaf *leaf = &now[count++];
            leaf_of(p8est_quadrant_array_index(&t->quadrants, i), brick->root[tree],
                    leaf);
            while (!within(leaf, old))
                old++;
            leaf->crossed = crossed(leaf, old, octree, surface);
        }
    }
    free(leaves->leaf);
    *leaves = (tm_leaf_list){.count = count, .room = count, .leaf = now};
}

static tm_status take_leaves(tm_leaf_list *leaves, p8est_t *forest,
                             const tm_octree *octree, const tm_brick *brick,
                             const tm_surface *surface, tm_error *error)
{
    const size_t count = (size_t)forest->local_num_quadrants;
    if (count == leaves->count)
        return TM_OK;
    tm_leaf *now = tm_new(count, sizeof *now);
    if (!now)
        return tm_fail_memory(error);
    replace(leaves, now, forest, octree, brick, surface);
    return TM_OK;
}

tm_status tm_balance(tm_leaf_list *leaves, const tm_octree *octree, const tm_brick *brick,
                     const tm_surface *surface, tm_error *error)
{
    p8est_t *forest = NULL;
    tm_status status = plant(&forest, leaves, brick, error);
    if (status != TM_OK)
        return status;
    status = take_leaves(leaves, forest, octree, brick, surface, error);
    p8est_destroy(forest);
    return status;
}
