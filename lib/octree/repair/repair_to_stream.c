/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_stream.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../layer/octree_mesh_stream.h"
#include "../forest/octree_stream.h"
#include "repair_facets.h"
#include "../../mesh/mixed_boundary.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *renew(void **array, size_t count, size_t size)
{
    free(*array);
    return *array = calloc(count + 1, size);
}

/* Writes the places of nodes into the attribute of .node. */
static void set_places(const tm_repair_state *state, tm_block *node)
{
    for (size_t v = 0; v < node->count; v++)
        node->attribute[v] =
            state->rule[v].off_surface ? -(double)state->on[v] : (double)state->on[v];
}

/* More rows of .node: nodes that were added are nothing special. */
static tm_status extend_nodes(tm_block *node, size_t nodes, tm_error *error)
{
    const size_t old = node->count;
    if (node->attributes > 0) {
        double *grown =
            realloc(node->attribute, (nodes * node->attributes + 1) * sizeof *grown);
        if (!grown)
            return tm_fail_memory(error);
        memset(grown + old * node->attributes, 0,
               (nodes - old) * node->attributes * sizeof *grown);
        node->attribute = grown;
    }
    if (node->markers) {
        int32_t *grown = realloc(node->marker, (nodes + 1) * sizeof *grown);
        if (!grown)
            return tm_fail_memory(error);
        memset(grown + old, 0, (nodes - old) * sizeof *grown);
        node->marker = grown;
    }
    return TM_OK;
}

/* An element has the attributes of the one that it is a part of. */
static tm_status spread_elements(const tm_repair_state *state, tm_block *mix,
                                 tm_error *error)
{
    const size_t k = mix->attributes, elements = state->mesh.elements;
    if (k > 0) {
        double *to = tm_new(elements * k, sizeof *to);
        if (!to)
            return tm_fail_memory(error);
        for (size_t e = 0; e < elements; e++)
            memcpy(to + e * k, mix->attribute + state->origin[e] * k, k * sizeof *to);
        free(mix->attribute);
        mix->attribute = to;
    }
    return TM_OK;
}

/* first[i]: the first part of element i, or of one behind it. [elements of old + 1] */
static uint32_t *find_first(const tm_repair_state *state, size_t old)
{
    uint32_t *first = tm_new(old + 1, sizeof *first);
    size_t e = 0;
    for (size_t i = 0; first && i <= old; i++) {
        while (e < state->mesh.elements && state->origin[e] < i)
            e++;
        first[i] = (uint32_t)e;
    }
    return first;
}

static void shift_octants(tm_block *octant, const uint32_t *first)
{
    enum { FIRST = 4, PAST, COLUMNS };
    for (size_t o = 0; octant && o < octant->count; o++) {
        uint32_t *row = octant->integer + o * COLUMNS;
        row[FIRST] = first[row[FIRST]];
        row[PAST] = first[row[PAST]];
    }
}

/* Whether a block stays where elements, or nodes too, are others. */
static bool stays(const tm_block *block, bool remade)
{
    if (block->name[0] != '.')
        return true; /* of another part of the stream */
    switch (block->kind) {
    case TM_NODE:
    case TM_MIX:
    case TM_OCTANT:
    case TM_ROOT:
    case TM_FACET:
    case TM_GROUP:
        return true;
    case TM_FACE:
    case TM_EDGE:
        return !remade; /* they refer to nodes only */
    default:
        return false;
    }
}

static bool goes(const tm_block *block, const void *remade)
{
    return !stays(block, *(const bool *)remade);
}

static void note_dropped(tm_repair_notes *notes, const char *name)
{
    const size_t used = strlen(notes->dropped);
    snprintf(notes->dropped + used, sizeof notes->dropped - used, "%s%s",
             used > 0 ? ", " : "", name);
}

static void remove_others(tm_stream *stream, bool remade, tm_repair_notes *notes)
{
    for (size_t b = stream->blocks; b-- > 0;)
        if (!stays(&stream->block[b], remade))
            note_dropped(notes, stream->block[b].name);
    tm_stream_remove_if(stream, goes, &remade);
}

static tm_status give_divided(tm_repair_state *state, tm_stream *stream,
                              tm_repair_notes *notes, tm_error *error)
{
    remove_others(stream, false, notes);
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *mix = tm_stream_find(stream, ".mix");
    uint32_t *first = find_first(state, mix->count);
    if (!first)
        return tm_fail_memory(error);
    shift_octants(tm_stream_find(stream, ".octant"), first);
    free(first);
    tm_status status =
        tm_repair_move_facets(tm_stream_find(stream, ".facet"), &state->mesh, error);
    if (status == TM_OK)
        status = extend_nodes(node, state->mesh.nodes, error);
    return status == TM_OK ? spread_elements(state, mix, error) : status;
}

/* The level of its octant is an element's attribute again, if it was. */
static tm_status give_levels(const tm_repair_state *state, tm_block *mix, bool levels,
                             tm_error *error)
{
    mix->attributes = levels ? 1 : 0;
    if (!renew((void **)&mix->attribute, levels ? state->mesh.elements : 0,
               sizeof *mix->attribute))
        return tm_fail_memory(error);
    for (size_t e = 0; levels && e < state->mesh.elements; e++)
        mix->attribute[e] = state->octree.leaf[state->octant[e]].level;
    return TM_OK;
}

/* Whether the only attribute of .mix is the level of the octant. */
static bool has_levels(const tm_block *mix, const tm_block *octant)
{
    enum { FIRST = 4, PAST, COLUMNS };
    if (mix->attributes != 1 || !octant)
        return false;
    for (size_t o = 0; o < octant->count; o++) {
        const uint32_t *row = octant->integer + o * COLUMNS;
        for (uint32_t e = row[FIRST]; e < row[PAST]; e++)
            if (mix->attribute[e] != row[0])
                return false;
    }
    return true;
}

static tm_status give_octants(const tm_repair_state *state, tm_stream *stream,
                              tm_error *error)
{
    uint32_t *first = calloc(state->octree.leaves + 1, sizeof *first);
    if (!first)
        return tm_fail_memory(error);
    for (size_t e = 0; e < state->mesh.elements; e++)
        first[state->octant[e] + 1]++;
    for (size_t l = 0; l < state->octree.leaves; l++)
        first[l + 1] += first[l];
    tm_stream_remove(stream, tm_stream_find(stream, ".octant"));
    tm_stream_remove(stream, tm_stream_find(stream, ".root"));
    const tm_status status = tm_octree_to_stream(
        &state->octree, tm_octree_deepest(&state->octree), first, stream, error);
    free(first);
    return status;
}

/* The boundary faces with the markers of the triangles closest to their middles. */
static tm_status give_facets(const tm_repair_state *state, const tm_surface *surface,
                             tm_block *facet, tm_error *error)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    uint32_t *face;
    size_t faces;
    tm_status status = tm_mixed_boundary_faces(mesh, &face, &faces, error);
    if (status == TM_OK)
        status = tm_block_allocate(facet, faces, 4 * faces, error);
    size_t items = 0;
    tm_surface_point at = {.triangle = TM_NONE};
    for (size_t f = 0; status == TM_OK && f < faces; f++) {
        uint32_t node[4];
        const size_t k = tm_mixed_face_of(mesh, face[f], node);
        double middle[3] = {0, 0, 0};
        facet->start[f] = items;
        for (size_t i = 0; i < k; i++) {
            facet->item[items++] = node[i];
            for (int j = 0; j < 3; j++)
                middle[j] += mesh->xyz[node[i]][j] / (double)k;
        }
        facet->start[f + 1] = items;
        tm_surface_closest(surface, middle, TM_NONE, &at);
        facet->integer[2 * f] = face[f] >> TM_FACE_SHIFT;
        facet->integer[2 * f + 1] = TM_NONE;
        facet->marker[f] = surface->marker[at.triangle];
    }
    free(face);
    return status;
}

/* Facets of nothing but the boundary are made anew; others are of elements that are gone.
 */
static bool is_boundary(const tm_block *facet)
{
    for (size_t f = 0; f < facet->count; f++)
        if (facet->integer[2 * f + 1] != TM_NONE)
            return false;
    return true;
}

static tm_status give_remade(tm_repair_state *state, tm_stream *stream,
                             const tm_surface *surface, tm_repair_notes *notes,
                             tm_error *error)
{
    remove_others(stream, true, notes);
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *mix = tm_stream_find(stream, ".mix");
    const bool levels = has_levels(mix, tm_stream_find(stream, ".octant"));
    if (!levels && mix->attributes > 0)
        note_dropped(notes, "attributes of .mix");
    if (node->attributes > 1) /* the first says what a node is on */
        note_dropped(notes, "attributes of .node");
    if (node->markers)
        note_dropped(notes, "markers of .node");
    tm_status status = give_levels(state, mix, levels, error);
    node->attributes = 1;
    node->markers = false;
    free(node->marker);
    node->marker = NULL;
    if (status == TM_OK &&
        !renew((void **)&node->attribute, state->mesh.nodes, sizeof *node->attribute))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = give_octants(state, stream, error);
    tm_block *facet = tm_stream_find(stream, ".facet");
    if (status != TM_OK || !facet)
        return status;
    if (!surface->marker || !facet->markers || !is_boundary(facet)) {
        note_dropped(notes, facet->name);
        tm_stream_remove(stream, facet);
        return TM_OK;
    }
    return give_facets(state, surface, facet, error);
}

/* Moves an array. */
#define MOVE(to, from) (free(to), (to) = (void *)(from), (from) = NULL)

tm_status tm_repair_to_stream(tm_repair_state *state, tm_stream *stream,
                              const tm_surface *surface, tm_repair_notes *notes,
                              tm_error *error)
{
    tm_status status = TM_OK;
    if (state->remade)
        status = give_remade(state, stream, surface, notes, error);
    else if (state->divided)
        status = give_divided(state, stream, notes, error);
    if (status != TM_OK)
        return status;
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *mix = tm_stream_find(stream, ".mix");
    node->count = state->mesh.nodes;
    if (notes->attributed || state->remade)
        set_places(state, node);
    mix->count = state->mesh.elements;
    MOVE(node->real, state->mesh.xyz);
    MOVE(mix->start, state->mesh.start);
    MOVE(mix->item, state->mesh.item);
    return TM_OK;
}
