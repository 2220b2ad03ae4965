/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_trace.h"

#include "../../base/array.h"
#include "../forest/octree_stream.h"

#include <stdlib.h>
#include <string.h>

static tm_status copy_nodes(const tm_repair_state *state, tm_stream *stream,
                            tm_error *error)
{
    tm_block *node = tm_stream_add(stream, ".node");
    if (!node)
        return tm_fail_memory(error);
    node->attributes = 1;
    const tm_status status = tm_block_allocate(node, state->mesh.nodes, 0, error);
    if (status != TM_OK)
        return status;
    memcpy(node->real, state->mesh.xyz, state->mesh.nodes * sizeof *state->mesh.xyz);
    for (size_t v = 0; v < state->mesh.nodes; v++)
        node->attribute[v] =
            state->rule[v].off_surface ? -(double)state->on[v] : (double)state->on[v];
    return TM_OK;
}

static tm_status copy_elements(const tm_mixed_mesh *mesh, tm_stream *stream,
                               tm_error *error)
{
    tm_block *mix = tm_stream_add(stream, ".mix");
    if (!mix)
        return tm_fail_memory(error);
    const size_t items = mesh->start[mesh->elements];
    const tm_status status = tm_block_allocate(mix, mesh->elements, items, error);
    if (status != TM_OK)
        return status;
    memcpy(mix->start, mesh->start, (mesh->elements + 1) * sizeof *mesh->start);
    memcpy(mix->item, mesh->item, items * sizeof *mesh->item);
    return TM_OK;
}

static tm_status copy_ids(const tm_repair_state *state, tm_block *octant, tm_error *error)
{
    octant->attribute = tm_new(octant->count, sizeof *octant->attribute);
    if (!octant->attribute)
        return tm_fail_memory(error);
    octant->attributes = 1;
    for (size_t o = 0; o < octant->count; o++)
        octant->attribute[o] = state->id[o];
    return TM_OK;
}

/* .root and .octant: leaves in the order of their rows. */
static tm_status copy_octants(const tm_repair_state *state, tm_stream *stream,
                              tm_error *error)
{
    enum { FIRST = 4, PAST, COLUMNS };
    const tm_octree *octree = &state->octree;
    uint32_t *none = calloc(octree->leaves + 1, sizeof *none);
    if (!none)
        return tm_fail_memory(error);
    const tm_status status =
        tm_octree_to_stream(octree, tm_octree_deepest(octree), none, stream, error);
    free(none);
    tm_block *octant = tm_stream_find(stream, ".octant");
    if (status != TM_OK)
        return status;
    uint32_t *ordered = calloc(octree->leaves * COLUMNS + 1, sizeof *ordered);
    if (!ordered)
        return tm_fail_memory(error);
    size_t rows = 0;
    for (size_t l = 0; l < octree->leaves; l++)
        if (state->row[l] < octree->leaves) {
            memcpy(ordered + state->row[l] * COLUMNS, octant->integer + l * COLUMNS,
                   COLUMNS * sizeof *ordered);
            rows += 1;
        }
    octant->count = rows;
    free(octant->integer);
    octant->integer = ordered;
    for (size_t e = 0; e < state->mesh.elements; e++) {
        const uint32_t o = state->octant[e];
        if (o == TM_NONE)
            continue;
        uint32_t *row = ordered + o * COLUMNS;
        if (row[PAST] == 0)
            row[FIRST] = (uint32_t)e;
        row[PAST] = (uint32_t)e + 1;
    }
    return state->id ? copy_ids(state, octant, error) : TM_OK;
}

static tm_status copy_surface(const tm_surface *surface, tm_stream *stream,
                              tm_error *error)
{
    tm_block *node = tm_stream_add(stream, "surface.node");
    tm_status status =
        node ? tm_block_allocate(node, surface->nodes, 0, error) : tm_fail_memory(error);
    if (status != TM_OK)
        return status;
    memcpy(node->real, surface->xyz, surface->nodes * sizeof *surface->xyz);
    tm_block *face = tm_stream_add(stream, "surface.face");
    status = face ? tm_block_allocate(face, surface->triangles, 0, error)
                  : tm_fail_memory(error);
    if (status == TM_OK)
        memcpy(face->integer, surface->triangle,
               surface->triangles * sizeof *surface->triangle);
    return status;
}

tm_status tm_repair_trace(const tm_repair_state *state, const tm_surface *surface,
                          tm_stream *stream, tm_error *error)
{
    tm_status status = copy_nodes(state, stream, error);
    if (status == TM_OK)
        status = copy_elements(&state->mesh, stream, error);
    if (status == TM_OK && state->octree.leaves > 0)
        status = copy_octants(state, stream, error);
    if (status == TM_OK && surface)
        status = copy_surface(surface, stream, error);
    return status;
}
