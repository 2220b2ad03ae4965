/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_build.h"

#include "../../base/array.h"
#include "brick.h"
#include "octree_parts.h"
#include "mpi_start.h"
#include "z_order.h"

#include <stdlib.h>
#include <string.h>

/* A leaf with its rank in the order of an octree. */
typedef struct ranked {
    uint64_t root; /* its rank among all roots, in Z order */
    uint64_t cell; /* of its low corner, in the root */
    uint32_t number;
} ranked;

static int compare(const void *a, const void *b)
{
    const ranked *p = a;
    const ranked *q = b;
    if (p->root != q->root)
        return p->root < q->root ? -1 : 1;
    if (p->cell != q->cell)
        return p->cell < q->cell ? -1 : 1;
    return (p->number > q->number) - (p->number < q->number);
}

static tm_status wrong(const tm_leaf *leaf, size_t number, const char *what,
                       tm_error *error)
{
    return tm_fail(error, TM_ERROR_INPUT, "octant %zu (level %u at %u %u %u) %s", number,
                   leaf->level, leaf->anchor[0], leaf->anchor[1], leaf->anchor[2], what);
}

/* Each leaf by itself. */
static tm_status check_leaf(const tm_octree *octree, const tm_leaf *leaf, size_t number,
                            tm_error *error)
{
    if (leaf->level > TM_OCTREE_LEVEL_MAX)
        return wrong(leaf, number, "is too deep", error);
    const uint32_t within = ((uint32_t)1 << tm_leaf_shift(leaf)) - 1;
    for (int i = 0; i < 3; i++) {
        if (leaf->anchor[i] >> TM_OCTREE_FINEST >= octree->roots[i])
            return wrong(leaf, number, "is outside the roots", error);
        if (leaf->anchor[i] & within)
            return wrong(leaf, number, "is not where an octant of its level can be",
                         error);
    }
    return TM_OK;
}

/* Ranks of all leaves, and whether they are in order. */
static tm_status rank(const tm_octree *octree, const tm_leaf *leaf, size_t leaves,
                      ranked *at, bool *in_order, tm_error *error)
{
    *in_order = true;
    for (size_t i = 0; i < leaves; i++) {
        const tm_status status = check_leaf(octree, &leaf[i], i, error);
        if (status != TM_OK)
            return status;
        const uint32_t *anchor = leaf[i].anchor;
        const uint32_t root[3] = {anchor[0] >> TM_OCTREE_FINEST,
                                  anchor[1] >> TM_OCTREE_FINEST,
                                  anchor[2] >> TM_OCTREE_FINEST};
        at[i] = (ranked){tm_z_index(root), tm_z_index(anchor), (uint32_t)i};
        *in_order &= i == 0 || compare(&at[i - 1], &at[i]) < 0;
    }
    return TM_OK;
}

/* Sorted leaves fill the brick where each begins at the cell behind the one before it. */
static tm_status check_full(const tm_octree *octree, const tm_leaf *leaf,
                            const ranked *at, size_t leaves, tm_error *error)
{
    uint64_t next = 0, full = 0;
    for (size_t i = 0; i < leaves; i++) {
        const tm_leaf *l = &leaf[at[i].number];
        const bool same = i > 0 && at[i].root == at[i - 1].root;
        if (same && at[i].cell < next)
            return wrong(l, at[i].number, "is in another one", error);
        if (at[i].cell != (same ? next : 0) || (!same && next % tm_z_cells(0) != 0))
            return wrong(l, at[i].number, "is where octants before it are missing",
                         error);
        next = at[i].cell + tm_z_cells(l->level);
        full += next == tm_z_cells(0);
    }
    if (full != (uint64_t)octree->roots[0] * octree->roots[1] * octree->roots[2])
        return tm_fail(error, TM_ERROR_INPUT, "the octants do not fill the roots");
    return TM_OK;
}

/* The leaves in order. */
static tm_status sort(tm_leaf_list *list, const tm_octree *octree, const tm_leaf *leaf,
                      size_t leaves, uint32_t *order, tm_error *error)
{
    bool in_order = true;
    ranked *at = tm_new(leaves, sizeof *at);
    list->leaf = tm_new(leaves, sizeof *list->leaf);
    tm_status status = at && list->leaf ? rank(octree, leaf, leaves, at, &in_order, error)
                                        : tm_fail_memory(error);
    if (status == TM_OK && !in_order)
        qsort(at, leaves, sizeof *at, compare);
    if (status == TM_OK)
        status = check_full(octree, leaf, at, leaves, error);
    for (size_t i = 0; i < leaves && status == TM_OK; i++) {
        list->leaf[i] = leaf[at[i].number];
        list->leaf[i].crossed = false;
        if (order)
            order[i] = at[i].number;
    }
    list->count = list->room = leaves;
    free(at);
    return status;
}

/* No leaf is crossed yet, so balance does not ask the surface. */
static tm_status number(tm_octree *octree, tm_leaf_list *list, tm_error *error)
{
    tm_brick brick;
    tm_status status = tm_brick_of(&brick, octree, error);
    if (status == TM_OK)
        status = tm_balance(list, octree, &brick, NULL, error);
    if (status == TM_OK) {
        octree->leaf = list->leaf;
        octree->leaves = list->count;
        *list = (tm_leaf_list){.count = 0};
        status = tm_octree_number_nodes(octree, error);
    }
    tm_brick_free(&brick);
    return status;
}

tm_status tm_octree_from_leaves(tm_octree *octree, const tm_leaf *leaf, size_t leaves,
                                const tm_surface *surface, uint32_t *order,
                                tm_error *error)
{
    tm_leaf_list list = {.count = 0};
    octree->finest = TM_OCTREE_FINEST;
    if (leaves > TM_LEAVES_MAX)
        return tm_fail(error, TM_ERROR_INPUT, "%zu octants are too many (%zu)", leaves,
                       TM_LEAVES_MAX);
    tm_status status = tm_mpi_start(error);
    if (status == TM_OK)
        status = sort(&list, octree, leaf, leaves, order, error);
    if (status == TM_OK)
        status = number(octree, &list, error);
    if (status == TM_OK && octree->leaves != leaves)
        status = tm_fail(error, TM_ERROR_INPUT,
                         "the octants are not balanced: %zu, where %zu are needed",
                         leaves, octree->leaves);
    if (status == TM_OK && surface)
        status = tm_octree_cross(octree, surface, error);
    free(list.leaf);
    if (status != TM_OK)
        tm_octree_free(octree);
    return status;
}
