/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_defects.h"

#include "../base/array.h"
#include "../geom/ears.h"
#include "point_table.h"
#include "surface_parts.h"

#include <stdlib.h>
#include <string.h>

/* A facet that is one polygon: its nodes, ascending. */
typedef struct sorted_facet {
    const uint32_t *node;
    size_t nodes;
    size_t facet;
} sorted_facet;

static int compare_polygons(const sorted_facet *p, const sorted_facet *q)
{
    if (p->nodes != q->nodes)
        return p->nodes < q->nodes ? -1 : 1;
    for (size_t i = 0; i < p->nodes; i++)
        if (p->node[i] != q->node[i])
            return p->node[i] < q->node[i] ? -1 : 1;
    return 0;
}

static int compare_facets(const void *a, const void *b)
{
    const sorted_facet *p = a, *q = b;
    const int order = compare_polygons(p, q);
    return order != 0 ? order : (p->facet > q->facet) - (p->facet < q->facet);
}

/* Whether a facet is one polygon, without holes. */
static bool is_polygon(const tm_polygon_surface *surface, size_t f)
{
    return surface->facet_start[f + 1] - surface->facet_start[f] == 1 &&
           surface->facet_hole_start[f + 1] == surface->facet_hole_start[f];
}

/* Lists the facets of one polygon of so many nodes or more, without holes, in `sorted`;
 * sorts their nodes. */
static size_t sort_facets(const tm_polygon_surface *surface, size_t least, uint32_t *node,
                          sorted_facet *sorted)
{
    size_t count = 0;
    for (size_t f = 0; f < surface->facets; f++) {
        const size_t p = surface->facet_start[f];
        if (!is_polygon(surface, f))
            continue;
        uint32_t *first = node + surface->start[p];
        const size_t nodes = surface->start[p + 1] - surface->start[p];
        if (nodes < least)
            continue;
        qsort(first, nodes, sizeof *first, tm_compare_numbers);
        sorted[count++] = (sorted_facet){first, nodes, f};
    }
    qsort(sorted, count, sizeof *sorted, compare_facets);
    return count;
}

/* Takes facets that are `gone` out of the arrays; all they hold moves up. */
static void drop_facets(tm_polygon_surface *surface, const bool *gone)
{
    size_t facets = 0, polygons = 0, corners = 0;
    for (size_t f = 0; f < surface->facets; f++) {
        const size_t first = surface->facet_start[f], end = surface->facet_start[f + 1];
        if (gone[f])
            continue;
        surface->facet_start[facets] = polygons;
        surface->facet_hole_start[facets] = surface->facet_hole_start[f];
        surface->facet_marker[facets++] = surface->facet_marker[f];
        for (size_t p = first; p < end; p++) {
            const size_t from = surface->start[p], to = surface->start[p + 1];
            memmove(surface->item + corners, surface->item + from,
                    (to - from) * sizeof *surface->item);
            surface->start[polygons++] = corners;
            corners += to - from;
        }
    }
    surface->facet_start[facets] = polygons;
    surface->facet_hole_start[facets] = surface->facet_holes;
    surface->start[polygons] = corners;
    surface->facets = facets;
    surface->polygons = polygons;
    surface->corners = corners;
}

bool tm_surface_find_duplicates(const tm_polygon_surface *surface, const uint32_t *unique,
                                size_t least, bool *gone, size_t *count)
{
    uint32_t *node = tm_new(surface->corners, sizeof *node);
    sorted_facet *sorted = tm_new(surface->facets, sizeof *sorted);
    const bool done = node && sorted;
    *count = 0;
    for (size_t i = 0; i < surface->corners && done; i++)
        node[i] = unique[surface->item[i]];
    const size_t facets = done ? sort_facets(surface, least, node, sorted) : 0;
    for (size_t i = 1; i < facets; i++)
        if (compare_polygons(&sorted[i - 1], &sorted[i]) == 0) {
            gone[sorted[i].facet] = true;
            ++*count;
        }
    free(node);
    free(sorted);
    return done;
}

/* What both ways to drop facets begin with; false where memory is out. */
static bool weld(const tm_polygon_surface *surface, uint32_t **unique, bool **gone)
{
    size_t joined;
    *unique = tm_new(surface->nodes, sizeof **unique);
    *gone = calloc(surface->facets, sizeof **gone);
    return *unique && *gone &&
           tm_points_weld(surface->xyz, surface->nodes, *unique, &joined);
}

tm_status tm_surface_drop_duplicates(tm_polygon_surface *surface, size_t *dropped,
                                     tm_error *error)
{
    *dropped = 0;
    if (surface->facets == 0)
        return TM_OK;
    uint32_t *unique;
    bool *gone;
    const bool done = weld(surface, &unique, &gone) &&
                      tm_surface_find_duplicates(surface, unique, 0, gone, dropped);
    if (*dropped > 0)
        drop_facets(surface, gone);
    free(unique);
    free(gone);
    return done ? TM_OK : tm_fail_memory(error);
}

/* Moves the corners of a polygon that are not where the one before is to the front;
 * returns how many there are. */
static size_t join_corners(uint32_t *item, size_t count, const uint32_t *unique)
{
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || unique[item[i]] != unique[item[kept - 1]])
            item[kept++] = item[i];
    while (kept > 1 && unique[item[kept - 1]] == unique[item[0]])
        kept--;
    return kept;
}

/* Without such corners; gone[f] is set of facets that have none of their own left. */
static size_t mend_polygons(tm_polygon_surface *surface, const uint32_t *unique,
                            bool *gone)
{
    enum { POLYGON_MIN = 3 };
    size_t mended = 0, corners = 0;
    for (size_t f = 0; f < surface->facets; f++) {
        const size_t first = surface->facet_start[f], end = surface->facet_start[f + 1];
        const bool alone = is_polygon(surface, f);
        for (size_t p = first; p < end; p++) {
            uint32_t *item = surface->item + surface->start[p];
            const size_t count = surface->start[p + 1] - surface->start[p];
            size_t kept =
                count < POLYGON_MIN || !alone ? count : join_corners(item, count, unique);
            mended += kept < count;
            gone[f] = kept < count && kept < POLYGON_MIN;
            memmove(surface->item + corners, item, kept * sizeof *item);
            surface->start[p] = corners;
            corners += kept;
        }
    }
    surface->start[surface->polygons] = surface->corners = corners;
    return mended;
}

tm_status tm_surface_drop_degenerate(tm_polygon_surface *surface, size_t *mended,
                                     tm_error *error)
{
    *mended = 0;
    if (surface->facets == 0)
        return TM_OK;
    uint32_t *unique;
    bool *gone;
    const bool done = weld(surface, &unique, &gone);
    if (done)
        *mended = mend_polygons(surface, unique, gone);
    if (*mended > 0)
        drop_facets(surface, gone);
    free(unique);
    free(gone);
    return done ? TM_OK : tm_fail_memory(error);
}

/* A polygon is slit open where it has a point twice. room: for its corners. */
static bool is_slit(const uint32_t *node, size_t k, uint32_t *room)
{
    memcpy(room, node, k * sizeof *room);
    qsort(room, k, sizeof *room, tm_compare_numbers);
    for (size_t i = 1; i < k; i++)
        if (room[i] == room[i - 1])
            return true;
    return false;
}

/* Triangles of facets that are gone, with their markers. */
typedef struct cut_facets {
    uint32_t (*triangle)[3];
    int32_t *marker;
    size_t triangles;
} cut_facets;

/* Cuts the polygons that are slit open and sets gone[f] of their facets; returns how
 * many. triangle and marker have room for one of each corner, room for two numbers of
 * each. */
static size_t cut_polygons(const tm_polygon_surface *surface, const uint32_t *unique,
                           bool *gone, uint32_t *room, cut_facets *to)
{
    size_t cut = 0;
    for (size_t f = 0; f < surface->facets; f++) {
        const size_t p = surface->facet_start[f];
        if (!is_polygon(surface, f))
            continue;
        const size_t k = surface->start[p + 1] - surface->start[p];
        for (size_t i = 0; i < k; i++)
            room[i] = unique[surface->item[surface->start[p] + i]];
        if (!is_slit(room, k, room + k))
            continue;
        const size_t made = tm_cut_ears((const double(*)[3])surface->xyz, room, k,
                                        room + k, to->triangle + to->triangles);
        for (size_t t = 0; t < made; t++)
            to->marker[to->triangles++] = surface->facet_marker[f];
        gone[f] = true;
        cut++;
    }
    return cut;
}

static tm_status add_cut(tm_polygon_surface *surface, const cut_facets *cut,
                         tm_error *error)
{
    const int32_t next = surface->next_marker;
    tm_status status = TM_OK;
    for (size_t t = 0; t < cut->triangles && status == TM_OK; t++) {
        const uint32_t *v = cut->triangle[t];
        surface->next_marker = cut->marker[t];
        if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0])
            status = tm_polygon_surface_add_polygon(surface, v, 3, error);
    }
    surface->next_marker = next;
    return status;
}

tm_status tm_surface_cut_slit(tm_polygon_surface *surface, size_t *cut, tm_error *error)
{
    *cut = 0;
    if (surface->facets == 0)
        return TM_OK;
    uint32_t *unique, *room = tm_new(2 * surface->corners, sizeof *room);
    bool *gone;
    cut_facets to = {.triangle = tm_new(surface->corners, sizeof *to.triangle),
                     .marker = tm_new(surface->corners, sizeof *to.marker)};
    tm_status status = weld(surface, &unique, &gone) && room && to.triangle && to.marker
                           ? TM_OK
                           : tm_fail_memory(error);
    if (status == TM_OK)
        *cut = cut_polygons(surface, unique, gone, room, &to);
    if (*cut > 0) {
        drop_facets(surface, gone);
        status = add_cut(surface, &to, error);
    }
    free(unique);
    free(gone);
    free(room);
    free(to.triangle);
    free(to.marker);
    return status;
}
