/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closest point of the surface: boxes in the order of their distance, as long as they
 * are nearer than the best triangle so far. */
#include "surface_tree.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

typedef struct waiting {
    uint32_t node;
    double distance2;
} waiting;

static void on_segment(const double a[3], const double b[3], const double p[3],
                       double closest[3])
{
    double ab[3], ap[3];
    tm_subtract(ab, b, a);
    tm_subtract(ap, p, a);
    double along = tm_dot(ap, ab), length2 = tm_norm2(ab);
    if (!(along > 0)) {
        memcpy(closest, a, sizeof ab);
    } else if (along >= length2) {
        memcpy(closest, b, sizeof ab);
    } else {
        for (int i = 0; i < 3; i++)
            closest[i] = a[i] + along / length2 * ab[i];
    }
}

static void on_edges(const double corner[3][3], const double p[3], double closest[3])
{
    double best = HUGE_VAL;
    for (int i = 0; i < 3; i++) {
        double q[3];
        on_segment(corner[i], corner[(i + 1) % 3], p, q);
        double distance2 = tm_distance2(p, q);
        if (distance2 < best) {
            best = distance2;
            memcpy(closest, q, sizeof q);
        }
    }
}

/* By the Voronoi regions of corners, edges and face (C. Ericson, Real-Time Collision
 * Detection, 2005, 5.1.5). */
static void on_triangle(const double corner[3][3], const double p[3], double closest[3])
{
    const double *a = corner[0], *b = corner[1], *c = corner[2];
    double ab[3], ac[3], ap[3], bp[3], cp[3];
    tm_subtract(ab, b, a);
    tm_subtract(ac, c, a);
    tm_subtract(ap, p, a);
    double d1 = tm_dot(ab, ap), d2 = tm_dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) {
        memcpy(closest, a, sizeof ap);
        return;
    }
    tm_subtract(bp, p, b);
    double d3 = tm_dot(ab, bp), d4 = tm_dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) {
        memcpy(closest, b, sizeof ap);
        return;
    }
    tm_subtract(cp, p, c);
    double d5 = tm_dot(ab, cp), d6 = tm_dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) {
        memcpy(closest, c, sizeof ap);
        return;
    }
    double v, w, vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        v = d1 / (d1 - d3);
        w = 0;
    } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        v = 0;
        w = d2 / (d2 - d6);
    } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        v = 1 - w;
    } else {
        double scale = 1 / (va + vb + vc);
        v = vb * scale;
        w = vc * scale;
    }
    for (int i = 0; i < 3; i++)
        closest[i] = a[i] + v * ab[i] + w * ac[i];
}

static inline double triangle_distance2(const tm_tree_triangle *triangle,
                                        const double p[3], double q[3])
{
    if (triangle->thin)
        on_edges((const double(*)[3])triangle->corner, p, q);
    else
        on_triangle((const double(*)[3])triangle->corner, p, q);
    return tm_distance2(p, q);
}

double tm_surface_triangle_distance2(const tm_surface *surface, uint32_t t,
                                     const double point[3])
{
    double q[3];
    const tm_surface_tree *tree = surface->tree;
    return triangle_distance2(&tree->triangle[tree->slot[t]], point, q);
}

double tm_corners_distance2(const double corner[3][3], const double point[3])
{
    double q[3];
    on_triangle(corner, point, q);
    return tm_distance2(point, q);
}

static inline void measure(const tm_tree_triangle *triangle, const double p[3],
                           tm_surface_point *best)
{
    double q[3];
    double distance2 = triangle_distance2(triangle, p, q);
    if (distance2 < best->distance2) {
        best->distance2 = distance2;
        best->triangle = triangle->id;
        memcpy(best->xyz, q, sizeof q);
    }
}

static void measure_leaf(const tm_surface_tree *tree, const tm_tree_node *leaf,
                         const double p[3], uint32_t patch, tm_surface_point *best)
{
    for (uint32_t i = 0; i < leaf->count; i++) {
        const tm_tree_triangle *triangle = &tree->triangle[leaf->first + i];
        if (patch == TM_NONE || triangle->patch == patch)
            measure(triangle, p, best);
    }
}

static inline bool lacks(const tm_tree_node *node, uint32_t patch)
{
    return patch != TM_NONE && node->patch != TM_NONE && node->patch != patch;
}

static void search(const tm_surface_tree *tree, const double p[3], uint32_t patch,
                   tm_surface_point *best)
{
    waiting stack[TM_TREE_DEPTH];
    size_t height = 0;
    waiting now = {0, tm_tree_box_distance2(&tree->node[0], p)};
    for (;;) {
        const tm_tree_node *node = &tree->node[now.node];
        if (now.distance2 < best->distance2 && !lacks(node, patch)) {
            if (node->count == 0) {
                waiting near = {node->first,
                                tm_tree_box_distance2(&tree->node[node->first], p)};
                waiting far = {node->first + 1,
                               tm_tree_box_distance2(&tree->node[node->first + 1], p)};
                if (far.distance2 < near.distance2) {
                    waiting swap = near;
                    near = far;
                    far = swap;
                }
                if (far.distance2 < best->distance2)
                    stack[height++] = far;
                now = near;
                continue;
            }
            measure_leaf(tree, node, p, patch, best);
        }
        if (height == 0)
            return;
        now = stack[--height];
    }
}

void tm_surface_closest(const tm_surface *surface, const double point[3], uint32_t patch,
                        tm_surface_point *at)
{
    const tm_surface_tree *tree = surface->tree;
    uint32_t guess = at->triangle;
    at->triangle = TM_NONE;
    at->distance2 = HUGE_VAL;
    if (guess < surface->triangles &&
        (patch == TM_NONE || surface->patch[guess] == patch))
        measure(&tree->triangle[tree->slot[guess]], point, at);
    search(tree, point, patch, at);
}

/* The closest point of a curve. The segments first … last - 1 of a curve have a box, and
 * so have both halves, down to a few segments; the box is at the index of the segment in
 * the middle, which no other range has for its middle. */

enum { FEW = 4 };

static void build_range(const tm_surface *surface, size_t first, size_t last)
{
    double *box = surface->tree->curve_box[first + (last - first) / 2];
    for (int i = 0; i < 3; i++) {
        box[i] = HUGE_VAL;
        box[3 + i] = -HUGE_VAL;
    }
    for (size_t s = first; s <= last; s++) {
        const double *p = surface->xyz[surface->curve_node[s]];
        for (int i = 0; i < 3; i++) {
            box[i] = fmin(box[i], p[i]);
            box[3 + i] = fmax(box[3 + i], p[i]);
        }
    }
    if (last - first <= FEW)
        return;
    size_t middle = first + (last - first) / 2;
    build_range(surface, first, middle);
    build_range(surface, middle, last);
}

tm_status tm_surface_curve_build(tm_surface *surface, tm_error *error)
{
    tm_surface_tree *tree = surface->tree;
    tree->curve_box =
        tm_new(surface->curve_start[surface->curves], sizeof *tree->curve_box);
    if (!tree->curve_box)
        return tm_fail_memory(error);
    for (size_t c = 0; c < surface->curves; c++)
        build_range(surface, surface->curve_start[c], surface->curve_start[c + 1] - 1);
    return TM_OK;
}

typedef struct search {
    const tm_surface *surface;
    const double *point;
    double *closest;
    size_t segment;
    double distance2;
} curve_search;

static double curve_box_distance2(const double box[6], const double p[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double d = fmax(fmax(box[i] - p[i], p[i] - box[3 + i]), 0);
        sum += d * d;
    }
    return sum;
}

static void measure_segment(curve_search *s, size_t segment)
{
    const double *a = s->surface->xyz[s->surface->curve_node[segment]];
    const double *b = s->surface->xyz[s->surface->curve_node[segment + 1]];
    double ab[3], ap[3], q[3];
    tm_subtract(ab, b, a);
    tm_subtract(ap, s->point, a);
    double along = tm_dot(ap, ab) / tm_norm2(ab);
    for (int i = 0; i < 3; i++)
        q[i] = along >= 1 ? b[i] : along > 0 ? a[i] + along * ab[i] : a[i];
    double distance2 = tm_distance2(s->point, q);
    if (distance2 < s->distance2) {
        s->distance2 = distance2;
        s->segment = segment;
        memcpy(s->closest, q, sizeof q);
    }
}

static void search_range(curve_search *s, size_t first, size_t last)
{
    if (last - first <= FEW) {
        for (size_t segment = first; segment < last; segment++)
            measure_segment(s, segment);
        return;
    }
    const double(*box)[6] = (const double(*)[6])s->surface->tree->curve_box;
    size_t middle = first + (last - first) / 2;
    double left = curve_box_distance2(box[first + (middle - first) / 2], s->point);
    double right = curve_box_distance2(box[middle + (last - middle) / 2], s->point);
    if (left <= right && left < s->distance2)
        search_range(s, first, middle);
    if (right < s->distance2)
        search_range(s, middle, last);
    if (left > right && left < s->distance2)
        search_range(s, first, middle);
}

void tm_surface_closest_on_curve(const tm_surface *surface, uint32_t curve,
                                 const double point[3], double closest[3],
                                 size_t *segment)
{
    size_t first = surface->curve_start[curve];
    curve_search s = {surface, point, closest, first, HUGE_VAL};
    search_range(&s, first, surface->curve_start[curve + 1] - 1);
    *segment = s.segment - first;
}
