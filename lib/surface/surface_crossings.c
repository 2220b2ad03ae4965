/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles that meet elsewhere than in a common node or edge, by exact orientations. */
#include "surface_crossings.h"

#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "surface_parts.h"
#include "surface_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct finder {
    const tm_surface *surface;
    size_t found;
    tm_crossing first; /* that was found */
    bool all;          /* else the first is enough */
    tm_crossing *list; /* of all, where it is wanted */
    size_t room;
    bool listing, failed;
} finder;

static int sign_in(const double a[3], const double b[3], const double c[3], unsigned w)
{
    unsigned u = (w + 1) % 3, v = (w + 2) % 3;
    const double pa[2] = {a[u], a[v]}, pb[2] = {b[u], b[v]}, pc[2] = {c[u], c[v]};
    return tm_orient2d(pa, pb, pc);
}

/* In one plane, seen along w: whether segments pq and ab, on no common line, meet. */
static bool segments_meet(const double p[3], const double q[3], const double a[3],
                          const double b[3], unsigned w)
{
    int pa = sign_in(p, q, a, w), pb = sign_in(p, q, b, w);
    int ap = sign_in(a, b, p, w), aq = sign_in(a, b, q, w);
    return pa * pb <= 0 && ap * aq <= 0 && (pa != 0 || pb != 0);
}

static bool is_within(const double p[3], const double *const corner[3], unsigned w)
{
    int i = sign_in(corner[0], corner[1], p, w), j = sign_in(corner[1], corner[2], p, w);
    int k = sign_in(corner[2], corner[0], p, w);
    return (i >= 0 && j >= 0 && k >= 0) || (i <= 0 && j <= 0 && k <= 0);
}

/* A segment on an edge's line that meets the edge has an end in it, or goes on to meet
 * another edge, or the edge's ends are within the segment: then it meets those edges. */
static bool meets_in_plane(const double p[3], const double q[3],
                           const double *const corner[3])
{
    unsigned w = 0;
    while (w < 3 && sign_in(corner[0], corner[1], corner[2], w) == 0)
        w++;
    if (w == 3)
        return false; /* flat: its edges meet what it meets */
    if (is_within(p, corner, w) || is_within(q, corner, w))
        return true;
    for (int i = 0; i < 3; i++)
        if (segments_meet(p, q, corner[i], corner[(i + 1) % 3], w))
            return true;
    return false;
}

/* Whether the closed segment pq meets the closed triangle. */
static bool segment_meets(const double p[3], const double q[3],
                          const double *const corner[3])
{
    const double *a = corner[0], *b = corner[1], *c = corner[2];
    int sp = tm_orient3d(a, b, c, p), sq = tm_orient3d(a, b, c, q);
    if (sp * sq > 0)
        return false;
    if (sp == 0 && sq == 0)
        return meets_in_plane(p, q, corner);
    int i = tm_orient3d(p, q, a, b), j = tm_orient3d(p, q, b, c);
    int k = tm_orient3d(p, q, c, a);
    return (i >= 0 && j >= 0 && k >= 0) || (i <= 0 && j <= 0 && k <= 0);
}

/* Whether the corners of one triangle are all strictly on one side of the other. */
static bool is_beside(const double *const p[3], const double *const q[3])
{
    int side = tm_orient3d(p[0], p[1], p[2], q[0]);
    return side != 0 && tm_orient3d(p[0], p[1], p[2], q[1]) == side &&
           tm_orient3d(p[0], p[1], p[2], q[2]) == side;
}

/* Most triangles that are near each other are plainly apart. In one plane the exact
 * orientations are all zero and cost most, so first a plane is looked for that is between
 * them by more than rounding. */
static const double margin = 1e-9; /* of lengths */

/* Whether all of p are on one side, and all of q on the other, of a plane across d. */
static bool is_between(const double d[3], const double *const *p, const double *const *q)
{
    double most = -HUGE_VAL, least = HUGE_VAL, size = 0;
    for (int i = 0; i < 3; i++) {
        double a = tm_dot(d, p[i]), b = tm_dot(d, q[i]);
        most = a > most ? a : most;
        least = b < least ? b : least;
        size = fmax(size, fmax(tm_norm2(p[i]), tm_norm2(q[i])));
    }
    return least - most > margin * tm_norm(d) * sqrt(size);
}

static bool strangers_are_apart(const double *const p[3], const double *const q[3])
{
    double d[3], normal[3], side[3];
    for (int x = 0; x < 3; x++)
        d[x] = q[0][x] - p[0][x] + q[1][x] - p[1][x] + q[2][x] - p[2][x];
    if (is_between(d, p, q))
        return true;
    tm_triangle_normal(normal, p[0], p[1], p[2]);
    for (int i = 0; i < 3; i++) {
        tm_subtract(side, p[(i + 1) % 3], p[i]);
        tm_cross(d, side, normal);
        if (is_between(d, p, q))
            return true;
        tm_subtract(side, q[(i + 1) % 3], q[i]);
        tm_cross(d, normal, side);
        if (is_between(d, p, q))
            return true;
        for (int x = 0; x < 3; x++)
            d[x] = -d[x];
        if (is_between(d, p, q))
            return true;
    }
    return false;
}

/* The direction from x to y. */
static void direction(const double x[3], const double y[3], double unit[3])
{
    tm_subtract(unit, y, x);
    double length = tm_norm(unit);
    for (int i = 0; i < 3; i++)
        unit[i] /= length;
}

/* The same of edges from one corner, not made as long as each other: that takes no roots,
 * and is enough for most. */
static bool edges_are_apart(const double of_p[2][3], const double of_q[2][3])
{
    const double least = margin * margin;
    double d[3];
    for (int x = 0; x < 3; x++)
        d[x] = of_p[0][x] + of_p[1][x] - of_q[0][x] - of_q[1][x];
    const double norm2 = tm_norm2(d);
    for (int s = 0; s < 2; s++) {
        const double p = tm_dot(d, of_p[s]), q = -tm_dot(d, of_q[s]);
        if (!(p > 0 && p * p > least * norm2 * tm_norm2(of_p[s]) && q > 0 &&
              q * q > least * norm2 * tm_norm2(of_q[s])))
            return false;
    }
    return true;
}

/* Corner i of p is corner k of q: whether a plane through it is between what is left. */
static bool corners_are_apart(const double *const p[3], int i, const double *const q[3],
                              int k)
{
    double of_p[2][3], of_q[2][3], d[3];
    for (int s = 0; s < 2; s++) {
        tm_subtract(of_p[s], p[(i + 1 + s) % 3], p[i]);
        tm_subtract(of_q[s], q[(k + 1 + s) % 3], q[k]);
    }
    if (edges_are_apart((const double(*)[3])of_p, (const double(*)[3])of_q))
        return true;
    for (int s = 0; s < 2; s++) {
        direction(p[i], p[(i + 1 + s) % 3], of_p[s]);
        direction(q[k], q[(k + 1 + s) % 3], of_q[s]);
    }
    for (int x = 0; x < 3; x++)
        d[x] = of_p[0][x] + of_p[1][x] - of_q[0][x] - of_q[1][x];
    return tm_dot(d, of_p[0]) > margin && tm_dot(d, of_p[1]) > margin &&
           tm_dot(d, of_q[0]) < -margin && tm_dot(d, of_q[1]) < -margin;
}

/* Neither has a node of the other. */
static bool strangers_meet(const double *const p[3], const double *const q[3])
{
    if (strangers_are_apart(p, q) || is_beside(p, q) || is_beside(q, p))
        return false;
    for (int i = 0; i < 3; i++)
        if (segment_meets(p[i], p[(i + 1) % 3], q) ||
            segment_meets(q[i], q[(i + 1) % 3], p))
            return true;
    return false;
}

/* Corner i of p is corner k of q. What they have in common is convex: if it is more than
 * the node, it reaches the opposite edge of one of them. */
static bool corners_meet(const double *const p[3], int i, const double *const q[3], int k)
{
    if (corners_are_apart(p, i, q, k))
        return false;
    return segment_meets(p[(i + 1) % 3], p[(i + 2) % 3], q) ||
           segment_meets(q[(k + 1) % 3], q[(k + 2) % 3], p);
}

/* They have all but corner i of p and k of q in common: they meet elsewhere where one is
 * folded onto the other. */
static bool edges_meet(const double *const p[3], int i, const double *const q[3], int k)
{
    const double *a = p[(i + 1) % 3], *b = p[(i + 2) % 3];
    double of_p[3], of_q[3];
    tm_triangle_normal(of_p, a, b, p[i]);
    tm_triangle_normal(of_q, a, b, q[k]);
    if (tm_dot(of_p, of_q) < 0) /* one is beyond the edge from the other */
        return false;
    if (tm_orient3d(a, b, p[i], q[k]) != 0)
        return false;
    for (unsigned w = 0; w < 3; w++)
        if (sign_in(a, b, p[i], w) * sign_in(a, b, q[k], w) > 0)
            return true;
    return false;
}

bool tm_triangles_meet(const double (*xyz)[3], const uint32_t vt[3], const uint32_t vs[3])
{
    const double *p[3], *q[3];
    int common = 0, i_common = 0, k_common = 0, i_sum = 0, k_sum = 0;
    for (int i = 0; i < 3; i++) {
        p[i] = xyz[vt[i]];
        q[i] = xyz[vs[i]];
        for (int k = 0; k < 3; k++) {
            if (vt[i] != vs[k])
                continue;
            common++;
            i_common = i;
            k_common = k;
            i_sum += i;
            k_sum += k;
        }
    }
    if (common == 0)
        return strangers_meet(p, q);
    if (common == 1)
        return corners_meet(p, i_common, q, k_common);
    return common == 3 || edges_meet(p, 3 - i_sum, q, 3 - k_sum);
}

static bool boxes_meet(const double alow[3], const double ahigh[3], const double blow[3],
                       const double bhigh[3])
{
    return alow[0] <= bhigh[0] && blow[0] <= ahigh[0] && alow[1] <= bhigh[1] &&
           blow[1] <= ahigh[1] && alow[2] <= bhigh[2] && blow[2] <= ahigh[2];
}

static void bounds_of(const tm_tree_triangle *triangle, double low[3], double high[3])
{
    for (int i = 0; i < 3; i++) {
        double a = triangle->corner[0][i], b = triangle->corner[1][i];
        double c = triangle->corner[2][i];
        low[i] = a < b ? (a < c ? a : c) : (b < c ? b : c);
        high[i] = a > b ? (a > c ? a : c) : (b > c ? b : c);
    }
}

/* Somewhere in both boxes. */
static tm_crossing crossing_of(const tm_tree_triangle *a, const tm_tree_triangle *b)
{
    double low[2][3], high[2][3];
    tm_crossing found;
    bounds_of(a, low[0], high[0]);
    bounds_of(b, low[1], high[1]);
    for (int i = 0; i < 3; i++)
        found.point[i] = (fmax(low[0][i], low[1][i]) + fmin(high[0][i], high[1][i])) / 2;
    found.triangle[0] = a->id < b->id ? a->id : b->id;
    found.triangle[1] = a->id < b->id ? b->id : a->id;
    return found;
}

static void add_to_list(finder *f, tm_crossing found)
{
    if (f->found == f->room) {
        const size_t room = 2 * f->room + 16;
        tm_crossing *more = realloc(f->list, room * sizeof *more);
        f->failed |= !more;
        if (!more)
            return;
        f->list = more;
        f->room = room;
    }
    f->list[f->found] = found;
}

static void try_pair(finder *f, const tm_tree_triangle *a, const tm_tree_triangle *b)
{
    const tm_surface *surface = f->surface;
    double alow[3], ahigh[3], blow[3], bhigh[3];
    bounds_of(a, alow, ahigh);
    bounds_of(b, blow, bhigh);
    if (!boxes_meet(alow, ahigh, blow, bhigh) ||
        !tm_triangles_meet((const double(*)[3])surface->xyz, surface->triangle[a->id],
                           surface->triangle[b->id]))
        return;
    if (f->found == 0)
        f->first = crossing_of(a, b);
    if (f->listing)
        add_to_list(f, crossing_of(a, b));
    f->found++;
}

static void try_leaves(finder *f, const tm_tree_node *n, const tm_tree_node *m)
{
    const tm_tree_triangle *triangle = f->surface->tree->triangle;
    for (uint32_t i = 0; i < n->count; i++)
        for (uint32_t k = n == m ? i + 1 : 0; k < m->count; k++)
            try_pair(f, &triangle[n->first + i], &triangle[m->first + k]);
}

/* All pairs of a triangle below n with one below m. */
static void try_nodes(finder *f, const tm_tree_node *n, const tm_tree_node *m)
{
    const tm_tree_node *node = f->surface->tree->node;
    if (!boxes_meet(n->low, n->high, m->low, m->high) || (!f->all && f->found > 0) ||
        f->failed)
        return;
    if (n->count > 0 && m->count > 0) {
        try_leaves(f, n, m);
    } else if (n == m) {
        try_nodes(f, &node[n->first], &node[n->first]);
        try_nodes(f, &node[n->first + 1], &node[n->first + 1]);
        try_nodes(f, &node[n->first], &node[n->first + 1]);
    } else if (n->count > 0) {
        try_nodes(f, n, &node[m->first]);
        try_nodes(f, n, &node[m->first + 1]);
    } else {
        try_nodes(f, &node[n->first], m);
        try_nodes(f, &node[n->first + 1], m);
    }
}

bool tm_surface_is_level(const tm_surface *surface, uint32_t s, uint32_t t)
{
    const uint32_t *v = surface->triangle[s];
    const double(*xyz)[3] = (const double(*)[3])surface->xyz;
    for (int i = 0; i < 3; i++)
        if (tm_orient3d(xyz[v[0]], xyz[v[1]], xyz[v[2]], xyz[surface->triangle[t][i]]) !=
            0)
            return false;
    return true;
}

const char tm_surface_overlap_help[] =
    ", in one plane: where solids touch, both need the same triangles on all of their "
    "common face, with no node of one on an edge of the other, or the face is in the "
    "file once (as in a .poly)";

tm_status tm_surface_find_crossings(tm_surface *surface, bool lenient, unsigned base,
                                    tm_error *error)
{
    finder f = {.surface = surface, .all = lenient};
    try_nodes(&f, &surface->tree->node[0], &surface->tree->node[0]);
    surface->crossings = f.found;
    const uint32_t *pair = f.first.triangle;
    const double *point = f.first.point;
    if (lenient || surface->crossings == 0)
        return TM_OK;
    return tm_fail(
        error, TM_ERROR_INPUT,
        "%s: faces %zu and %zu meet near (%g, %g, %g), elsewhere than in a "
        "common node or edge%s",
        surface->shell[pair[0]] == surface->shell[pair[1]]
            ? "the surface crosses itself"
            : "two pieces of the surface cross",
        (size_t)surface->facet[pair[0]] + base, (size_t)surface->facet[pair[1]] + base,
        point[0], point[1], point[2],
        tm_surface_is_level(surface, pair[0], pair[1]) ? tm_surface_overlap_help : "");
}

static int compare_crossings(const void *a, const void *b)
{
    const uint32_t *p = ((const tm_crossing *)a)->triangle;
    const uint32_t *q = ((const tm_crossing *)b)->triangle;
    if (p[0] != q[0])
        return p[0] < q[0] ? -1 : 1;
    return (p[1] > q[1]) - (p[1] < q[1]);
}

tm_status tm_surface_list_crossings(const tm_surface *surface, tm_crossing **list,
                                    size_t *count, tm_error *error)
{
    finder f = {.surface = surface, .all = true, .listing = true};
    try_nodes(&f, &surface->tree->node[0], &surface->tree->node[0]);
    if (f.failed) {
        free(f.list);
        f.list = NULL;
        f.found = 0;
    }
    if (f.found > 1)
        qsort(f.list, f.found, sizeof *f.list, compare_crossings);
    *list = f.list;
    *count = f.found;
    return f.failed ? tm_fail_memory(error) : TM_OK;
}
