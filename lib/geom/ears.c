/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ears.h"

#include "predicates.h"
#include "vector.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

typedef struct polygon {
    const double (*xyz)[3];
    uint32_t *node;
    size_t k;
    unsigned u, v; /* the axes of the plane, so that the polygon turns to the left */
} polygon;

/* Newell's normal: twice the areas of the three projections. */
static void find_plane(polygon *p)
{
    double normal[3] = {0};
    for (size_t i = 0; i < p->k; i++) {
        double a[3], b[3], cross[3];
        const double *origin = p->xyz[p->node[0]];
        tm_subtract(a, p->xyz[p->node[i]], origin);
        tm_subtract(b, p->xyz[p->node[i + 1 < p->k ? i + 1 : 0]], origin);
        tm_cross(cross, a, b);
        for (int c = 0; c < 3; c++)
            normal[c] += cross[c];
    }
    unsigned w = 0;
    for (unsigned c = 1; c < 3; c++)
        if (fabs(normal[c]) > fabs(normal[w]))
            w = c;
    p->u = (w + (normal[w] < 0 ? 2 : 1)) % 3;
    p->v = 3 - w - p->u;
}

static int turn(const polygon *p, size_t i, size_t j, size_t k)
{
    const double *a = p->xyz[p->node[i]], *b = p->xyz[p->node[j]];
    const double *c = p->xyz[p->node[k]];
    const double pa[2] = {a[p->u], a[p->v]}, pb[2] = {b[p->u], b[p->v]};
    const double pc[2] = {c[p->u], c[p->v]};
    return tm_orient2d(pa, pb, pc);
}

static size_t before(const polygon *p, size_t i)
{
    return i > 0 ? i - 1 : p->k - 1;
}

static size_t after(const polygon *p, size_t i)
{
    return i + 1 < p->k ? i + 1 : 0;
}

/* Nodes of one place are one, as on both sides of a slit. */
static bool is_same(const polygon *p, size_t i, size_t j)
{
    const double *a = p->xyz[p->node[i]], *b = p->xyz[p->node[j]];
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Whether no corner that could be is in the closed triangle at corner i. */
static bool is_ear(const polygon *p, size_t i)
{
    size_t h = before(p, i), j = after(p, i);
    if (turn(p, h, i, j) <= 0)
        return false;
    for (size_t n = after(p, j); n != h; n = after(p, n)) {
        if (is_same(p, n, h) || is_same(p, n, i) || is_same(p, n, j))
            continue;
        if (turn(p, h, i, n) >= 0 && turn(p, i, j, n) >= 0 && turn(p, j, h, n) >= 0)
            return false;
    }
    return true;
}

/* The corner to cut off: the ear with the shortest diagonal; of a polygon without an ear,
 * which crosses itself or is flat, the corner with the shortest diagonal. */
static size_t find_ear(const polygon *p)
{
    size_t best = 0, any = 0;
    double shortest = HUGE_VAL, any_shortest = HUGE_VAL;
    for (size_t i = 0; i < p->k; i++) {
        double length2 =
            tm_distance2(p->xyz[p->node[before(p, i)]], p->xyz[p->node[after(p, i)]]);
        if (length2 < any_shortest) {
            any_shortest = length2;
            any = i;
        }
        if (length2 < shortest && is_ear(p, i)) {
            shortest = length2;
            best = i;
        }
    }
    return shortest < HUGE_VAL ? best : any;
}

/* Without corners that are the node before again. */
static size_t copy_corners(const uint32_t *node, size_t k, uint32_t *to)
{
    size_t count = 0;
    for (size_t i = 0; i < k; i++)
        if (count == 0 || to[count - 1] != node[i])
            to[count++] = node[i];
    while (count > 1 && to[count - 1] == to[0])
        count--;
    return count;
}

size_t tm_cut_ears(const double (*xyz)[3], const uint32_t *node, size_t k,
                   uint32_t *aside, uint32_t (*triangle)[3])
{
    polygon p = {.xyz = xyz, .node = aside, .k = copy_corners(node, k, aside)};
    size_t count = 0;
    if (p.k > 3)
        find_plane(&p);
    while (p.k >= 3) {
        size_t i = p.k > 3 ? find_ear(&p) : 1;
        triangle[count][0] = p.node[before(&p, i)];
        triangle[count][1] = p.node[i];
        triangle[count++][2] = p.node[after(&p, i)];
        p.k--;
        memmove(p.node + i, p.node + i + 1, (p.k - i) * sizeof *p.node);
    }
    return count;
}
