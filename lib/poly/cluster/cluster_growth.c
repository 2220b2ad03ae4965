/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cluster_growth.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_growth_free(tm_growth *g)
{
    tm_polygon_edges_free(&g->edges);
    free(g->piece);
    free(g->member);
    free(g->queue);
    free(g->refused);
    free(g->box);
    free(g->normal);
    free(g->new_nodes);
    free(g->new_edges);
    free(g->node_in);
    free(g->edge_in);
    free(g->node_shared);
    free(g->edge_shared);
    free(g->shared);
    free(g->edge_first);
    free(g->plane);
    *g = (tm_growth){0};
}

tm_status tm_growth_start(tm_growth *g, const tm_cluster_mesh *mesh,
                          const tm_poly_options *options, const bool *kept,
                          tm_error *error)
{
    const tm_cell_faces *faces = mesh->faces;
    *g = (tm_growth){.mesh = mesh, .options = options, .kept = kept};
    tm_status status = tm_polygon_edges_find(&g->edges, faces->facets, faces->start,
                                             faces->node, mesh->nodes, NULL, 0, error);
    if (status != TM_OK)
        return status;
    g->piece = tm_new(faces->cells, sizeof *g->piece);
    g->node_in = calloc(mesh->nodes + 1, sizeof *g->node_in);
    g->node_shared = calloc(mesh->nodes + 1, sizeof *g->node_shared);
    g->edge_in = calloc(g->edges.edges + 1, sizeof *g->edge_in);
    g->edge_shared = calloc(g->edges.edges + 1, sizeof *g->edge_shared);
    g->refused = calloc(faces->cells + 1, sizeof *g->refused);
    g->edge_first = tm_new(g->edges.edges, sizeof *g->edge_first);
    if (!g->piece || !g->node_in || !g->node_shared || !g->edge_in || !g->edge_shared ||
        !g->edge_first || !g->refused ||
        (options->star && (!tm_growth_find_boxes(g) || !tm_growth_find_normals(g))))
        return tm_fail_memory(error);
    for (size_t c = 0; c < faces->cells; c++)
        g->piece[c] = TM_NONE;
    return TM_OK;
}

/* Stamps a node and an edge as those of the piece. */
static bool stamp(tm_growth *g, uint32_t v, uint32_t e)
{
    bool memory = true;
    if (g->node_in[v] != g->stamp_in)
        memory = tm_append(&g->new_nodes, &g->node_count, &g->node_room, v);
    if (g->edge_in[e] != g->stamp_in && memory)
        memory = tm_append(&g->new_edges, &g->edge_count, &g->edge_room, e);
    g->node_in[v] = g->stamp_in;
    g->edge_in[e] = g->stamp_in;
    return memory;
}

/* Puts a cell into the piece, and those beside it into the queue. */
static bool put(tm_growth *g, uint32_t c)
{
    const tm_cell_faces *faces = g->mesh->faces;
    if (!tm_append(&g->member, &g->size, &g->member_room, c))
        return false;
    g->piece[c] = g->id;
    g->version++;
    if (g->options->star)
        tm_growth_widen(g, c, g->low, g->high);
    for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1]; k++) {
        const uint32_t f = faces->cell_facet[k], other = tm_growth_across(g, f, c);
        for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++) {
            if (!stamp(g, faces->node[i], (uint32_t)g->edges.edge_of[i]))
                return false;
        }
        if (other != TM_NONE && !g->kept[f] && g->piece[other] != g->id &&
            !tm_append(&g->queue, &g->queued, &g->queue_room, other))
            return false;
    }
    return true;
}

bool tm_growth_begin(tm_growth *g, uint32_t id, const uint32_t *cell, size_t count)
{
    const tm_cell_faces *faces = g->mesh->faces;
    const uint32_t f = faces->cell_facet[faces->cell_start[cell[0]]];
    bool memory = true;
    memcpy(g->origin, g->mesh->xyz[faces->node[faces->start[f]]], sizeof g->origin);
    for (int x = 0; x < 3; x++) {
        g->low[x] = HUGE_VAL;
        g->high[x] = -HUGE_VAL;
    }
    g->id = id;
    g->size = g->queued = g->node_count = g->edge_count = 0;
    g->depth = -1;
    g->stamp_in++;
    for (size_t k = 0; k < count && memory; k++)
        memory = put(g, cell[k]);
    return memory;
}

/* Finds the facets that a cell shares with the piece; false where one is kept. */
static bool find_shared(tm_growth *g, uint32_t c, bool *memory)
{
    const tm_cell_faces *faces = g->mesh->faces;
    g->shares = 0;
    for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1]; k++) {
        const uint32_t f = faces->cell_facet[k];
        if (!tm_growth_has(g, tm_growth_across(g, f, c)))
            continue;
        *memory = tm_append(&g->shared, &g->shares, &g->shared_room, f);
        if (g->kept[f] || !*memory)
            return false;
    }
    return true;
}

/* Whether the shared facets are a disc; they are stamped. There is room for as many trees
 * after them. */
static bool is_disc(tm_growth *g)
{
    const tm_cell_faces *faces = g->mesh->faces;
    long euler = (long)g->shares;
    size_t sets = g->shares;
    g->stamp_shared++;
    uint32_t *tree = g->shared + g->shares;
    for (uint32_t k = 0; k < g->shares; k++) {
        const uint32_t f = g->shared[k];
        tree[k] = k;
        for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++) {
            const size_t e = g->edges.edge_of[i];
            const uint32_t v = faces->node[i];
            euler += g->node_shared[v] != g->stamp_shared;
            g->node_shared[v] = g->stamp_shared;
            if (g->edge_shared[e] != g->stamp_shared) {
                g->edge_shared[e] = g->stamp_shared;
                g->edge_first[e] = k;
                euler--;
            } else if (tm_set_root(tree, g->edge_first[e]) != tm_set_root(tree, k)) {
                tm_set_unite(tree, g->edge_first[e], k);
                sets--;
            }
        }
    }
    return sets == 1 && euler == 1;
}

/* Whether the cell has a node or an edge in common with the piece that is of no shared
 * facet. */
static bool touches_elsewhere(const tm_growth *g, uint32_t c)
{
    const tm_cell_faces *faces = g->mesh->faces;
    for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1]; k++) {
        const uint32_t f = faces->cell_facet[k];
        for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++) {
            const size_t e = g->edges.edge_of[i];
            const uint32_t v = faces->node[i];
            if ((g->node_in[v] == g->stamp_in && g->node_shared[v] != g->stamp_shared) ||
                (g->edge_in[e] == g->stamp_in && g->edge_shared[e] != g->stamp_shared))
                return true;
        }
    }
    return false;
}

/* Whether what a cell shares with the piece is a disc, and it stays a star. */
static bool meets_well(tm_growth *g, uint32_t c, bool *memory)
{
    if (!find_shared(g, c, memory) || g->shares == 0)
        return false;
    uint32_t *room =
        tm_grow(g->shared, &g->shared_room, 2 * g->shares, sizeof *g->shared);
    *memory = room;
    if (!room)
        return false;
    g->shared = room;
    return is_disc(g) && !touches_elsewhere(g, c) &&
           (!g->options->star || tm_growth_stays_star(g, c, memory));
}

/* Whether a cell can be added. */
static bool fits(tm_growth *g, uint32_t c, bool *memory)
{
    if (g->refused[c] == g->version || !meets_well(g, c, memory)) {
        g->refused[c] = g->version;
        return false;
    }
    return true;
}

bool tm_growth_grow(tm_growth *g, const uint32_t *label, uint32_t name)
{
    bool memory = true;
    for (size_t next = 0; next < g->queued && memory; next++) {
        const uint32_t c = g->queue[next];
        if (label[c] == name && g->piece[c] == TM_NONE && fits(g, c, &memory))
            memory = put(g, c);
    }
    return memory;
}

/* Takes the last cells out again, down to the piece as it was; they were of `old`. */
static void undo(tm_growth *g, const tm_growth *was, uint32_t old)
{
    for (size_t k = was->size; k < g->size; k++)
        g->piece[g->member[k]] = old;
    for (size_t k = 0; k < g->node_count; k++)
        g->node_in[g->new_nodes[k]] = 0;
    for (size_t k = 0; k < g->edge_count; k++)
        g->edge_in[g->new_edges[k]] = 0;
    g->version += g->size > was->size;
    g->size = was->size;
    g->queued = was->queued;
    g->depth = was->depth;
    memcpy(g->centre, was->centre, sizeof g->centre);
    memcpy(g->low, was->low, sizeof g->low);
    memcpy(g->high, was->high, sizeof g->high);
}

bool tm_growth_add(tm_growth *g, const uint32_t *cell, size_t count, bool *taken)
{
    const tm_growth was = *g;
    const uint32_t old = g->piece[cell[0]];
    bool memory = true;
    g->node_count = g->edge_count = 0;
    for (bool any = true; any && memory && g->size < was.size + count;) {
        any = false;
        for (size_t k = 0; k < count && memory; k++)
            if (g->piece[cell[k]] != g->id && fits(g, cell[k], &memory)) {
                memory = memory && put(g, cell[k]);
                any = true;
            }
    }
    *taken = g->size == was.size + count;
    if (!*taken)
        undo(g, &was, old);
    return memory;
}
