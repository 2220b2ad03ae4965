/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh out of a stream's blocks, and back into them. */
#include "connect.h"
#include "mesh.h"

#include "../base/array.h"
#include "../stream/coordinates.h"

#include <stdlib.h>
#include <string.h>

/* Moves an array from one owner to another. */
#define MOVE(to, from) ((to) = (void *)(from), (from) = NULL)

static void take_nodes(tm_tet_mesh *mesh, tm_block *block)
{
    MOVE(mesh->xyz, block->real);
    MOVE(mesh->node_attribute, block->attribute);
    MOVE(mesh->node_marker, block->marker);
    mesh->node_attributes = block->attributes;
    mesh->nodes = mesh->node_room = block->count;
    block->count = 0;
}

static tm_status take_tets(tm_tet_mesh *mesh, tm_block *block, tm_error *error)
{
    if (block->count >= TM_TETS_MAX)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, ".ele",
                          "more than %zu tetrahedra", TM_TETS_MAX);
    MOVE(mesh->tet, block->integer);
    MOVE(mesh->region, block->attribute);
    mesh->regions = block->attributes;
    mesh->slots = mesh->tets = mesh->slot_room = block->count;
    block->count = 0;
    mesh->neighbour = tm_new(mesh->slots, sizeof *mesh->neighbour);
    return mesh->neighbour ? TM_OK : tm_fail_memory(error);
}

static tm_status take_faces(tm_tet_mesh *mesh, tm_block *block, unsigned base,
                            tm_error *error)
{
    tm_status status = tm_tet_mesh_reserve(mesh, 0, 0, block->count, 0, error);
    if (status != TM_OK)
        return status;
    for (size_t f = 0; f < block->count; f++) {
        const uint32_t *n = block->integer + 3 * f;
        if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0])
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".face",
                              "triangle %zu names a node twice", f + base);
        tm_constrained_face *face = &mesh->face[mesh->faces++];
        *face = (tm_constrained_face){.side = {TM_NONE, TM_NONE}, .listed = true};
        memcpy(face->node, n, sizeof face->node);
        face->marker = block->marker ? block->marker[f] : 0;
    }
    return TM_OK;
}

static tm_status take_edges(tm_tet_mesh *mesh, tm_block *block, unsigned base,
                            tm_error *error)
{
    tm_status status = tm_tet_mesh_reserve(mesh, 0, 0, 0, block->count, error);
    if (status != TM_OK)
        return status;
    mesh->edge_markers = block->markers;
    for (size_t e = 0; e < block->count; e++) {
        uint32_t a = block->integer[2 * e], b = block->integer[2 * e + 1];
        if (a == b)
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".edge",
                              "edge %zu joins a node to itself", e + base);
        if (tm_tet_mesh_edge(mesh, a, b))
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".edge",
                              "edge %zu was there before", e + base);
        tm_edge_map_put(&mesh->edge_of, a, b, (uint32_t)mesh->edges);
        mesh->edge[mesh->edges++] =
            (tm_marked_edge){{a, b}, block->marker ? block->marker[e] : 0, false};
    }
    return TM_OK;
}

tm_status tm_tet_mesh_from_stream(tm_tet_mesh *mesh, tm_stream *stream, unsigned threads,
                                  tm_error *error)
{
    *mesh = (tm_tet_mesh){.first_dead = TM_NONE};
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *ele = tm_stream_find(stream, ".ele");
    tm_block *face = tm_stream_find(stream, ".face");
    tm_block *edge = tm_stream_find(stream, ".edge");
    tm_status status = tm_stream_check_coordinates(stream, error);
    if (status == TM_OK && node)
        take_nodes(mesh, node);
    if (status == TM_OK && ele)
        status = take_tets(mesh, ele, error);
    if (status == TM_OK && face)
        status = take_faces(mesh, face, stream->base, error);
    if (status == TM_OK && edge)
        status = take_edges(mesh, edge, stream->base, error);
    return status == TM_OK ? tm_tet_mesh_connect(mesh, stream->base, threads, error)
                           : status;
}

/* The last living tetrahedra fill the dead slots. Neighbours are not kept: the mesh is
 * about to be given away. */
static void compact(tm_tet_mesh *mesh)
{
    size_t last = mesh->slots;
    for (size_t t = 0; t < mesh->tets; t++) {
        if (tm_tet_lives(mesh, (uint32_t)t))
            continue;
        do
            last--;
        while (!tm_tet_lives(mesh, (uint32_t)last));
        memcpy(mesh->tet[t], mesh->tet[last], sizeof mesh->tet[t]);
        for (size_t r = 0; r < mesh->regions; r++)
            mesh->region[t * mesh->regions + r] = mesh->region[last * mesh->regions + r];
    }
    mesh->slots = mesh->tets;
    mesh->first_dead = TM_NONE;
}

/* Takes removed nodes out; the others keep their order. */
static tm_status compact_nodes(tm_tet_mesh *mesh, tm_error *error)
{
    size_t kept = 0, width = mesh->node_attributes;
    if (mesh->removed_nodes == 0)
        return TM_OK;
    uint32_t *number = tm_new(mesh->nodes, sizeof *number);
    if (!number)
        return tm_fail_memory(error);
    for (size_t e = 0; e < mesh->edges; e++)
        mesh->edge[e].gone |= !tm_node_lives(mesh, mesh->edge[e].node[0]) ||
                              !tm_node_lives(mesh, mesh->edge[e].node[1]);
    for (uint32_t v = 0; v < mesh->nodes; v++) {
        number[v] = (uint32_t)kept;
        if (!tm_node_lives(mesh, v))
            continue;
        memmove(mesh->xyz[kept], mesh->xyz[v], sizeof mesh->xyz[v]);
        if (width > 0)
            memmove(mesh->node_attribute + kept * width, mesh->node_attribute + v * width,
                    width * sizeof *mesh->node_attribute);
        if (mesh->node_marker)
            mesh->node_marker[kept] = mesh->node_marker[v];
        kept++;
    }
    for (size_t t = 0; t < mesh->tets; t++)
        for (int i = 0; i < 4; i++)
            mesh->tet[t][i] = number[mesh->tet[t][i]];
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3; i++)
            mesh->face[f].node[i] = number[mesh->face[f].node[i]];
    for (size_t e = 0; e < mesh->edges; e++)
        for (int i = 0; i < 2; i++)
            mesh->edge[e].node[i] = number[mesh->edge[e].node[i]];
    mesh->nodes = kept;
    mesh->removed_nodes = 0;
    free(number);
    return TM_OK;
}

static tm_status give_faces(const tm_tet_mesh *mesh, tm_block *block, tm_error *error)
{
    size_t count = 0;
    for (size_t f = 0; f < mesh->faces; f++)
        count += mesh->face[f].listed;
    tm_status status = tm_block_allocate(block, count, 0, error);
    if (status != TM_OK)
        return status;
    for (size_t f = 0, row = 0; f < mesh->faces; f++) {
        const tm_constrained_face *face = &mesh->face[f];
        if (!face->listed)
            continue;
        memcpy(block->integer + 3 * row, face->node, sizeof face->node);
        if (block->marker)
            block->marker[row] = face->marker;
        row++;
    }
    return TM_OK;
}

static tm_status give_edges(const tm_tet_mesh *mesh, tm_block *block, tm_error *error)
{
    size_t count = 0;
    for (size_t e = 0; e < mesh->edges; e++)
        count += !mesh->edge[e].gone;
    tm_status status = tm_block_allocate(block, count, 0, error);
    if (status != TM_OK)
        return status;
    for (size_t e = 0, row = 0; e < mesh->edges; e++) {
        const tm_marked_edge *edge = &mesh->edge[e];
        if (edge->gone)
            continue;
        memcpy(block->integer + 2 * row, edge->node, sizeof edge->node);
        if (block->marker)
            block->marker[row] = edge->marker;
        row++;
    }
    return TM_OK;
}

bool tm_tet_mesh_invalidates(const tm_tet_mesh *mesh, const tm_block *block)
{
    return mesh->removed_nodes > 0 && block->name[0] == '.' && block->kind >= TM_MIX &&
           block->kind < TM_GROUP && block->kind != TM_ROOT;
}

tm_status tm_tet_mesh_to_stream(tm_tet_mesh *mesh, tm_stream *stream, tm_error *error)
{
    for (size_t b = stream->blocks; b > 0; b--)
        if (tm_tet_mesh_invalidates(mesh, &stream->block[b - 1]))
            tm_stream_remove(stream, &stream->block[b - 1]);
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *ele = tm_stream_find(stream, ".ele");
    tm_block *face = tm_stream_find(stream, ".face");
    tm_block *edge = tm_stream_find(stream, ".edge");
    tm_status status = TM_OK;
    free(mesh->neighbour); /* before more is allocated: this is where memory peaks */
    mesh->neighbour = NULL;
    compact(mesh);
    status = compact_nodes(mesh, error);
    if (node) {
        MOVE(node->real, mesh->xyz);
        MOVE(node->attribute, mesh->node_attribute);
        MOVE(node->marker, mesh->node_marker);
        node->count = mesh->nodes;
    }
    if (ele) {
        MOVE(ele->integer, mesh->tet);
        MOVE(ele->attribute, mesh->region);
        ele->count = mesh->tets;
    }
    if (status == TM_OK && face)
        status = give_faces(mesh, face, error);
    if (status == TM_OK && edge)
        status = give_edges(mesh, edge, error);
    tm_tet_mesh_free(mesh);
    return status;
}
