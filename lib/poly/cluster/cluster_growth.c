/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cluster_growth.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../geom/kernel.h"
#include "../../geom/vector.h"

#include <stdlib.h>
#include <string.h>

/* The kernel's ball has at least this part of the extent as its radius, or what is asked
 * for. */
static const double least_ball = 1e-4, least_radius = 1e-8;

void tm_growth_free(tm_growth *g)
{
    tm_polygon_edges_free(&g->edges);
    free(g->piece);
    free(g->member);
    free(g->queue);
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
    g->edge_first = tm_new(g->edges.edges, sizeof *g->edge_first);
    if (!g->piece || !g->node_in || !g->node_shared || !g->edge_in || !g->edge_shared ||
        !g->edge_first)
        return tm_fail_memory(error);
    for (size_t c = 0; c < faces->cells; c++)
        g->piece[c] = TM_NONE;
    return TM_OK;
}

/* The cell across a facet, or TM_NONE. */
static uint32_t across(const tm_growth *g, uint32_t f, uint32_t c)
{
    const uint32_t *side = g->mesh->faces->side[f];
    return side[0] == c ? side[1] : side[0];
}

static bool is_in(const tm_growth *g, uint32_t c)
{
    return c != TM_NONE && g->piece[c] == g->id;
}

/* Puts a cell into the piece, and those beside it into the queue. */
static bool put(tm_growth *g, uint32_t c)
{
    const tm_cell_faces *faces = g->mesh->faces;
    if (!tm_append(&g->member, &g->size, &g->member_room, c))
        return false;
    g->piece[c] = g->id;
    for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1]; k++) {
        const uint32_t f = faces->cell_facet[k], other = across(g, f, c);
        for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++) {
            g->node_in[faces->node[i]] = g->stamp_in;
            g->edge_in[g->edges.edge_of[i]] = g->stamp_in;
        }
        if (other != TM_NONE && !g->kept[f] && g->piece[other] != g->id &&
            !tm_append(&g->queue, &g->queued, &g->queue_room, other))
            return false;
    }
    return true;
}

bool tm_growth_begin(tm_growth *g, uint32_t id, const uint32_t *cell, size_t count)
{
    bool memory = true;
    g->id = id;
    g->size = g->queued = 0;
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
        if (!is_in(g, across(g, f, c)))
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

/* The plane of a facet, seen from cell c outward, through the innermost of its nodes,
 * from an origin; false where it has no area. */
static bool plane_of(const tm_growth *g, uint32_t f, uint32_t c, const double origin[3],
                     double plane[4])
{
    const tm_cell_faces *faces = g->mesh->faces;
    const uint32_t *node = faces->node + faces->start[f];
    const size_t count = faces->start[f + 1] - faces->start[f];
    double part[3], to[3];
    memset(plane, 0, 3 * sizeof *plane);
    for (size_t i = 1; i + 1 < count; i++) {
        tm_triangle_normal(part, g->mesh->xyz[node[0]], g->mesh->xyz[node[i]],
                           g->mesh->xyz[node[i + 1]]);
        for (int x = 0; x < 3; x++)
            plane[x] += tm_facet_is_outward(faces, f, c) ? part[x] : -part[x];
    }
    const double length = tm_norm(plane);
    for (int x = 0; x < 3; x++)
        plane[x] /= length;
    plane[3] = HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        tm_subtract(to, g->mesh->xyz[node[i]], origin);
        plane[3] = fmin(plane[3], tm_dot(plane, to));
    }
    return length > 0;
}

/* Collects the planes of the piece with cell c, and its box; false where one has none. */
static bool collect_planes(tm_growth *g, uint32_t c, size_t *count, double low[3],
                           double high[3], bool *memory)
{
    const tm_cell_faces *faces = g->mesh->faces;
    const double *origin =
        g->mesh->xyz[faces->node[faces->start[faces->cell_facet[faces->cell_start[c]]]]];
    *count = 0;
    for (size_t m = 0; m <= g->size; m++) {
        const uint32_t cell = m < g->size ? g->member[m] : c;
        const size_t start = faces->cell_start[cell], end = faces->cell_start[cell + 1];
        double(*plane)[4] =
            tm_grow(g->plane, &g->plane_room, *count + end - start, sizeof *plane);
        if (!plane) {
            *memory = false;
            return false;
        }
        g->plane = plane;
        for (size_t k = start; k < end; k++) {
            const uint32_t f = faces->cell_facet[k], other = across(g, f, cell);
            if (is_in(g, other) || other == c)
                continue;
            for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++)
                for (int x = 0; x < 3; x++) {
                    low[x] = fmin(low[x], g->mesh->xyz[faces->node[i]][x]);
                    high[x] = fmax(high[x], g->mesh->xyz[faces->node[i]][x]);
                }
            if (!plane_of(g, f, cell, origin, plane[(*count)++]))
                return false;
        }
    }
    return true;
}

static bool stays_star(tm_growth *g, uint32_t c, bool *memory)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    double centre[3], radius;
    size_t count;
    const double least = g->options->star == TM_STAR_RADIUS
                             ? fmax(g->options->radius, least_radius)
                             : least_ball;
    return collect_planes(g, c, &count, low, high, memory) &&
           tm_kernel_ball((const double(*)[4])g->plane, count, centre, &radius) &&
           radius >= least * sqrt(tm_distance2(low, high));
}

static bool fits(tm_growth *g, uint32_t c, bool *memory)
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
           (!g->options->star || stays_star(g, c, memory));
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

bool tm_growth_add(tm_growth *g, const uint32_t *cell, size_t count, bool *taken)
{
    const size_t was = g->size, queued = g->queued;
    const uint32_t old = g->piece[cell[0]];
    bool memory = true;
    for (bool any = true; any && memory && g->size < was + count;) {
        any = false;
        for (size_t k = 0; k < count && memory; k++)
            if (g->piece[cell[k]] != g->id && fits(g, cell[k], &memory)) {
                memory = memory && put(g, cell[k]);
                any = true;
            }
    }
    *taken = g->size == was + count;
    if (*taken || !memory)
        return memory;
    for (size_t k = was; k < g->size; k++)
        g->piece[g->member[k]] = old;
    if (g->size == was)
        return true;
    /* What was put in is stamped: the piece as it was is stamped anew. */
    g->stamp_in++;
    g->size = 0;
    for (size_t k = 0; k < was && memory; k++)
        memory = put(g, g->member[k]);
    g->queued = queued;
    return memory;
}
