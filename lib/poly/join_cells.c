/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "join_cells.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "facets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A facet that stays, seen from its first label. */
typedef struct {
    uint32_t label[2];
    int32_t marker;
    uint32_t facet;
    bool turned;
} border;

typedef struct {
    uint32_t from, to;
} directed_edge;

typedef struct {
    const tm_cell_faces *faces;
    const double (*xyz)[3];
    double flatness[2]; /* between two cells, on the boundary */
    border *border;
    size_t borders;
    bool *taken;      /* [borders] */
    uint32_t *member; /* of the polygon that is grown: borders */
    size_t members, member_room;
    directed_edge *edge; /* of its border */
    size_t edges, edge_room;
    uint32_t *loop;
    size_t loop_size, loop_room;
    size_t polygons, polygon_room, start_room, items, item_room;
    uint32_t *polygon_border; /* [polygons]: one of its facets */
    size_t *start;
    uint32_t *item;
} joiner;

static int compare_borders(const void *a, const void *b)
{
    const border *p = a, *q = b;
    for (int i = 0; i < 2; i++)
        if (p->label[i] != q->label[i])
            return p->label[i] < q->label[i] ? -1 : 1;
    if (p->marker != q->marker)
        return p->marker < q->marker ? -1 : 1;
    return (p->facet > q->facet) - (p->facet < q->facet);
}

static bool is_alike(const border *p, const border *q)
{
    return p->label[0] == q->label[0] && p->label[1] == q->label[1] &&
           p->marker == q->marker;
}

static bool find_borders(joiner *j, const uint32_t *label)
{
    const tm_cell_faces *faces = j->faces;
    j->border = tm_new(faces->facets, sizeof *j->border);
    for (uint32_t f = 0; f < faces->facets && j->border; f++) {
        const uint32_t *side = faces->side[f];
        uint32_t a = label[side[0]], b = side[1] == TM_NONE ? TM_NONE : label[side[1]];
        if (a == b)
            continue;
        j->border[j->borders++] = (border){{a < b ? a : b, a < b ? b : a},
                                           faces->marker ? faces->marker[f] : 0,
                                           f,
                                           a > b};
    }
    j->taken = calloc(j->borders + 1, sizeof *j->taken);
    if (j->border)
        qsort(j->border, j->borders, sizeof *j->border, compare_borders);
    return j->border && j->taken;
}

static size_t corners_of(const joiner *j, const border *b)
{
    return j->faces->start[b->facet + 1] - j->faces->start[b->facet];
}

/* Corner i of a facet, counter-clockwise seen from outside of its first label. */
static uint32_t corner(const joiner *j, const border *b, size_t i)
{
    const size_t start = j->faces->start[b->facet], count = corners_of(j, b);
    return j->faces->node[start + (b->turned ? (count - i) % count : i)];
}

static void normal_of(const joiner *j, const border *b, double normal[3])
{
    memset(normal, 0, 3 * sizeof *normal);
    for (size_t i = 1; i + 1 < corners_of(j, b); i++) {
        double part[3];
        tm_triangle_normal(part, j->xyz[corner(j, b, 0)], j->xyz[corner(j, b, i)],
                           j->xyz[corner(j, b, i + 1)]);
        for (int x = 0; x < 3; x++)
            normal[x] += part[x];
    }
}

/* Whether a facet is in a plane, and turns the same way. */
static bool is_in_plane(const joiner *j, const border *b, const double normal[3],
                        const double on_plane[3])
{
    const double flatness = j->flatness[b->label[1] == TM_NONE];
    double own[3], to[3];
    for (size_t i = 0; i < corners_of(j, b); i++) {
        tm_subtract(to, j->xyz[corner(j, b, i)], on_plane);
        if (!(fabs(tm_dot(normal, to)) <= flatness * tm_norm(normal)))
            return false;
    }
    normal_of(j, b, own);
    return tm_dot(own, normal) > 0;
}

/* Appends the edges of a facet to those of the polygon; edges that come back go. */
static bool add_edges(joiner *j, const border *b)
{
    const size_t count = corners_of(j, b);
    directed_edge *edge = tm_grow(j->edge, &j->edge_room, j->edges + count, sizeof *edge);
    if (!edge)
        return false;
    j->edge = edge;
    for (size_t i = 0; i < count; i++) {
        uint32_t from = corner(j, b, i), to = corner(j, b, (i + 1) % count);
        size_t k = 0;
        while (k < j->edges && !(edge[k].from == to && edge[k].to == from))
            k++;
        if (k < j->edges)
            edge[k] = edge[--j->edges];
        else
            edge[j->edges++] = (directed_edge){from, to};
    }
    return true;
}

static bool has_edge_back(const joiner *j, const border *b)
{
    const size_t count = corners_of(j, b);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < j->edges; k++)
            if (j->edge[k].from == corner(j, b, (i + 1) % count) &&
                j->edge[k].to == corner(j, b, i))
                return true;
    return false;
}

static bool add_member(joiner *j, uint32_t b)
{
    j->taken[b] = true;
    return tm_append(&j->member, &j->members, &j->member_room, b) &&
           add_edges(j, &j->border[b]);
}

/* Follows the border of the polygon; whether that is one, which meets no node twice. */
static bool find_loop(joiner *j)
{
    j->loop_size = 0;
    for (uint32_t at = j->edge[0].from; j->loop_size < j->edges;) {
        size_t next = j->edges;
        for (size_t k = 0; k < j->edges; k++) {
            if (j->edge[k].from != at)
                continue;
            if (next < j->edges)
                return false;
            next = k;
        }
        if (next == j->edges || !tm_append(&j->loop, &j->loop_size, &j->loop_room, at))
            return false;
        at = j->edge[next].to;
        if (at == j->edge[0].from)
            break;
    }
    return j->loop_size == j->edges;
}

/* Writes a polygon of so many nodes, which has the facet of border b. */
static bool write_polygon(joiner *j, uint32_t b, const uint32_t *node, size_t count)
{
    size_t *start = tm_grow(j->start, &j->start_room, j->polygons + 2, sizeof *start);
    j->start = start ? start : j->start;
    bool done = start && tm_append(&j->polygon_border, &j->polygons, &j->polygon_room, b);
    for (size_t i = 0; i < count && done; i++)
        done = tm_append(&j->item, &j->items, &j->item_room, node[i]);
    if (done)
        start[j->polygons] = j->items;
    return done;
}

/* Writes a facet as it is. */
static bool write_facet(joiner *j, uint32_t b)
{
    const border *facet = &j->border[b];
    j->loop_size = 0;
    for (size_t i = 0; i < corners_of(j, facet); i++)
        if (!tm_append(&j->loop, &j->loop_size, &j->loop_room, corner(j, facet, i)))
            return false;
    return write_polygon(j, b, j->loop, j->loop_size);
}

/* The polygon that begins with border b, among those before `end`. */
static bool grow_polygon(joiner *j, uint32_t b, uint32_t end)
{
    double normal[3];
    const double *on_plane = j->xyz[corner(j, &j->border[b], 0)];
    normal_of(j, &j->border[b], normal);
    j->members = j->edges = 0;
    bool done = add_member(j, b);
    for (bool more = true; more && done;) {
        more = false;
        for (uint32_t k = b + 1; k < end && done; k++) {
            const border *other = &j->border[k];
            if (j->taken[k] || !has_edge_back(j, other) ||
                !is_in_plane(j, other, normal, on_plane))
                continue;
            done = add_member(j, k);
            more = true;
        }
    }
    if (!done)
        return false;
    if (j->edges > 0 && find_loop(j))
        return write_polygon(j, b, j->loop, j->loop_size);
    for (size_t k = 0; k < j->members && done; k++)
        done = write_facet(j, j->member[k]);
    return done;
}

static bool make_polygons(joiner *j)
{
    bool done = true;
    for (uint32_t from = 0, end; from < j->borders && done; from = end) {
        end = from + 1;
        while (end < j->borders && is_alike(&j->border[end], &j->border[from]))
            end++;
        for (uint32_t b = from; b < end && done; b++)
            done = j->taken[b] || grow_polygon(j, b, end);
    }
    return done;
}

static tm_status write_blocks(const joiner *j, size_t cells, tm_block *facet,
                              tm_block *cell, tm_error *error)
{
    facet->markers = j->faces->marker;
    tm_status status = tm_block_allocate(facet, j->polygons, j->items, error);
    if (status != TM_OK)
        return status;
    for (size_t p = 0; p < j->polygons; p++) {
        const border *b = &j->border[j->polygon_border[p]];
        facet->start[p + 1] = j->start[p + 1];
        memcpy(facet->integer + 2 * p, b->label, sizeof b->label);
        if (facet->markers)
            facet->marker[p] = b->marker;
    }
    for (size_t i = 0; i < j->items; i++)
        facet->item[i] = j->item[i];
    return tm_cells_from_facets(facet, cell, cells, error);
}

tm_status tm_join_cells(const tm_cell_faces *faces, const double (*xyz)[3],
                        const double flatness[2], const uint32_t *label, size_t cells,
                        tm_block *facet, tm_block *cell, size_t *joined, tm_error *error)
{
    joiner j = {.faces = faces, .xyz = xyz, .flatness = {flatness[0], flatness[1]}};
    tm_status status = find_borders(&j, label) && make_polygons(&j)
                           ? write_blocks(&j, cells, facet, cell, error)
                           : tm_fail_memory(error);
    *joined = j.borders - j.polygons;
    free(j.border);
    free(j.taken);
    free(j.member);
    free(j.edge);
    free(j.loop);
    free(j.polygon_border);
    free(j.start);
    free(j.item);
    return status;
}
