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

/* Leaves on their way into an octree. */
typedef struct maker {
    tm_octree *octree;
    const tm_leaf *leaf;
    size_t leaves;
    ranked *at; /* the same leaves in order */
    tm_leaf_list list;
    tm_error *error;
} maker;

static tm_status sort(maker *m)
{
    bool in_order = true;
    m->at = tm_new(m->leaves, sizeof *m->at);
    const tm_status status =
        m->at ? rank(m->octree, m->leaf, m->leaves, m->at, &in_order, m->error)
              : tm_fail_memory(m->error);
    if (status == TM_OK && !in_order)
        qsort(m->at, m->leaves, sizeof *m->at, compare);
    return status;
}

/* Appends leaves of a root between two of its cells, each as large as it can be. */
static tm_status fill(maker *m, const uint32_t root[3], uint64_t from, uint64_t to)
{
    tm_status status = TM_OK;
    while (from < to && status == TM_OK) {
        unsigned level = TM_OCTREE_FINEST;
        while (level > 0 && from % tm_z_cells(level - 1) == 0 &&
               from + tm_z_cells(level - 1) <= to)
            level--;
        uint32_t anchor[3];
        tm_z_point(from, anchor);
        for (int i = 0; i < 3; i++)
            anchor[i] += root[i] << TM_OCTREE_FINEST;
        status = tm_leaf_list_add(&m->list, anchor, level, false, m->error);
        from += tm_z_cells(level);
    }
    return status;
}

/* Appends the leaves that are in a root, from *next on, and what they leave of it. */
static tm_status add_root(maker *m, const uint32_t root[3], size_t *next)
{
    const uint64_t rank = tm_z_index(root);
    uint64_t cell = 0;
    tm_status status = TM_OK;
    for (; *next < m->leaves && m->at[*next].root == rank && status == TM_OK; ++*next) {
        const ranked *at = &m->at[*next];
        const tm_leaf *l = &m->leaf[at->number];
        if (at->cell < cell)
            return wrong(l, at->number, "is in another one", m->error);
        status = fill(m, root, cell, at->cell);
        if (status == TM_OK)
            status = tm_leaf_list_add(&m->list, l->anchor, l->level, false, m->error);
        cell = at->cell + tm_z_cells(l->level);
    }
    return status == TM_OK ? fill(m, root, cell, tm_z_cells(0)) : status;
}

/* No leaf is crossed yet, so balance does not ask the surface. */
static tm_status fill_brick(maker *m)
{
    tm_brick brick;
    size_t next = 0;
    tm_status status = tm_brick_of(&brick, m->octree, m->error);
    for (size_t r = 0; status == TM_OK && r < brick.count; r++)
        status = add_root(m, brick.root[r], &next);
    if (status == TM_OK)
        status = tm_balance(&m->list, m->octree, NULL, NULL, m->error);
    tm_brick_free(&brick);
    if (status != TM_OK)
        return status;
    m->octree->leaf = m->list.leaf;
    m->octree->leaves = m->list.count;
    m->list = (tm_leaf_list){.count = 0};
    return tm_octree_number_nodes(m->octree, m->error);
}

/* Which one of the leaves that were given each leaf is: all must be there still. */
static tm_status find_order(const maker *m, const tm_octree *octree, uint32_t **order)
{
    size_t next = 0;
    free(*order);
    *order = tm_new(octree->leaves, sizeof **order);
    if (!*order)
        return tm_fail_memory(m->error);
    for (size_t i = 0; i < octree->leaves; i++) {
        const tm_leaf *now = &octree->leaf[i];
        const tm_leaf *given = next < m->leaves ? &m->leaf[m->at[next].number] : NULL;
        const bool is_given = given && now->level == given->level &&
                              memcmp(now->anchor, given->anchor, sizeof now->anchor) == 0;
        (*order)[i] = is_given ? m->at[next].number : TM_NONE;
        next += is_given;
    }
    if (next == m->leaves)
        return TM_OK;
    const uint32_t number = m->at[next].number;
    return wrong(&m->leaf[number], number,
                 "is too large beside another one: they are not balanced", m->error);
}

/* Marks leaves that were not given, are crossed, and larger than any that was given and
 * is crossed; returns how many. */
static size_t mark_coarse(const tm_octree *octree, const uint32_t *order, uint8_t *marked)
{
    unsigned coarsest = TM_OCTREE_FINEST;
    size_t count = 0;
    for (size_t i = 0; i < octree->leaves; i++)
        if (order[i] != TM_NONE && octree->leaf[i].crossed &&
            octree->leaf[i].level < coarsest)
            coarsest = octree->leaf[i].level;
    for (size_t i = 0; i < octree->leaves && coarsest < TM_OCTREE_FINEST; i++) {
        marked[i] = order[i] == TM_NONE && octree->leaf[i].crossed &&
                    octree->leaf[i].level < coarsest;
        count += marked[i];
    }
    return count;
}

/* Splits those once, unless one that was given would have to be split, too. */
static tm_status split_coarse(const maker *m, const tm_surface *surface,
                              const uint8_t *marked, uint32_t **order, bool *done)
{
    tm_octree finer;
    tm_error cause;
    tm_status status = tm_octree_copy(&finer, m->octree, m->error);
    if (status == TM_OK)
        status = tm_octree_refine(&finer, surface, marked, m->error);
    const maker quiet = {
        .leaf = m->leaf, .leaves = m->leaves, .at = m->at, .error = &cause};
    if (status == TM_OK)
        status = find_order(&quiet, &finer, order);
    if (status == TM_OK) {
        const tm_octree old = *m->octree;
        *m->octree = finer;
        finer = old;
    } else if (status == TM_ERROR_INPUT) {
        *done = true;
        status = find_order(m, m->octree, order);
    }
    tm_octree_free(&finer);
    return status;
}

/* The surface is met by leaves of some size: those that were not given are not larger. */
static tm_status split_all_coarse(const maker *m, const tm_surface *surface,
                                  uint32_t **order)
{
    tm_status status = TM_OK;
    for (bool done = false; !done && status == TM_OK;) {
        uint8_t *marked = calloc(m->octree->leaves + 1, 1);
        if (!marked)
            return tm_fail_memory(m->error);
        done = mark_coarse(m->octree, *order, marked) == 0;
        if (!done)
            status = split_coarse(m, surface, marked, order, &done);
        free(marked);
    }
    return status;
}

tm_status tm_octree_from_leaves(tm_octree *octree, const tm_leaf *leaf, size_t leaves,
                                const tm_surface *surface, uint32_t **order,
                                tm_error *error)
{
    maker m = {.octree = octree, .leaf = leaf, .leaves = leaves, .error = error};
    octree->finest = TM_OCTREE_FINEST;
    *order = NULL;
    if (leaves == 0)
        return tm_fail(error, TM_ERROR_INPUT, "there are no octants");
    if (leaves > TM_LEAVES_MAX)
        return tm_fail(error, TM_ERROR_INPUT, "%zu octants are too many (%zu)", leaves,
                       TM_LEAVES_MAX);
    tm_status status = tm_mpi_start(error);
    if (status == TM_OK)
        status = sort(&m);
    if (status == TM_OK)
        status = fill_brick(&m);
    if (status == TM_OK)
        status = find_order(&m, octree, order);
    if (status == TM_OK && surface)
        status = tm_octree_cross(octree, surface, error);
    if (status == TM_OK && surface && octree->leaves > leaves)
        status = split_all_coarse(&m, surface, order);
    free(m.at);
    free(m.list.leaf);
    if (status != TM_OK) {
        tm_octree_free(octree);
        free(*order);
        *order = NULL;
    }
    return status;
}
