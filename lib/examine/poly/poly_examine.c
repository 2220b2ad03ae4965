/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_examine.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../base/sum.h"
#include "../../geom/vector.h"
#include "poly_boundary.h"
#include "poly_parts.h"

#include <stdlib.h>

enum { CHUNK = TM_POLY_CHUNK };

/* What a chunk of polyhedra adds to the examination. */
typedef struct examined {
    tm_sum volume;
    tm_defect_list inverted;
    tm_defect_list degenerate;
    tm_defect_list unclosed;
    tm_defect_list unoriented;
    tm_status status;
} examined;

typedef struct examining {
    const tm_poly_arrays *mesh;
    examined *chunk; /* one for each CHUNK of cells */
} examining;

static void examine_edge(examined *e, const tm_poly_boundary *b, uint32_t c,
                         const tm_poly_edge *edge)
{
    const uint32_t p = b->node[edge->end[0]], q = b->node[edge->end[1]];
    const uint32_t faces = edge->along + edge->against;
    const uint32_t place[TM_DEFECT_NUMBERS] = {c, p < q ? p : q, p < q ? q : p, faces};
    if (faces != 2)
        tm_defect_add(&e->unclosed, place);
    else if (edge->along != 1)
        tm_defect_add(&e->unoriented, place);
}

static void examine_cell(examined *e, const tm_poly_arrays *mesh, tm_poly_boundary *b,
                         uint32_t c)
{
    const size_t start = mesh->cell_start[c];
    e->status = tm_poly_boundary_find(b, mesh, mesh->cell_facet + start,
                                      mesh->cell_start[c + 1] - start, c, NULL);
    if (e->status != TM_OK)
        return;
    for (size_t i = 0; i < b->edges; i++)
        examine_edge(e, b, c, &b->edge[i]);
    double volume;
    const int sign = tm_poly_sign(b, mesh->xyz, &volume);
    tm_sum_add(&e->volume, volume);
    if (sign < 0)
        tm_defect_add(&e->inverted, (uint32_t[TM_DEFECT_NUMBERS]){c});
    else if (sign == 0)
        tm_defect_add(&e->degenerate, (uint32_t[TM_DEFECT_NUMBERS]){c, TM_NONE});
}

static void examine_chunk(void *context, size_t chunk)
{
    const examining *x = context;
    const size_t first = chunk * CHUNK, left = x->mesh->cells - first;
    const size_t end = first + (left < CHUNK ? left : CHUNK);
    tm_poly_boundary b = {0};
    examined e = {.status = TM_OK};
    for (size_t c = first; c < end && e.status == TM_OK; c++)
        examine_cell(&e, x->mesh, &b, (uint32_t)c);
    tm_poly_boundary_free(&b);
    x->chunk[chunk] = e;
}

tm_status tm_poly_examine_cells(tm_examination *found, const tm_poly_arrays *mesh,
                                tm_sum *volume, unsigned threads, tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(mesh->cells, CHUNK);
    examining x = {mesh, tm_new(chunks, sizeof *x.chunk)};
    if (!x.chunk)
        return tm_fail_memory(error);
    tm_parallel(threads, chunks, examine_chunk, &x);
    tm_status status = TM_OK;
    for (size_t i = 0; i < chunks; i++) {
        const examined *e = &x.chunk[i];
        status = e->status != TM_OK ? e->status : status;
        volume[i] = e->volume;
        tm_defect_add_list(&found->defect[TM_INVERTED], &e->inverted);
        tm_defect_add_list(&found->defect[TM_DEGENERATE], &e->degenerate);
        tm_defect_add_list(&found->defect[TM_UNCLOSED_EDGE], &e->unclosed);
        tm_defect_add_list(&found->defect[TM_UNORIENTED_EDGE], &e->unoriented);
    }
    free(x.chunk);
    return status == TM_OK ? TM_OK : tm_fail_memory(error);
}

static void examine_surface(tm_examination *found, const tm_poly_boundary *b,
                            uint32_t first, uint32_t past)
{
    for (size_t i = 0; i < b->edges; i++) {
        const tm_poly_edge *e = &b->edge[i];
        const uint32_t p = b->node[e->end[0]], q = b->node[e->end[1]];
        const uint32_t faces = e->along + e->against;
        const uint32_t place[TM_DEFECT_NUMBERS] = {p < q ? p : q, p < q ? q : p, faces};
        if (place[0] < first || place[0] >= past)
            continue;
        if (faces % 2 == 1)
            tm_defect_add(&found->defect[TM_OPEN_EDGE], place);
        if (faces > 2)
            tm_defect_add(&found->defect[TM_NON_MANIFOLD_EDGE], place);
    }
    for (size_t v = 0; v < b->nodes; v++)
        if (b->fans[v] > 1 && b->node[v] >= first && b->node[v] < past)
            tm_defect_add(&found->defect[TM_NON_MANIFOLD_VERTEX],
                          (uint32_t[TM_DEFECT_NUMBERS]){b->node[v], b->fans[v]});
}

tm_status tm_poly_examine_boundary(tm_examination *found, const tm_poly_arrays *mesh,
                                   uint32_t first, uint32_t past, tm_error *error)
{
    uint32_t *facet = tm_new(mesh->facets, sizeof *facet);
    if (!facet)
        return tm_fail_memory(error);
    size_t facets = 0;
    for (uint32_t f = 0; f < mesh->facets; f++)
        if (mesh->side[f][1] == TM_NONE)
            facet[facets++] = f;
    tm_poly_boundary b = {0};
    const tm_status status =
        tm_poly_boundary_find(&b, mesh, facet, facets, TM_NONE, error);
    if (status == TM_OK)
        examine_surface(found, &b, first, past);
    tm_poly_boundary_free(&b);
    free(facet);
    return status;
}

void tm_poly_add_boundary_area(tm_sum *sum, const tm_poly_arrays *mesh)
{
    for (uint32_t f = 0; f < mesh->facets; f++)
        if (mesh->side[f][1] == TM_NONE) {
            const size_t start = mesh->facet_start[f];
            double normal[3];
            tm_polygon_area(mesh->xyz, mesh->facet_node + start,
                            mesh->facet_start[f + 1] - start, normal);
            tm_sum_add(sum, tm_norm(normal));
        }
}

static size_t count_used_nodes(const tm_poly_arrays *mesh, bool *used)
{
    const size_t corners = mesh->facets > 0 ? mesh->facet_start[mesh->facets] : 0;
    size_t count = 0;
    for (size_t i = 0; i < corners; i++) {
        count += !used[mesh->facet_node[i]];
        used[mesh->facet_node[i]] = true;
    }
    return count;
}

tm_status tm_poly_examine_facets(tm_examination *found, const tm_poly_arrays *mesh,
                                 tm_error *error)
{
    uint32_t *parent = tm_new(mesh->cells, sizeof *parent);
    bool *used = calloc(mesh->nodes + 1, sizeof *used);
    size_t edges = 0;
    tm_status status = parent && used ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_poly_match_facets(found, mesh, parent, error);
    if (status == TM_OK)
        status = tm_poly_find_edges(NULL, &edges, mesh, 0, (uint32_t)mesh->nodes, error);
    if (status == TM_OK) {
        const size_t count = count_used_nodes(mesh, used);
        found->unused_nodes = mesh->nodes - count;
        found->euler = (int64_t)count - (int64_t)edges + (int64_t)mesh->facets -
                       (int64_t)mesh->cells;
        for (uint32_t c = 0; c < mesh->cells; c++)
            found->components += parent[c] == c;
    }
    free(parent);
    free(used);
    return status;
}

/* Volumes and signs. */
static tm_status examine_cells(tm_examination *found, const tm_poly_arrays *mesh,
                               unsigned threads, tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(mesh->cells, CHUNK);
    tm_sum *volume = tm_new(chunks, sizeof *volume);
    const tm_status status =
        volume ? tm_poly_examine_cells(found, mesh, volume, threads, error)
               : tm_fail_memory(error);
    if (status == TM_OK)
        found->volume = tm_sum_all(volume, chunks);
    free(volume);
    return status;
}

tm_examination tm_poly_examination(size_t nodes, size_t cells)
{
    return (tm_examination){.element = "polyhedron",
                            .elements = "polyhedra",
                            .polyhedra = true,
                            .nodes = nodes,
                            .element_count = cells};
}

tm_status tm_poly_examine(tm_examination *found, const tm_poly_arrays *mesh,
                          unsigned threads, tm_error *error)
{
    *found = tm_poly_examination(mesh->nodes, mesh->cells);
    tm_sum area = {0};
    tm_status status = examine_cells(found, mesh, threads, error);
    if (status == TM_OK)
        status = tm_poly_examine_facets(found, mesh, error);
    if (status == TM_OK)
        status = tm_poly_find_repeated(found, mesh, 0, (uint32_t)mesh->nodes, error);
    if (status == TM_OK)
        status = tm_poly_examine_boundary(found, mesh, 0, (uint32_t)mesh->nodes, error);
    tm_poly_add_boundary_area(&area, mesh);
    found->area = tm_sum_value(area);
    if (status == TM_OK)
        status = tm_examine_nodes(found, mesh->xyz, mesh->nodes, error);
    return status;
}
