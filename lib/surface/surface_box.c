/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether triangles meet a box: they do not where one of 13 axes separates both, the
 * normals of box and triangle and the products of their edges (T. Akenine-Möller, Fast
 * 3D triangle-box overlap testing, Journal of Graphics Tools 6, 2001). Every comparison
 * leaves room for its rounding: "yes" may be wrong by that, "no" is right. */
#include "surface_tree.h"

#include "../geom/vector.h"

#include <math.h>

/* Above all roundings of one axis, per size of what is summed. */
static const double rounding = 0x1p-49;

typedef struct cube {
    const double *low, *high;
    double centre[3], half[3];
} cube;

static cube make_cube(const double low[3], const double high[3])
{
    cube c = {.low = low, .high = high};
    for (int i = 0; i < 3; i++) {
        c.centre[i] = low[i] / 2 + high[i] / 2;
        c.half[i] =
            (high[i] / 2 - low[i] / 2) + rounding * fmax(fabs(low[i]), fabs(high[i]));
    }
    return c;
}

/* The axes edge × unit vector, for one edge of a triangle, whose corners p and q (one of
 * the edge, and the one opposite) are relative to the centre. */
static inline bool edge_separates(const cube *c, const double e[3], const double p[3],
                                  const double q[3], double size)
{
    for (int i = 0; i < 3; i++) {
        int j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
        double sp = e[k] * p[j] - e[j] * p[k];
        double sq = e[k] * q[j] - e[j] * q[k];
        double ej = fabs(e[j]), ek = fabs(e[k]);
        double reach = ek * c->half[j] + ej * c->half[k] + rounding * size * (ej + ek);
        double low = sp < sq ? sp : sq, high = sp < sq ? sq : sp;
        if (low > reach || high < -reach)
            return true;
    }
    return false;
}

static bool meets(const cube *c, const double corner[3][3])
{
    bool within[3] = {true, true, true};
    for (int i = 0; i < 3; i++) {
        double a = corner[0][i], b = corner[1][i], d = corner[2][i];
        if ((a < c->low[i] && b < c->low[i] && d < c->low[i]) ||
            (a > c->high[i] && b > c->high[i] && d > c->high[i]))
            return false;
        within[0] &= c->low[i] <= a && a <= c->high[i];
        within[1] &= c->low[i] <= b && b <= c->high[i];
        within[2] &= c->low[i] <= d && d <= c->high[i];
    }
    if (within[0] || within[1] || within[2])
        return true;
    double p[3][3], e[3][3], normal[3], size = 0;
    for (int k = 0; k < 3; k++)
        tm_subtract(p[k], corner[k], c->centre);
    for (int k = 0; k < 3; k++) {
        tm_subtract(e[k], corner[k == 2 ? 0 : k + 1], corner[k]);
        size = fmax(size, fmax(fabs(p[k][0]), fmax(fabs(p[k][1]), fabs(p[k][2]))));
    }
    tm_cross(normal, e[0], e[1]);
    double n0 = fabs(normal[0]), n1 = fabs(normal[1]), n2 = fabs(normal[2]);
    double edges = (fabs(e[0][0]) + fabs(e[0][1]) + fabs(e[0][2])) *
                   (fabs(e[1][0]) + fabs(e[1][1]) + fabs(e[1][2]));
    double reach =
        n0 * c->half[0] + n1 * c->half[1] + n2 * c->half[2] + rounding * size * edges;
    if (fabs(tm_dot(normal, p[0])) > reach)
        return false;
    return !edge_separates(c, e[0], p[0], p[2], size) &&
           !edge_separates(c, e[1], p[1], p[0], size) &&
           !edge_separates(c, e[2], p[2], p[1], size);
}

static inline bool overlaps(const tm_tree_node *node, const double low[3],
                            const double high[3])
{
    return node->low[0] <= high[0] && low[0] <= node->high[0] &&
           node->low[1] <= high[1] && low[1] <= node->high[1] &&
           node->low[2] <= high[2] && low[2] <= node->high[2];
}

bool tm_surface_meets_box(const tm_surface *surface, const double low[3],
                          const double high[3])
{
    const tm_surface_tree *tree = surface->tree;
    cube c = make_cube(low, high);
    uint32_t stack[TM_TREE_DEPTH];
    size_t height = 0;
    if (overlaps(&tree->node[0], low, high))
        stack[height++] = 0;
    while (height > 0) {
        const tm_tree_node *node = &tree->node[stack[--height]];
        if (node->count == 0) {
            if (overlaps(&tree->node[node->first + 1], low, high))
                stack[height++] = node->first + 1;
            if (overlaps(&tree->node[node->first], low, high))
                stack[height++] = node->first;
        }
        for (uint32_t i = 0; i < node->count; i++)
            if (meets(&c, (const double(*)[3])tree->triangle[node->first + i].corner))
                return true;
    }
    return false;
}

size_t tm_surface_cull(const tm_surface *surface, const uint32_t *list, size_t count,
                       const double low[3], const double high[3], uint32_t *kept)
{
    const tm_surface_tree *tree = surface->tree;
    cube c = make_cube(low, high);
    size_t number = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t t = list[i];
        const tm_tree_triangle *triangle = &tree->triangle[tree->place[t]];
        if (meets(&c, (const double(*)[3])triangle->corner))
            kept[number++] = t;
    }
    return number;
}
