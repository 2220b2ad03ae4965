/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "leaf_list.h"

#include "../../base/array.h"
#include "z_order.h"

#include <stdlib.h>
#include <string.h>

typedef struct checker {
    const tm_octree *octree;
    size_t points;
    uint32_t (*point)[3]; /* [points]: the corners of all leaves, each once, sorted */
    tm_error *error;
} checker;

static void position_of(const tm_leaf *leaf, int which, uint32_t point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = leaf->anchor[k] + ((uint32_t)tm_leaf_point[which][k]
                                      << (TM_OCTREE_LEVEL_MAX - leaf->level));
}

static int compare(const void *a, const void *b)
{
    const uint32_t *p = a;
    const uint32_t *q = b;
    for (int i = 0; i < 3; i++)
        if (p[i] != q[i])
            return p[i] < q[i] ? -1 : 1;
    return 0;
}

static bool is_node(const checker *c, const uint32_t point[3])
{
    return bsearch(point, c->point, c->points, sizeof *c->point, compare) != NULL;
}

static tm_status wrong(const checker *c, size_t leaf, const char *what)
{
    const tm_leaf *l = &c->octree->leaf[leaf];
    return tm_fail(c->error, TM_ERROR_INTERNAL,
                   "octree: leaf %zu (level %u at %u %u %u) %s", leaf, l->level,
                   l->anchor[0], l->anchor[1], l->anchor[2], what);
}

/* Each root is filled from its first cell of the grid to its last, without a gap, and
 * there are all of them. */
static tm_status check_order(const checker *c)
{
    const tm_octree *o = c->octree;
    const uint64_t root_cells = tm_z_cells(0);
    uint64_t next = 0;
    size_t roots = 0;
    for (size_t i = 0; i < o->leaves; i++) {
        const tm_leaf *leaf = &o->leaf[i];
        if (leaf->level > TM_OCTREE_LEVEL_MAX)
            return wrong(c, i, "is too deep");
        for (int k = 0; k < 3; k++)
            if (leaf->anchor[k] >> TM_OCTREE_FINEST >= o->roots[k])
                return wrong(c, i, "is outside the brick");
        if (i > 0 && next > 0 && !tm_z_same_root(leaf->anchor, o->leaf[i - 1].anchor))
            return wrong(c, i, "begins a root before the one before it is full");
        if (tm_z_index(leaf->anchor) != next)
            return wrong(c, i, "is not where the leaf before it ends");
        next += tm_z_cells(leaf->level);
        if (next == root_cells) {
            next = 0;
            roots++;
        }
    }
    if (next != 0 || roots != (size_t)o->roots[0] * o->roots[1] * o->roots[2])
        return wrong(c, o->leaves - 1, "is the last, but the brick is not full");
    return TM_OK;
}

/* Nodes of a leaf: all that can be at its points are, and have their numbers in order. As
 * there are as many nodes as corners of leaves, no two are at one point. */
static tm_status check_points(const checker *c, size_t i, uint32_t *next)
{
    const tm_octree *o = c->octree;
    const tm_leaf *leaf = &o->leaf[i];
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        uint32_t point[3];
        position_of(leaf, p, point);
        const uint32_t v = o->node[i][p];
        if (v == TM_NONE) {
            if (p < TM_LEAF_EDGE || is_node(c, point))
                return wrong(c, i, "lacks a node");
            continue;
        }
        if (v > *next || v >= o->nodes)
            return wrong(c, i, "has a node that is not the next");
        if (v == *next)
            (*next)++;
        if (compare(o->grid[v], point) != 0)
            return wrong(c, i, "has a node at another place");
    }
    return TM_OK;
}

/* A neighbour across a face or an edge that is smaller by two levels or more has a corner
 * at a quarter of the leaf's side. */
static tm_status check_balance(const checker *c, size_t i)
{
    enum { QUARTERS = 5 };
    const tm_leaf *leaf = &c->octree->leaf[i];
    if (leaf->level + 2 > TM_OCTREE_FINEST)
        return TM_OK;
    const unsigned quarter = TM_OCTREE_FINEST - 2 - leaf->level;
    for (uint32_t at = 0; at < QUARTERS * QUARTERS * QUARTERS; at++) {
        const uint32_t step[3] = {at % QUARTERS, at / QUARTERS % QUARTERS,
                                  at / (QUARTERS * QUARTERS)};
        bool odd = false, surface = false;
        uint32_t point[3];
        for (int k = 0; k < 3; k++) {
            odd |= step[k] % 2 == 1;
            surface |= step[k] == 0 || step[k] == QUARTERS - 1;
            point[k] = leaf->anchor[k] + (step[k] << quarter);
        }
        if (odd && surface && is_node(c, point))
            return wrong(c, i, "has a neighbour that is smaller by two levels");
    }
    return TM_OK;
}

static tm_status check_crossed(const checker *c, size_t i, const tm_surface *surface)
{
    double low[3], high[3];
    const tm_leaf *leaf = &c->octree->leaf[i];
    tm_octree_box(c->octree, leaf->anchor, tm_leaf_shift(leaf), low, high);
    if (leaf->crossed != tm_surface_meets_box(surface, low, high))
        return wrong(
            c, i, leaf->crossed ? "is not crossed" : "is crossed, but does not say so");
    return TM_OK;
}

static tm_status check_leaves(const checker *c, const tm_surface *surface)
{
    uint32_t next = 0;
    tm_status status = TM_OK;
    for (size_t i = 0; i < c->octree->leaves && status == TM_OK; i++) {
        status = check_points(c, i, &next);
        if (status == TM_OK)
            status = check_balance(c, i);
        if (status == TM_OK && surface)
            status = check_crossed(c, i, surface);
    }
    if (status == TM_OK && next != c->octree->nodes)
        status =
            tm_fail(c->error, TM_ERROR_INTERNAL, "octree: node %u is no leaf's", next);
    return status;
}

static tm_status collect_corners(checker *c)
{
    const tm_octree *o = c->octree;
    c->point = tm_new(TM_LEAF_EDGE * o->leaves, sizeof *c->point);
    if (!c->point)
        return tm_fail_memory(c->error);
    size_t count = 0;
    for (size_t i = 0; i < o->leaves; i++)
        for (int corner = 0; corner < TM_LEAF_EDGE; corner++, count++)
            position_of(&o->leaf[i], corner, c->point[count]);
    qsort(c->point, count, sizeof *c->point, compare);
    for (size_t p = 0; p < count; p++)
        if (p == 0 || compare(c->point[p], c->point[c->points - 1]) != 0)
            memmove(c->point[c->points++], c->point[p], sizeof *c->point);
    return TM_OK;
}

tm_status tm_octree_check(const tm_octree *octree, const tm_surface *surface,
                          tm_error *error)
{
    checker c = {.octree = octree, .error = error};
    if (octree->leaves == 0)
        return tm_fail(error, TM_ERROR_INTERNAL, "octree: it is empty");
    tm_status status = check_order(&c);
    if (status == TM_OK)
        status = collect_corners(&c);
    if (status == TM_OK && c.points != octree->nodes)
        status = tm_fail(error, TM_ERROR_INTERNAL,
                         "octree: there are %zu nodes, but leaves have %zu corners",
                         octree->nodes, c.points);
    if (status == TM_OK)
        status = check_leaves(&c, surface);
    free(c.point);
    return status;
}
