/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_sharp.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../../mesh/polygon_edges.h"
#include "../surface_parts.h"
#include "../surface_tree.h"

#include <stdlib.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

typedef struct finder {
    const tm_surface *surface;
    tm_polygon_edges edges;
    double (*normal)[3]; /* [triangles], of length 1, or 0 where there is none */
    bool *is_sharp;      /* [edges] */
    uint32_t (*end)[2];  /* [edges]: their nodes */
    double most_cosine;
    bool markers_count;
} finder;

static tm_status find_edges(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    size_t *start = tm_new(s->triangles + 1, sizeof *start);
    if (!start)
        return tm_fail_memory(error);
    for (size_t t = 0; t <= s->triangles; t++)
        start[t] = 3 * t;
    const tm_status status = tm_polygon_edges_find(
        &f->edges, s->triangles, start, s->triangle[0], s->nodes, NULL, 0, error);
    free(start);
    if (status != TM_OK)
        return status;
    f->is_sharp = calloc(f->edges.edges + 1, sizeof *f->is_sharp);
    f->end = tm_new(f->edges.edges, sizeof *f->end);
    f->normal = calloc(s->triangles + 1, sizeof *f->normal);
    if (!f->is_sharp || !f->end || !f->normal)
        return tm_fail_memory(error);
    for (size_t t = 0; t < s->triangles; t++)
        for (size_t i = 0; i < 3; i++) {
            uint32_t *end = f->end[f->edges.edge_of[3 * t + i]];
            end[0] = s->triangle[t][i];
            end[1] = s->triangle[t][(i + 1) % 3];
        }
    return TM_OK;
}

/* The triangle beyond the longest edge of t, or TM_NONE where there is not just one; and
 * whether it is seen from the other side. */
static uint32_t beyond_longest(const finder *f, uint32_t t, bool *turned)
{
    const tm_surface *s = f->surface;
    size_t longest = 0;
    double longest2 = -1;
    for (size_t i = 0; i < 3; i++) {
        const uint32_t *v = s->triangle[t];
        const double length2 = tm_distance2(s->xyz[v[i]], s->xyz[v[(i + 1) % 3]]);
        if (length2 > longest2) {
            longest2 = length2;
            longest = i;
        }
    }
    const size_t e = f->edges.edge_of[3 * (size_t)t + longest];
    const size_t at = f->edges.start[e];
    if (f->edges.start[e + 1] - at != 2)
        return TM_NONE;
    *turned ^= f->edges.ascending[at] == f->edges.ascending[at + 1];
    return f->edges.polygon[at + (f->edges.polygon[at] == t)];
}

/* That of a triangle without an own one is that of what is beyond its longest edge. */
static void find_normals(finder *f)
{
    const int steps_most = 16;
    for (size_t t = 0; t < f->surface->triangles; t++) {
        uint32_t from = (uint32_t)t;
        bool turned = false;
        double normal[3] = {0};
        bool found = tm_surface_own_normal(f->surface, from, normal);
        for (int i = 0; i < steps_most && !found && from != TM_NONE; i++) {
            from = beyond_longest(f, from, &turned);
            found = from != TM_NONE && tm_surface_own_normal(f->surface, from, normal);
        }
        for (int i = 0; i < 3 && found; i++)
            f->normal[t][i] = turned ? -normal[i] : normal[i];
    }
}

static bool is_sharp(const finder *f, size_t e)
{
    const size_t at = f->edges.start[e];
    if (f->edges.start[e + 1] - at != 2)
        return true;
    const uint32_t a = f->edges.polygon[at], b = f->edges.polygon[at + 1];
    if (f->markers_count && f->surface->marker[a] != f->surface->marker[b])
        return true;
    if (tm_norm2(f->normal[a]) == 0 || tm_norm2(f->normal[b]) == 0)
        return false;
    double cosine = tm_dot(f->normal[a], f->normal[b]);
    if (f->edges.ascending[at] == f->edges.ascending[at + 1])
        cosine = -cosine;
    return cosine < f->most_cosine;
}

/* Counts the sharp edges at each node. */
static size_t count_sharp(const finder *f, uint32_t *number)
{
    size_t sharp = 0;
    for (size_t e = 0; e < f->edges.edges; e++) {
        if (!f->is_sharp[e])
            continue;
        sharp++;
        number[f->end[e][0]]++;
        number[f->end[e][1]]++;
    }
    return sharp;
}

/* What is at a node that two sharp edges meet: the sum of the unit vectors to the other
 * ends, whose squared length is 2 + 2 cos of the angle between them. */
static void add_directions(const finder *f, double (*sum)[3])
{
    const double(*xyz)[3] = (const double(*)[3])f->surface->xyz;
    for (size_t e = 0; e < f->edges.edges; e++) {
        if (!f->is_sharp[e])
            continue;
        const uint32_t *end = f->end[e];
        double along[3];
        tm_subtract(along, xyz[end[1]], xyz[end[0]]);
        const double length = tm_norm(along);
        for (int i = 0; i < 3 && length > 0; i++) {
            sum[end[0]][i] += along[i] / length;
            sum[end[1]][i] -= along[i] / length;
        }
    }
}

/* Copies the nodes and the bounding box of a surface to one of `count` triangles. */
static tm_status start_set(tm_surface *set, const tm_surface *surface, size_t count,
                           tm_error *error)
{
    set->nodes = surface->nodes;
    set->xyz = tm_new(surface->nodes, sizeof *set->xyz);
    set->triangle = tm_new(count, sizeof *set->triangle);
    if (!set->xyz || !set->triangle)
        return tm_fail_memory(error);
    memcpy(set->xyz, surface->xyz, surface->nodes * sizeof *set->xyz);
    memcpy(set->low, surface->low, sizeof set->low);
    memcpy(set->high, surface->high, sizeof set->high);
    return TM_OK;
}

static void add(tm_surface *set, uint32_t a, uint32_t b)
{
    uint32_t *t = set->triangle[set->triangles++];
    t[0] = a;
    t[1] = t[2] = b;
}

static tm_status list_curves(const finder *f, size_t count, tm_surface *curve,
                             tm_error *error)
{
    tm_status status = start_set(curve, f->surface, count, error);
    if (status != TM_OK || count == 0)
        return status;
    for (size_t e = 0; e < f->edges.edges; e++)
        if (f->is_sharp[e])
            add(curve, f->end[e][0], f->end[e][1]);
    return tm_surface_tree_build(curve, error);
}

static tm_status list_corners(const finder *f, const uint32_t *number, tm_surface *corner,
                              tm_error *error)
{
    const size_t nodes = f->surface->nodes;
    double(*sum)[3] = calloc(nodes + 1, sizeof *sum);
    tm_status status =
        sum ? start_set(corner, f->surface, nodes, error) : tm_fail_memory(error);
    if (status == TM_OK) {
        add_directions(f, sum);
        for (uint32_t v = 0; v < nodes; v++)
            if (number[v] > 0 &&
                (number[v] != 2 || tm_norm2(sum[v]) > 2 - 2 * f->most_cosine))
                add(corner, v, v);
    }
    free(sum);
    if (status == TM_OK && corner->triangles > 0)
        status = tm_surface_tree_build(corner, error);
    return status;
}

static tm_status list_sharp(const finder *f, tm_surface_sharp *sharp, tm_error *error)
{
    /* Of a scan one of so many curves ends freely, and more than a few do. */
    const size_t many = 20, few = 30;
    const size_t nodes = f->surface->nodes;
    size_t ends = 0, arms = 0;
    uint32_t *number = calloc(nodes + 1, sizeof *number);
    if (!number)
        return tm_fail_memory(error);
    const size_t count = count_sharp(f, number);
    for (size_t v = 0; v < nodes; v++) {
        ends += number[v] == 1;
        arms += number[v] != 2 ? number[v] : 0;
    }
    sharp->rough = ends > few && 2 * many * ends > arms;
    tm_status status = list_curves(f, count, &sharp->curve, error);
    if (status == TM_OK)
        status = list_corners(f, number, &sharp->corner, error);
    free(number);
    return status;
}

tm_status tm_surface_find_sharp(tm_surface_sharp *sharp, const tm_surface *surface,
                                double feature_angle, bool markers_count, tm_error *error)
{
    finder f = {.surface = surface,
                .most_cosine = cos(feature_angle * degree),
                .markers_count = markers_count};
    *sharp = (tm_surface_sharp){0};
    tm_status status = find_edges(&f, error);
    if (status == TM_OK) {
        find_normals(&f);
        for (size_t e = 0; e < f.edges.edges; e++)
            f.is_sharp[e] = is_sharp(&f, e);
        status = list_sharp(&f, sharp, error);
    }
    tm_polygon_edges_free(&f.edges);
    free(f.normal);
    free(f.is_sharp);
    free(f.end);
    return status;
}

void tm_surface_sharp_free(tm_surface_sharp *sharp)
{
    tm_surface_free(&sharp->curve);
    tm_surface_free(&sharp->corner);
}
