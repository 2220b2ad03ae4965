/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_stream.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../../element/shape.h"
#include "../../format/oct.h"
#include "../../mesh/mixed_stream.h"
#include "../../stream/coordinates.h"
#include "../layer/octree_mesh_stream.h"
#include "../forest/octree_stream.h"
#include "repair_boundary.h"
#include "repair_steps.h"
#include "../../mesh/mixed_boundary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static tm_status allocate(tm_repair_state *state, tm_error *error)
{
    const size_t nodes = state->mesh.nodes, elements = state->mesh.elements;
    state->rule = calloc(nodes + 1, sizeof *state->rule);
    state->on = calloc(nodes + 1, sizeof *state->on);
    state->octant = tm_new(elements, sizeof *state->octant);
    state->origin = tm_new(elements, sizeof *state->origin);
    if (!state->rule || !state->on || !state->octant || !state->origin)
        return tm_fail_memory(error);
    for (size_t e = 0; e < elements; e++) {
        state->octant[e] = TM_NONE;
        state->origin[e] = (uint32_t)e;
    }
    return TM_OK;
}

/* The octants that elements are in, and their ids, where the attribute is that. */
static tm_status find_octants(tm_repair_state *state, const tm_block *octant,
                              unsigned base, tm_error *error)
{
    enum { FIRST = 4, PAST, COLUMNS };
    for (size_t o = 0; o < octant->count; o++) {
        const uint32_t *row = octant->integer + o * COLUMNS;
        for (uint32_t e = row[FIRST]; e < row[PAST]; e++)
            state->octant[e] = (uint32_t)o;
    }
    if (octant->attributes == 0)
        return TM_OK;
    const tm_status status = tm_octant_ids(&state->id, octant, base, error);
    return status == TM_ERROR_INPUT ? TM_OK : status;
}

/* Without the octree the mesh can be optimised still. */
static tm_status find_octree(tm_repair_state *state, const tm_stream *stream,
                             const tm_surface *surface, tm_repair_notes *notes,
                             tm_error *error)
{
    if (!surface)
        return TM_OK;
    tm_error cause;
    const tm_status status =
        tm_octree_read_blocks(&state->octree, stream, surface, &state->row, &cause);
    if (status == TM_ERROR_INPUT)
        notes->no_octree = cause;
    else if (status != TM_OK)
        return tm_fail_as(error, &cause);
    return TM_OK;
}

/* Marks the nodes of the boundary. */
static tm_status find_boundary(const tm_mixed_mesh *mesh, bool *where, tm_error *error)
{
    uint32_t *face;
    size_t faces;
    const tm_status status = tm_mixed_boundary_faces(mesh, &face, &faces, error);
    for (size_t f = 0; status == TM_OK && f < faces; f++) {
        uint32_t node[4];
        const size_t k = tm_mixed_face_of(mesh, face[f], node);
        for (size_t i = 0; i < k; i++)
            where[node[i]] = true;
    }
    free(face);
    return status;
}

/* Whether a value can be the place of a node that is on the boundary, or is not. */
static bool is_place(double value, bool boundary)
{
    return boundary
               ? fabs(value) == TM_NODE_ON_PATCH || fabs(value) == TM_NODE_ON_CURVE ||
                     fabs(value) == TM_NODE_ON_CORNER
               : value == TM_NODE_INSIDE;
}

bool tm_repair_are_places(const tm_block *node, const bool *where)
{
    if (node->attributes != 1)
        return false;
    for (size_t v = 0; v < node->count; v++)
        if (!is_place(node->attribute[v], where[v]))
            return false;
    return true;
}

/* Marks the nodes of elements of several regions, which the first attribute is. */
static tm_status find_interfaces(const tm_mixed_mesh *mesh, const tm_block *mix,
                                 bool *where, tm_error *error)
{
    const size_t k = mix->attributes;
    uint32_t *first = tm_new(mesh->nodes, sizeof *first);
    if (!first)
        return tm_fail_memory(error);
    for (size_t v = 0; v < mesh->nodes; v++)
        first[v] = TM_NONE;
    for (size_t e = 0; e < mesh->elements; e++)
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
            uint32_t *f = &first[mesh->item[i]];
            if (*f == TM_NONE)
                *f = (uint32_t)e;
            where[mesh->item[i]] |= mix->attribute[k * e] != mix->attribute[k * *f];
        }
    free(first);
    return TM_OK;
}

/* Whether the attribute of .node is the place of nodes that are marked; or it is if those
 * between regions are, too. */
static tm_status find_places(const tm_repair_state *state, const tm_block *node,
                             const tm_block *mix, bool *where, tm_repair_notes *notes,
                             tm_error *error)
{
    notes->attributed = tm_repair_are_places(node, where);
    if (notes->attributed || mix->attributes == 0)
        return TM_OK;
    bool *both = tm_new(state->mesh.nodes, sizeof *both);
    if (!both)
        return tm_fail_memory(error);
    memcpy(both, where, state->mesh.nodes * sizeof *both);
    const tm_status status = find_interfaces(&state->mesh, mix, both, error);
    if (status == TM_OK && tm_repair_are_places(node, both)) {
        notes->attributed = notes->regions = true;
        memcpy(where, both, state->mesh.nodes * sizeof *both);
    }
    free(both);
    return status;
}

static void hold_all(tm_repair_state *state, const bool *where)
{
    for (size_t v = 0; v < state->mesh.nodes; v++) {
        state->on[v] = where[v] ? TM_NODE_ON_PATCH : TM_NODE_INSIDE;
        state->rule[v] = (tm_node_rule){
            .where = TM_NONE, .freedom = where[v] ? TM_MOVES_NOT : TM_MOVES_FREELY};
    }
}

static tm_status find_rules(tm_repair_state *state, const tm_stream *stream,
                            const tm_surface *surface, tm_repair_notes *notes,
                            tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *mix = tm_stream_find(stream, ".mix");
    bool *where = calloc(state->mesh.nodes + 1, sizeof *where);
    if (!where)
        return tm_fail_memory(error);
    tm_status status = find_boundary(&state->mesh, where, error);
    if (status == TM_OK)
        status = find_places(state, node, mix, where, notes, error);
    if (status == TM_OK && surface)
        status = tm_repair_find_rules(surface, state->mesh.nodes,
                                      (const double(*)[3])state->mesh.xyz,
                                      notes->attributed ? node->attribute : NULL, where,
                                      state->rule, state->on, error);
    else if (status == TM_OK)
        hold_all(state, where);
    free(where);
    return status;
}

tm_status tm_repair_from_stream(tm_repair_state *state, tm_stream *stream,
                                tm_error *error)
{
    *state = (tm_repair_state){0};
    tm_status status = tm_stream_check_coordinates(stream, error);
    if (status == TM_OK)
        status = tm_mixed_mesh_from_stream(&state->mesh, stream, error);
    if (status == TM_OK && state->mesh.elements == 0)
        status = tm_fail(error, TM_ERROR_INPUT,
                         "the stream has no elements (the blocks .node and .mix)");
    if (status == TM_OK)
        status = allocate(state, error);
    const tm_block *octant = tm_stream_find(stream, ".octant");
    return status == TM_OK && octant ? find_octants(state, octant, stream->base, error)
                                     : status;
}

bool tm_repair_says_none_held(const tm_block *node)
{
    if (node->attributes != 1)
        return false;
    for (size_t v = 0; v < node->count; v++)
        if (!is_place(node->attribute[v], node->attribute[v] != 0) ||
            node->attribute[v] < 0)
            return false;
    return true;
}

bool tm_repair_is_needed(const tm_repair_state *state, const tm_stream *stream,
                         double threshold)
{
    return (tm_stream_find(stream, "surface.node") &&
            !tm_repair_says_none_held(tm_stream_find(stream, ".node"))) ||
           tm_repair_measure(state, threshold).bad > 0;
}

tm_status tm_repair_prepare(tm_repair_state *state, const tm_stream *stream,
                            const tm_surface *surface, tm_repair_notes *notes,
                            tm_error *error)
{
    *notes = (tm_repair_notes){0};
    tm_status status = find_octree(state, stream, surface, notes, error);
    if (status == TM_OK)
        status = find_rules(state, stream, surface, notes, error);
    if (status != TM_OK || !notes->regions)
        return status;
    tm_octree_free(&state->octree);
    tm_fail(&notes->no_octree, TM_ERROR_INPUT,
            "octants of several regions cannot be split");
    return TM_OK;
}
