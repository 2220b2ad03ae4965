/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Inside by the parity of a ray: for p, the ray along axis w of the tree, up or down
 * (whichever is nearer to the end of the box), with u and v the other two axes. The point
 * is p + (δu, δv) with 0 < δv ≪ δu ≪ anything else; no edge that is seen along w runs
 * through it. */
#include "surface_tree.h"

#include "../geom/predicates.h"

typedef struct ray {
    const double *p;
    unsigned u, v, w; /* turn as x, y, z do */
    bool up;
} ray;

/* Whether the triangle, seen along w, has the moved point: the half line from it along u
 * meets an odd number of edges. An edge is met the same way for both its triangles. */
static bool is_over(const ray *r, const double corner[3][3])
{
    bool odd = false;
    const double p[2] = {r->p[r->u], r->p[r->v]};
    for (int i = 0; i < 3; i++) {
        const double *a = corner[i], *b = corner[(i + 1) % 3];
        if ((a[r->v] > p[1]) == (b[r->v] > p[1]))
            continue;
        const double *low = a[r->v] > p[1] ? b : a, *high = a[r->v] > p[1] ? a : b;
        if (low[r->u] <= p[0] && high[r->u] <= p[0])
            continue;
        const double from[2] = {low[r->u], low[r->v]};
        const double to[2] = {high[r->u], high[r->v]};
        odd ^= tm_orient2d(from, to, p) > 0;
    }
    return odd;
}

/* Whether a triangle that has the point in sight along w is on the ray. */
static bool is_ahead(const ray *r, const double corner[3][3], bool *on)
{
    int above = 0, below = 0;
    for (int i = 0; i < 3; i++) {
        above += corner[i][r->w] > r->p[r->w];
        below += corner[i][r->w] < r->p[r->w];
    }
    if (above == 3 || below == 3)
        return (above == 3) == r->up;
    double flat[3][2];
    for (int i = 0; i < 3; i++) {
        flat[i][0] = corner[i][r->u];
        flat[i][1] = corner[i][r->v];
    }
    int side = tm_orient3d(corner[0], corner[1], corner[2], r->p);
    int facing = tm_orient2d(flat[0], flat[1], flat[2]);
    *on |= side == 0;
    return (side * facing < 0) == r->up;
}

static inline bool can_meet(const ray *r, const tm_tree_node *node)
{
    const double *p = r->p;
    return node->low[r->u] <= p[r->u] && p[r->u] <= node->high[r->u] &&
           node->low[r->v] <= p[r->v] && p[r->v] <= node->high[r->v] &&
           (r->up ? p[r->w] <= node->high[r->w] : node->low[r->w] <= p[r->w]);
}

bool tm_surface_ray_is_odd(const tm_surface *surface, const double point[3], uint32_t but,
                           bool *on)
{
    const tm_surface_tree *tree = surface->tree;
    unsigned w = tree->axis;
    ray r = {point, (w + 1) % 3, (w + 2) % 3, w, false};
    r.up = surface->high[w] - point[w] < point[w] - surface->low[w];
    uint32_t stack[TM_TREE_DEPTH];
    size_t height = 0;
    bool odd = false;
    if (can_meet(&r, &tree->node[0]))
        stack[height++] = 0;
    while (height > 0) {
        const tm_tree_node *node = &tree->node[stack[--height]];
        if (node->count == 0) {
            if (can_meet(&r, &tree->node[node->first]))
                stack[height++] = node->first;
            if (can_meet(&r, &tree->node[node->first + 1]))
                stack[height++] = node->first + 1;
        }
        for (uint32_t i = 0; i < node->count; i++) {
            const tm_tree_triangle *triangle = &tree->triangle[node->first + i];
            if (but != TM_NONE && surface->shell[triangle->id] == but)
                continue;
            const double(*corner)[3] = (const double(*)[3])triangle->corner;
            if (is_over(&r, corner))
                odd ^= is_ahead(&r, corner, on);
        }
    }
    return odd;
}

bool tm_surface_has_inside(const tm_surface *surface, const double point[3])
{
    const double most = 0.5;
    bool on = false;
    for (int i = 0; i < 3; i++)
        if (!(surface->low[i] <= point[i] && point[i] <= surface->high[i]))
            return false;
    if (surface->by_winding)
        return tm_surface_winding_number(surface, point) > most;
    return tm_surface_ray_is_odd(surface, point, TM_NONE, &on);
}
