/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the polygons of a file to different triangles between different nodes. */
#include "surface_parts.h"

#include "../base/array.h"
#include "../geom/ears.h"
#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "../stream/coordinates.h"
#include "point_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Half edges have 32-bit numbers. */
static const size_t corners_most = (size_t)1 << 30;

static tm_status check_facets(const tm_polygon_surface *from, tm_error *error)
{
    if (from->nodes == 0 || from->facets == 0)
        return tm_fail(error, TM_ERROR_INPUT,
                       "the surface is empty: it has %zu nodes and %zu faces (a closed "
                       "surface would have at least four of each)",
                       from->nodes, from->facets);
    if (from->corners > corners_most)
        return tm_fail(error, TM_ERROR_INPUT,
                       "the faces have %zu corners in all (at most %zu are possible)",
                       from->corners, corners_most);
    for (size_t f = 0; f < from->facets; f++)
        if (from->facet_start[f + 1] - from->facet_start[f] > 1 ||
            from->facet_hole_start[f + 1] != from->facet_hole_start[f])
            return tm_fail(error, TM_ERROR_INPUT,
                           "facet %zu has several polygons, or a hole (each facet of "
                           "the surface would be one polygon)",
                           f + from->base);
    return tm_coordinates_check((const double(*)[3])from->xyz, from->nodes, from->base,
                                error);
}

bool tm_is_flat(const double a[3], const double b[3], const double c[3])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        const double pa[2] = {a[i], a[j]}, pb[2] = {b[i], b[j]}, pc[2] = {c[i], c[j]};
        if (tm_orient2d(pa, pb, pc) != 0)
            return false;
    }
    return true;
}

/* Polygons that are there twice are cut once: the other could be cut otherwise. room is
 * for the corners of the largest polygon, twice. */
static void cut_facets(tm_surface *surface, const tm_polygon_surface *from,
                       const uint32_t *unique, const bool *gone, uint32_t *room,
                       size_t most)
{
    const double(*xyz)[3] = (const double(*)[3])from->xyz;
    for (size_t f = 0; f < from->facets; f++) {
        size_t p = from->facet_start[f];
        if (p == from->facet_start[f + 1])
            continue;
        size_t k = from->start[p + 1] - from->start[p];
        if (gone[f]) {
            surface->duplicates += k - 2;
            continue;
        }
        for (size_t i = 0; i < k; i++)
            room[i] = unique[from->item[from->start[p] + i]];
        size_t t = surface->triangles;
        size_t made = tm_cut_ears(xyz, room, k, room + most, surface->triangle + t);
        surface->flat += made == 0;
        surface->triangles += made;
        for (; t < surface->triangles; t++) {
            surface->facet[t] = (uint32_t)f;
            if (surface->marker)
                surface->marker[t] = from->facet_marker[f];
        }
    }
}

static tm_status make_triangles(tm_surface *surface, const tm_polygon_surface *from,
                                const uint32_t *unique, tm_error *error)
{
    size_t most = 0;
    for (size_t p = 0; p < from->polygons; p++)
        if (from->start[p + 1] - from->start[p] > most)
            most = from->start[p + 1] - from->start[p];
    uint32_t *room = tm_new(2 * most, sizeof *room);
    surface->triangle = tm_new(from->corners, sizeof *surface->triangle);
    surface->facet = tm_new(from->corners, sizeof *surface->facet);
    if (from->has_facet_markers)
        surface->marker = tm_new(from->corners, sizeof *surface->marker);
    bool *gone = calloc(from->facets, sizeof *gone);
    size_t count;
    bool done = room && gone && surface->triangle && surface->facet &&
                (surface->marker || !from->has_facet_markers) &&
                tm_surface_find_duplicates(from, unique, 4, gone, &count);
    if (done)
        cut_facets(surface, from, unique, gone, room, most);
    free(gone);
    free(room);
    return done ? TM_OK : tm_fail_memory(error);
}

typedef struct sorted_triangle {
    uint32_t node[3]; /* ascending */
    uint32_t t;
} sorted_triangle;

static int compare_triangles(const void *a, const void *b)
{
    const sorted_triangle *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->node[i] != q->node[i])
            return p->node[i] < q->node[i] ? -1 : 1;
    return (p->t > q->t) - (p->t < q->t);
}

static void order_two(uint32_t *a, uint32_t *b)
{
    if (*b < *a) {
        uint32_t swap = *a;
        *a = *b;
        *b = swap;
    }
}

/* A triangle that has the nodes of an earlier one gets a node twice, as those have that
 * have no area. */
static tm_status find_duplicates(tm_surface *surface, tm_error *error)
{
    sorted_triangle *sorted = tm_new(surface->triangles, sizeof *sorted);
    size_t count = 0;
    if (!sorted)
        return tm_fail_memory(error);
    for (size_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            surface->flat++;
            continue;
        }
        sorted_triangle *s = &sorted[count++];
        *s = (sorted_triangle){{v[0], v[1], v[2]}, (uint32_t)t};
        order_two(&s->node[0], &s->node[1]);
        order_two(&s->node[1], &s->node[2]);
        order_two(&s->node[0], &s->node[1]);
    }
    qsort(sorted, count, sizeof *sorted, compare_triangles);
    for (size_t i = 1; i < count; i++) {
        if (memcmp(sorted[i].node, sorted[i - 1].node, sizeof sorted->node) != 0)
            continue;
        surface->duplicates++;
        surface->triangle[sorted[i].t][1] = surface->triangle[sorted[i].t][0];
    }
    free(sorted);
    return TM_OK;
}

static void drop_triangles(tm_surface *surface)
{
    size_t kept = 0;
    for (size_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
            continue;
        memmove(surface->triangle[kept], v, sizeof *surface->triangle);
        surface->facet[kept] = surface->facet[t];
        if (surface->marker)
            surface->marker[kept] = surface->marker[t];
        kept++;
    }
    surface->triangles = kept;
}

static void find_bounds(tm_surface *surface)
{
    for (int i = 0; i < 3; i++) {
        surface->low[i] = HUGE_VAL;
        surface->high[i] = -HUGE_VAL;
        for (size_t v = 0; v < surface->nodes; v++) {
            surface->low[i] = fmin(surface->low[i], surface->xyz[v][i]);
            surface->high[i] = fmax(surface->high[i], surface->xyz[v][i]);
        }
    }
}

tm_status tm_surface_drop_nodes(tm_surface *surface, tm_error *error)
{
    size_t corners = 3 * surface->triangles, kept = 0;
    uint32_t *number = calloc(surface->nodes + 1, sizeof *number);
    if (!number)
        return tm_fail_memory(error);
    for (size_t i = 0; i < corners; i++)
        number[surface->triangle[i / 3][i % 3]] = 1;
    for (size_t v = 0; v < surface->nodes; v++) {
        if (number[v] == 0)
            continue;
        memmove(surface->xyz[kept], surface->xyz[v], sizeof *surface->xyz);
        surface->origin[kept] = surface->origin[v];
        number[v] = (uint32_t)kept++;
    }
    surface->nodes = kept;
    for (size_t i = 0; i < corners; i++)
        surface->triangle[i / 3][i % 3] = number[surface->triangle[i / 3][i % 3]];
    find_bounds(surface);
    free(number);
    return TM_OK;
}

static tm_status copy_nodes(tm_surface *surface, const tm_polygon_surface *from,
                            tm_error *error)
{
    surface->nodes = from->nodes;
    surface->xyz = tm_new(surface->nodes, sizeof *surface->xyz);
    surface->origin = tm_new(surface->nodes, sizeof *surface->origin);
    if (!surface->xyz || !surface->origin)
        return tm_fail_memory(error);
    memcpy(surface->xyz, from->xyz, surface->nodes * sizeof *surface->xyz);
    for (size_t v = 0; v < surface->nodes; v++)
        surface->origin[v] = (uint32_t)v;
    return TM_OK;
}

tm_status tm_surface_triangulate(tm_surface *surface, const tm_polygon_surface *polygons,
                                 tm_error *error)
{
    tm_status status = check_facets(polygons, error);
    if (status != TM_OK)
        return status;
    uint32_t *unique = tm_new(polygons->nodes, sizeof *unique);
    if (!unique ||
        !tm_points_weld(polygons->xyz, polygons->nodes, unique, &surface->welded))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = make_triangles(surface, polygons, unique, error);
    if (status == TM_OK)
        status = find_duplicates(surface, error);
    if (status == TM_OK) {
        drop_triangles(surface);
        status = copy_nodes(surface, polygons, error);
    }
    if (status == TM_OK)
        status = tm_surface_drop_nodes(surface, error);
    free(unique);
    return status;
}

bool tm_surface_is_as_given(const tm_surface *surface, const tm_polygon_surface *polygons,
                            size_t t)
{
    const size_t facet = surface->facet[t];
    const uint32_t *row = polygons->item + polygons->start[polygons->facet_start[facet]];
    const double *first = surface->xyz[surface->triangle[t][0]];
    const double *second = surface->xyz[surface->triangle[t][1]];
    for (int i = 0; i < 3; i++)
        if (tm_distance2(polygons->xyz[row[i]], first) == 0)
            return tm_distance2(polygons->xyz[row[(i + 1) % 3]], second) == 0;
    return true;
}
