/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which triangles are beyond which edges. Half edge 3t + i is the edge from corner i of
 * triangle t to the next; the half edges of an edge are found by sorting. */
#include "surface_parts.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../base/ids.h"
#include "../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CLOSED = 2, FEW = 24 };

typedef struct half_edge {
    uint32_t high; /* the larger of its nodes; the smaller is that of the bucket */
    uint32_t half;
} half_edge;

typedef struct edge_table {
    size_t *start;   /* [nodes + 1]: half edges with v for the smaller node */
    half_edge *edge; /* in each bucket sorted by high, then half */
} edge_table;

static uint32_t from_node(const tm_surface *surface, uint32_t half)
{
    return surface->triangle[half / 3][half % 3];
}

static uint32_t to_node(const tm_surface *surface, uint32_t half)
{
    return surface->triangle[half / 3][(half + 1 - half / 3 * 3) % 3];
}

static int compare_half_edges(const void *a, const void *b)
{
    const half_edge *p = a, *q = b;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return (p->half > q->half) - (p->half < q->half);
}

static void sort_bucket(half_edge *edge, size_t count)
{
    if (count > FEW) {
        qsort(edge, count, sizeof *edge, compare_half_edges);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        half_edge moved = edge[i];
        size_t k = i;
        for (; k > 0 && compare_half_edges(&edge[k - 1], &moved) > 0; k--)
            edge[k] = edge[k - 1];
        edge[k] = moved;
    }
}

static void edge_table_free(edge_table *table)
{
    free(table->start);
    free(table->edge);
    *table = (edge_table){0};
}

static bool edge_table_make(edge_table *table, const tm_surface *surface)
{
    uint32_t halves = (uint32_t)(3 * surface->triangles);
    table->start = calloc(surface->nodes + 2, sizeof *table->start);
    table->edge = tm_new(halves, sizeof *table->edge);
    if (!table->start || !table->edge)
        return false;
    for (uint32_t h = 0; h < halves; h++) {
        uint32_t a = from_node(surface, h), b = to_node(surface, h);
        table->start[(a < b ? a : b) + 2]++;
    }
    for (size_t v = 1; v <= surface->nodes; v++)
        table->start[v + 1] += table->start[v];
    for (uint32_t h = 0; h < halves; h++) {
        uint32_t a = from_node(surface, h), b = to_node(surface, h);
        table->edge[table->start[(a < b ? a : b) + 1]++] = (half_edge){a < b ? b : a, h};
    }
    for (size_t v = 0; v < surface->nodes; v++)
        sort_bucket(table->edge + table->start[v], table->start[v + 1] - table->start[v]);
    return true;
}

/* The end of the run of half edges of one edge that begins at i. */
static size_t end_of_edge(const half_edge *edge, size_t i, size_t last)
{
    size_t next = i + 1;
    while (next < last && edge[next].high == edge[i].high)
        next++;
    return next;
}

static bool is_flat(const tm_surface *surface, uint32_t t)
{
    const uint32_t *v = surface->triangle[t];
    return tm_is_flat(surface->xyz[v[0]], surface->xyz[v[1]], surface->xyz[v[2]]);
}

/* Flat triangles in groups that are joined by edges which only flat ones have; needed[g]
 * where an edge of group g is not closed without it. */
typedef struct flat_groups {
    bool *flat;
    uint32_t *parent;
    bool *needed;
} flat_groups;

static void examine_edge(const half_edge *edge, size_t count, flat_groups *groups)
{
    size_t others = 0;
    uint32_t first = TM_NONE;
    for (size_t i = 0; i < count; i++)
        others += !groups->flat[edge[i].half / 3];
    for (size_t i = 0; i < count; i++) {
        uint32_t t = edge[i].half / 3;
        if (!groups->flat[t])
            continue;
        uint32_t root = tm_set_root(groups->parent, t);
        if (others == 0 && first != TM_NONE) {
            uint32_t to = tm_set_root(groups->parent, first);
            groups->parent[root] = to;
            groups->needed[to] |= groups->needed[root];
            root = to;
        }
        groups->needed[root] |= others != 0 && others != CLOSED;
        first = t;
    }
}

static void drop(tm_surface *surface, const bool *gone)
{
    size_t kept = 0;
    for (size_t t = 0; t < surface->triangles; t++) {
        if (gone[t])
            continue;
        memmove(surface->triangle[kept], surface->triangle[t], sizeof *surface->triangle);
        surface->facet[kept] = surface->facet[t];
        if (surface->marker)
            surface->marker[kept] = surface->marker[t];
        kept++;
    }
    surface->flat += surface->triangles - kept;
    surface->triangles = kept;
}

static void drop_groups(tm_surface *surface, const edge_table *table, flat_groups *groups)
{
    for (size_t v = 0; v < surface->nodes; v++)
        for (size_t i = table->start[v], next; i < table->start[v + 1]; i = next) {
            next = end_of_edge(table->edge, i, table->start[v + 1]);
            examine_edge(table->edge + i, next - i, groups);
        }
    for (uint32_t t = 0; t < surface->triangles; t++)
        groups->flat[t] &= !groups->needed[tm_set_root(groups->parent, t)];
    drop(surface, groups->flat);
}

/* Drops the groups that are not needed. */
static tm_status drop_needless(tm_surface *surface, const edge_table *table,
                               tm_error *error)
{
    size_t n = surface->triangles;
    flat_groups groups = {tm_new(n, sizeof *groups.flat),
                          tm_new(n, sizeof *groups.parent),
                          calloc(n + 1, sizeof *groups.needed)};
    const bool done = groups.flat && groups.parent && groups.needed;
    size_t flats = 0;
    for (uint32_t t = 0; t < n && done; t++) {
        groups.parent[t] = t;
        flats += groups.flat[t] = is_flat(surface, t);
    }
    if (flats > 0)
        drop_groups(surface, table, &groups);
    free(groups.flat);
    free(groups.parent);
    free(groups.needed);
    return done ? TM_OK : tm_fail_memory(error);
}

static void join(tm_surface *surface, uint32_t h, uint32_t g)
{
    surface->across[h / 3][h % 3] = g / 3;
    surface->across[g / 3][g % 3] = h / 3;
}

static int compare_angles(const void *a, const void *b)
{
    const tm_around *p = a, *q = b;
    if (p->angle != q->angle)
        return p->angle < q->angle ? -1 : 1;
    return (p->half > q->half) - (p->half < q->half);
}

void tm_surface_sort_around(const tm_surface *surface, uint32_t low, uint32_t high,
                            tm_around *at, size_t count)
{
    double along[3], x[3], y[3];
    const double *origin = surface->xyz[low];
    tm_subtract(along, surface->xyz[high], origin);
    for (size_t i = 0; i < count; i++) {
        uint32_t h = at[i].half;
        double to[3], across[3];
        tm_subtract(to, surface->xyz[surface->triangle[h / 3][(h % 3 + 2) % 3]], origin);
        tm_cross(across, along, to);
        if (i == 0) {
            memcpy(y, across, sizeof y);
            tm_cross(x, y, along);
        }
        at[i].angle = atan2(tm_dot(y, to) * tm_norm(along), tm_dot(x, to));
    }
    qsort(at, count, sizeof *at, compare_angles);
}

/* Seen along the edge from its smaller node, the solid is clockwise of a triangle that
 * has the edge in this direction and counter-clockwise of one that has it in the other:
 * both kinds must alternate, and the two around a wedge of the solid are joined. */
static bool pair_wedges(tm_surface *surface, const half_edge *edge, size_t count,
                        uint32_t low)
{
    tm_around at[TM_WEDGES_MOST];
    if (count % 2 != 0 || count > TM_WEDGES_MOST)
        return false;
    for (size_t i = 0; i < count; i++)
        at[i].half = edge[i].half;
    tm_surface_sort_around(surface, low, edge->high, at, count);
    for (size_t i = 0; i < count; i++)
        if ((from_node(surface, at[i].half) == low) ==
            (from_node(surface, at[(i + 1) % count].half) == low))
            return false;
    for (size_t i = 0; i < count; i++)
        if (from_node(surface, at[i].half) != low)
            join(surface, at[i].half, at[(i + 1) % count].half);
    return true;
}

typedef struct defects {
    size_t open, crowded, odd;
    uint32_t open_edge[2], crowded_edge[2];
    bool overlaps; /* two triangles at the crowded edge do */
} defects;

/* Whether two triangles at an edge are in one plane, and on the same side of it. */
static bool is_overlapped(const tm_surface *surface, const half_edge *edge, size_t count,
                          uint32_t low)
{
    const double *origin = surface->xyz[low];
    double along[3], a[3], b[3], across_a[3], across_b[3];
    tm_subtract(along, surface->xyz[edge->high], origin);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < i; k++) {
            const uint32_t g = edge[i].half, h = edge[k].half;
            if (!tm_surface_is_level(surface, g / 3, h / 3))
                continue;
            tm_subtract(a, surface->xyz[surface->triangle[g / 3][(g % 3 + 2) % 3]],
                        origin);
            tm_subtract(b, surface->xyz[surface->triangle[h / 3][(h % 3 + 2) % 3]],
                        origin);
            tm_cross(across_a, along, a);
            tm_cross(across_b, along, b);
            if (tm_dot(across_a, across_b) > 0)
                return true;
        }
    return false;
}

static void join_edge(tm_surface *surface, const half_edge *edge, size_t count,
                      uint32_t low, defects *found)
{
    const uint32_t nodes[2] = {low, edge->high};
    if (count == CLOSED) {
        join(surface, edge[0].half, edge[1].half);
    } else if (count < CLOSED) {
        if (found->open++ == 0)
            memcpy(found->open_edge, nodes, sizeof nodes);
    } else if (!pair_wedges(surface, edge, count, low)) {
        found->odd += count % 2;
        found->crowded++;
        if (!found->overlaps) {
            memcpy(found->crowded_edge, nodes, sizeof nodes);
            found->overlaps =
                count <= TM_WEDGES_MOST && is_overlapped(surface, edge, count, low);
        }
        surface->open_edges += count;
    }
}

/* Open edges first: they are the plainer defect, and often the cause of the other. */
static tm_status report(const tm_surface *surface, const defects *found, unsigned base,
                        tm_error *error)
{
    bool open = found->open > 0;
    const uint32_t *e = open ? found->open_edge : found->crowded_edge;
    const double *a = surface->xyz[e[0]], *b = surface->xyz[e[1]];
    return tm_fail(error, TM_ERROR_INPUT,
                   "the surface is %s: edges with one triangle: %zu, with more than two "
                   "that do not pair: %zu (every edge would have two); one is between "
                   "nodes %zu (%g, %g, %g) and %zu (%g, %g, %g)%s%s",
                   open ? "open" : "not manifold", found->open, found->crowded,
                   (size_t)surface->origin[e[0]] + base, a[0], a[1], a[2],
                   (size_t)surface->origin[e[1]] + base, b[0], b[1], b[2],
                   !open && found->overlaps ? ", where triangles overlap" : "",
                   !open && found->overlaps ? tm_surface_overlap_help : "");
}

/* Parts the triangles at edges with more than two: there walls meet. */
static void part_walls(tm_surface *surface, const edge_table *table)
{
    for (size_t v = 0; v < surface->nodes; v++)
        for (size_t i = table->start[v], next; i < table->start[v + 1]; i = next) {
            next = end_of_edge(table->edge, i, table->start[v + 1]);
            for (size_t k = i; next - i > CLOSED && k < next; k++)
                surface->across[table->edge[k].half / 3][table->edge[k].half % 3] =
                    TM_NONE;
        }
}

static tm_status join_edges(tm_surface *surface, const edge_table *table, bool lenient,
                            bool walls, unsigned base, tm_error *error)
{
    defects found = {0};
    surface->across = tm_new(surface->triangles, sizeof *surface->across);
    if (!surface->across)
        return tm_fail_memory(error);
    for (size_t t = 0; t < surface->triangles; t++)
        for (int i = 0; i < 3; i++)
            surface->across[t][i] = TM_NONE;
    for (size_t v = 0; v < surface->nodes; v++)
        for (size_t i = table->start[v], next; i < table->start[v + 1]; i = next) {
            next = end_of_edge(table->edge, i, table->start[v + 1]);
            join_edge(surface, table->edge + i, next - i, (uint32_t)v, &found);
        }
    if (walls && found.open == 0 && found.odd > 0) {
        surface->walls = true;
        surface->open_edges = 0;
        part_walls(surface, table);
        return TM_OK;
    }
    surface->open_edges += found.open;
    if (lenient || found.open + found.crowded == 0)
        return TM_OK;
    return report(surface, &found, base, error);
}

tm_status tm_surface_connect(tm_surface *surface, bool lenient, bool walls, unsigned base,
                             tm_error *error)
{
    edge_table table = {0};
    size_t before = surface->flat;
    if (surface->triangles >= TM_IDS_THIRD)
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "%zu triangles have more sides than 32 bits can number",
                       surface->triangles);
    tm_status status = edge_table_make(&table, surface) ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = drop_needless(surface, &table, error);
    if (status == TM_OK && surface->triangles == 0)
        status = tm_fail(error, TM_ERROR_INPUT,
                         "no triangle is left: none has an area (without one: %zu, "
                         "duplicates: %zu)",
                         surface->flat, surface->duplicates);
    if (status == TM_OK && surface->flat > before)
        status = tm_surface_drop_nodes(surface, error);
    if (status == TM_OK && surface->flat > before) {
        edge_table_free(&table);
        if (!edge_table_make(&table, surface))
            status = tm_fail_memory(error);
    }
    if (status == TM_OK)
        status = join_edges(surface, &table, lenient, walls, base, error);
    edge_table_free(&table);
    return status;
}
