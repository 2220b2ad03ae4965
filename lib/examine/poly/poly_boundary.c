/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_boundary.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/hash.h"
#include "../../base/ids.h"

#include <stdlib.h>
#include <string.h>

static const size_t most_corners = TM_IDS_HALF;

enum { NODE, FANS, FACE_START, CORNER, FACE, EDGE, SLOT, PARENT };

void tm_poly_boundary_free(tm_poly_boundary *b)
{
    free(b->node);
    free(b->fans);
    free(b->face_start);
    free(b->corner);
    free(b->face);
    free(b->edge);
    free(b->slot);
    free(b->parent);
    *b = (tm_poly_boundary){0};
}

static bool reserve(tm_poly_boundary *b, uint32_t **array, size_t which, size_t count)
{
    void *moved = tm_grow(*array, &b->room[which], count, sizeof **array);
    *array = moved ? moved : *array;
    return moved;
}

static bool allocate(tm_poly_boundary *b)
{
    void *edges = tm_grow(b->edge, &b->room[EDGE], b->corners, sizeof *b->edge);
    b->edge = edges ? edges : b->edge;
    return edges && reserve(b, &b->node, NODE, b->corners) &&
           reserve(b, &b->fans, FANS, b->corners) &&
           reserve(b, &b->face_start, FACE_START, b->faces + 1) &&
           reserve(b, &b->corner, CORNER, b->corners) &&
           reserve(b, &b->face, FACE, b->corners) &&
           reserve(b, &b->slot, SLOT, tm_hash_slots(b->corners)) &&
           reserve(b, &b->parent, PARENT, b->corners);
}

/* An empty table for corners. */
static tm_hash_table table_of(tm_poly_boundary *b)
{
    const size_t slots = tm_hash_slots(b->corners);
    memset(b->slot, UINT8_MAX, slots * sizeof *b->slot);
    return (tm_hash_table){slots - 1, b->slot};
}

/* The node's number in the surface, a new one where it was not met yet. */
static uint32_t number_of(tm_poly_boundary *b, uint32_t node, const tm_hash_table *table)
{
    uint32_t *slot = tm_hash_slot(table, tm_hash(0, node));
    while (*slot != TM_HASH_FREE && b->node[*slot] != node)
        slot = tm_hash_next(table, slot);
    if (*slot == TM_HASH_FREE) {
        *slot = (uint32_t)b->nodes;
        b->fans[b->nodes] = 0;
        b->node[b->nodes++] = node;
    }
    return *slot;
}

static void list_corners(tm_poly_boundary *b, const tm_poly_arrays *mesh,
                         const uint32_t *facet, uint32_t cell)
{
    const tm_hash_table table = table_of(b);
    uint32_t corner = 0;
    for (uint32_t f = 0; f < b->faces; f++) {
        const uint32_t *side = mesh->side[facet[f]];
        const bool turned = cell != TM_NONE && side[0] != cell && side[1] == cell;
        const size_t start = mesh->facet_start[facet[f]];
        const size_t count = mesh->facet_start[facet[f] + 1] - start;
        b->face_start[f] = corner;
        for (size_t i = 0; i < count; i++) {
            const size_t at = turned && i > 0 ? count - i : i;
            const uint32_t v = number_of(b, mesh->facet_node[start + at], &table);
            b->fans[v]++;
            b->face[corner] = f;
            b->corner[corner++] = v;
        }
    }
    b->face_start[b->faces] = corner;
}

static tm_poly_edge *edge_of(tm_poly_boundary *b, uint32_t low, uint32_t high,
                             const tm_hash_table *table)
{
    uint32_t *slot = tm_hash_slot(table, tm_hash(tm_hash(0, low), high));
    while (*slot != TM_HASH_FREE &&
           (b->edge[*slot].end[0] != low || b->edge[*slot].end[1] != high))
        slot = tm_hash_next(table, slot);
    if (*slot == TM_HASH_FREE) {
        *slot = (uint32_t)b->edges;
        b->edge[b->edges++] = (tm_poly_edge){.end = {low, high},
                                             .corner = {TM_NONE, TM_NONE},
                                             .at_end = {TM_NONE, TM_NONE}};
    }
    return &b->edge[*slot];
}

/* Joins two trees; false where they were one. */
static bool join(uint32_t *parent, uint32_t i, uint32_t j)
{
    i = tm_set_root(parent, i);
    j = tm_set_root(parent, j);
    parent[i > j ? i : j] = i < j ? i : j;
    return i != j;
}

/* A face with a corner at the end of an edge is in the fan of the others there. */
static void join_fan(tm_poly_boundary *b, tm_poly_edge *e, size_t end, uint32_t corner)
{
    if (e->at_end[end] == TM_NONE)
        e->at_end[end] = corner;
    else if (join(b->parent, e->at_end[end], corner))
        b->fans[e->end[end]]--;
}

static void take_edge(tm_poly_boundary *b, uint32_t corner, uint32_t next,
                      const tm_hash_table *table)
{
    const uint32_t from = b->corner[corner], to = b->corner[next];
    const uint32_t back = from > to;
    tm_poly_edge *e = edge_of(b, back ? to : from, back ? from : to, table);
    if (e->corner[back] == TM_NONE)
        e->corner[back] = corner;
    e->along += !back;
    e->against += back;
    join_fan(b, e, back, corner);
    join_fan(b, e, !back, next);
}

static void start_forest(tm_poly_boundary *b, size_t trees)
{
    for (uint32_t i = 0; i < trees; i++)
        b->parent[i] = i;
}

static void list_edges(tm_poly_boundary *b)
{
    const tm_hash_table table = table_of(b);
    start_forest(b, b->corners);
    for (size_t f = 0; f < b->faces; f++) {
        const uint32_t first = b->face_start[f], end = b->face_start[f + 1];
        for (uint32_t i = first; i < end; i++)
            take_edge(b, i, i + 1 < end ? i + 1 : first, &table);
    }
}

static void count_pieces(tm_poly_boundary *b)
{
    start_forest(b, b->nodes);
    b->pieces = b->nodes;
    for (size_t e = 0; e < b->edges; e++)
        b->pieces -= join(b->parent, b->edge[e].end[0], b->edge[e].end[1]);
}

tm_status tm_poly_boundary_find(tm_poly_boundary *b, const tm_poly_arrays *mesh,
                                const uint32_t *facet, size_t facets, uint32_t cell,
                                tm_error *error)
{
    b->nodes = b->edges = b->corners = 0;
    b->faces = facets;
    for (size_t f = 0; f < facets; f++)
        b->corners += mesh->facet_start[facet[f] + 1] - mesh->facet_start[facet[f]];
    if (b->corners >= most_corners)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, ".facet",
                          "more than %zu corners of facets", most_corners - 1);
    if (!allocate(b))
        return tm_fail_memory(error);
    list_corners(b, mesh, facet, cell);
    list_edges(b);
    count_pieces(b);
    return TM_OK;
}

unsigned tm_poly_boundary_causes(const tm_poly_boundary *b)
{
    unsigned causes = 0;
    for (size_t e = 0; e < b->edges; e++)
        if (!tm_poly_edge_is_good(&b->edge[e]))
            causes |= 1u << TM_CAUSE_EDGE;
    for (size_t v = 0; v < b->nodes; v++)
        if (b->fans[v] != 1)
            causes |= 1u << TM_CAUSE_VERTEX;
    if (b->pieces != 1)
        causes |= 1u << TM_CAUSE_PIECES;
    if (b->nodes + b->faces != b->edges + 2)
        causes |= 1u << TM_CAUSE_EULER;
    return causes;
}
