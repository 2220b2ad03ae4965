/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_apart.h"

#include "../base/array.h"
#include "../geom/space_order.h"
#include "surface_crossings.h"
#include "surface_parts.h"

#include <stdlib.h>

typedef struct box {
    double low[3], high[3];
} box;

enum { LEAF = 4, LEVELS = 33 };

/* Triangles in their order, boxes of LEAF of them, and above these boxes of two each. */
typedef struct boxes {
    const double (*xyz)[3];
    const uint32_t (*triangle)[3];
    size_t triangles;
    tm_curve_point *order;
    box *of;                            /* [triangles]: in that order */
    box *node;                          /* of all levels, the lowest first */
    size_t level[LEVELS], size[LEVELS]; /* the first node of a level, and how many */
    int levels;
} boxes;

static box box_of(const boxes *b, const uint32_t v[3])
{
    box made;
    for (int x = 0; x < 3; x++) {
        const double p = b->xyz[v[0]][x], q = b->xyz[v[1]][x], r = b->xyz[v[2]][x];
        made.low[x] = p < q ? (p < r ? p : r) : (q < r ? q : r);
        made.high[x] = p > q ? (p > r ? p : r) : (q > r ? q : r);
    }
    return made;
}

static void put_in(box *to, const box *more)
{
    for (int x = 0; x < 3; x++) {
        if (more->low[x] < to->low[x])
            to->low[x] = more->low[x];
        if (more->high[x] > to->high[x])
            to->high[x] = more->high[x];
    }
}

static bool meet(const box *a, const box *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] &&
           a->low[1] <= b->high[1] && b->low[1] <= a->high[1] &&
           a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

/* By the middles of the triangles' boxes. */
static bool sort_triangles(boxes *b, size_t nodes)
{
    const tm_space space = tm_space_around(b->xyz, nodes);
    for (size_t t = 0; t < b->triangles; t++) {
        const box of = box_of(b, b->triangle[t]);
        double middle[3];
        for (int x = 0; x < 3; x++)
            middle[x] = of.low[x] / 2 + of.high[x] / 2;
        b->order[t] = (tm_curve_point){tm_space_position(&space, middle), (uint32_t)t};
    }
    return tm_space_sort(b->order, b->triangles, 1);
}

static void make_level(boxes *b, int level, const box *below, size_t count, size_t each)
{
    box *node = b->node + b->level[level];
    for (size_t i = 0; i < count; i++) {
        if (i % each == 0)
            node[i / each] = below[i];
        else
            put_in(&node[i / each], &below[i]);
    }
}

static void make_levels(boxes *b)
{
    for (size_t i = 0; i < b->triangles; i++)
        b->of[i] = box_of(b, b->triangle[b->order[i].item]);
    make_level(b, 0, b->of, b->triangles, LEAF);
    for (int k = 1; k < b->levels; k++)
        make_level(b, k, b->node + b->level[k - 1], b->size[k - 1], 2);
}

static bool allocate(boxes *b)
{
    size_t nodes = 0;
    for (size_t size = (b->triangles + LEAF - 1) / LEAF;; size = (size + 1) / 2) {
        b->level[b->levels] = nodes;
        b->size[b->levels++] = size;
        nodes += size;
        if (size <= 1)
            break;
    }
    b->order = tm_new(b->triangles, sizeof *b->order);
    b->of = tm_new(b->triangles, sizeof *b->of);
    b->node = tm_new(nodes, sizeof *b->node);
    return b->order && b->of && b->node;
}

static bool leaves_are_apart(const boxes *b, size_t n, size_t m)
{
    const size_t end_n = LEAF * (n + 1) < b->triangles ? LEAF * (n + 1) : b->triangles;
    const size_t end_m = LEAF * (m + 1) < b->triangles ? LEAF * (m + 1) : b->triangles;
    for (size_t i = LEAF * n; i < end_n; i++) {
        if (n != m && !meet(&b->of[i], &b->node[m]))
            continue;
        for (size_t k = n == m ? i + 1 : LEAF * m; k < end_m; k++)
            if (meet(&b->of[i], &b->of[k]) &&
                tm_triangles_meet(b->xyz, b->triangle[b->order[i].item],
                                  b->triangle[b->order[k].item]))
                return false;
    }
    return true;
}

/* All pairs of a triangle below node n of a level with one below m >= n. */
static bool nodes_are_apart(const boxes *b, int level, size_t n, size_t m)
{
    const box *node = b->node + b->level[level];
    if (n != m && !meet(&node[n], &node[m]))
        return true;
    if (level == 0)
        return leaves_are_apart(b, n, m);
    const size_t below = b->size[level - 1];
    for (size_t i = 2 * n; i < 2 * n + 2 && i < below; i++)
        for (size_t k = n == m ? i : 2 * m; k < 2 * m + 2 && k < below; k++)
            if (!nodes_are_apart(b, level - 1, i, k))
                return false;
    return true;
}

static bool all_have_areas(const boxes *b)
{
    for (size_t t = 0; t < b->triangles; t++) {
        const uint32_t *v = b->triangle[t];
        if (tm_is_flat(b->xyz[v[0]], b->xyz[v[1]], b->xyz[v[2]]))
            return false;
    }
    return true;
}

tm_status tm_triangles_are_apart(const double (*xyz)[3], size_t nodes,
                                 const uint32_t (*triangle)[3], size_t triangles,
                                 bool *apart, tm_error *error)
{
    boxes b = {.xyz = xyz, .triangle = triangle, .triangles = triangles};
    *apart = true;
    if (triangles == 0)
        return TM_OK;
    const bool done = allocate(&b) && sort_triangles(&b, nodes);
    if (done) {
        make_levels(&b);
        *apart = all_have_areas(&b) && nodes_are_apart(&b, b.levels - 1, 0, 0);
    }
    free(b.order);
    free(b.of);
    free(b.node);
    return done ? TM_OK : tm_fail_memory(error);
}
