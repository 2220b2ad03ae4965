/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A part out of the mesh. */
#include "parts.h"

#include "../../base/array.h"
#include "../../base/hash.h"

#include <stdlib.h>
#include <string.h>

typedef struct taking {
    const tm_tet_parts *parts;
    const tm_tet_mesh *from;
    tm_tet_part *part;
    tm_tet_mesh *to;
    tm_hash_table of_node; /* nodes of the mesh -> those of the part */
    size_t node_room;
    tm_error *error;
} taking;

/* The number that a node has, or would get, in the part. */
static uint32_t *find_node(const taking *take, uint32_t v)
{
    uint32_t *slot = tm_hash_slot(&take->of_node, tm_hash(0, v));
    while (*slot != TM_HASH_FREE && take->part->node[*slot] != v)
        slot = tm_hash_next(&take->of_node, slot);
    return slot;
}

static bool list_nodes(taking *take)
{
    tm_tet_part *part = take->part;
    const size_t tets = part->past - part->first;
    if (!tm_hash_make(&take->of_node, 4 * tets))
        return false;
    for (size_t k = 0; k < tets; k++)
        for (int i = 0; i < 4; i++) {
            const uint32_t v = take->from->tet[take->parts->order[part->first + k]][i];
            uint32_t *slot = find_node(take, v);
            if (*slot == TM_HASH_FREE) {
                *slot = (uint32_t)part->nodes;
                if (!tm_append(&part->node, &part->nodes, &take->node_room, v))
                    return false;
            }
            take->to->tet[k][i] = *slot;
        }
    return true;
}

static bool copy_nodes(const taking *take)
{
    const tm_tet_mesh *from = take->from;
    const tm_tet_part *part = take->part;
    tm_tet_mesh *to = take->to;
    const size_t nodes = part->nodes, width = from->node_attributes;
    to->nodes = to->node_room = nodes;
    to->node_attributes = width;
    to->xyz = tm_new(nodes, sizeof *to->xyz);
    if (width > 0)
        to->node_attribute = tm_new(nodes * width, sizeof *to->node_attribute);
    if (from->node_marker)
        to->node_marker = tm_new(nodes, sizeof *to->node_marker);
    if (!to->xyz || (width > 0 && !to->node_attribute) ||
        (from->node_marker && !to->node_marker))
        return false;
    for (uint32_t k = 0; k < nodes; k++)
        tm_tet_copy_node(to, k, from, part->node[k]);
    return true;
}

static bool make_tets(taking *take)
{
    const tm_tet_mesh *from = take->from;
    tm_tet_mesh *to = take->to;
    const tm_tet_part *part = take->part;
    const size_t tets = part->past - part->first, width = from->regions;
    to->slots = to->tets = to->slot_room = tets;
    to->regions = width;
    to->tet = tm_new(tets, sizeof *to->tet);
    to->neighbour = tm_new(tets, sizeof *to->neighbour);
    if (width > 0)
        to->region = tm_new(tets * width, sizeof *to->region);
    if (!to->tet || !to->neighbour || (width > 0 && !to->region))
        return false;
    for (size_t k = 0; k < tets && width > 0; k++)
        memcpy(to->region + k * width,
               from->region + take->parts->order[part->first + k] * width,
               width * sizeof *to->region);
    return true;
}

/* The half face of the part that a half face of the mesh is; TM_NONE. */
static uint32_t half_of(const taking *take, uint32_t half)
{
    if (half == TM_NONE)
        return TM_NONE;
    const uint32_t place = take->parts->place[half / 4];
    return place >= take->part->first && place < take->part->past
               ? 4 * (place - take->part->first) + half % 4
               : TM_NONE;
}

/* No operation takes an edge of a face between parts, nor moves its nodes. */
static bool lock_edges(tm_tet_mesh *mesh, const uint32_t node[3])
{
    if (!tm_edge_map_reserve(&mesh->locked, 3))
        return false;
    for (int i = 0; i < 3; i++)
        tm_edge_map_put(&mesh->locked, node[i], node[(i + 1) % 3], 0);
    return true;
}

/* A face that stays, seen from half face h of the part; `across` is the other one. */
static bool add_face(const taking *take, uint32_t h, uint32_t across,
                     const tm_constrained_face *like)
{
    tm_tet_mesh *to = take->to;
    const uint32_t *n = to->tet[h / 4];
    if (tm_tet_mesh_reserve(to, 0, 0, 1, 0, take->error) != TM_OK)
        return false;
    tm_constrained_face *face = &to->face[to->faces];
    *face = (tm_constrained_face){.side = {h, half_of(take, across)}};
    for (uint32_t i = 0, k = 0; i < 4; i++)
        if (i != h % 4)
            face->node[k++] = n[i];
    if (like) {
        for (int i = 0; i < 3; i++)
            face->node[i] = *find_node(take, like->node[i]);
        face->marker = like->marker;
        face->listed = like->listed;
        if (half_of(take, like->side[0]) != h) {
            face->side[0] = face->side[1];
            face->side[1] = h;
        }
    }
    to->neighbour[h / 4][h % 4] = (uint32_t)to->faces++ | TM_FACE_BIT;
    const bool is_between = across != TM_NONE && half_of(take, across) == TM_NONE;
    return !is_between || lock_edges(to, face->node);
}

static bool connect(const taking *take)
{
    const tm_tet_mesh *from = take->from;
    tm_tet_mesh *to = take->to;
    for (uint32_t k = 0; k < to->slots; k++) {
        const uint32_t t = take->parts->order[take->part->first + k];
        for (uint32_t i = 0; i < 4; i++) {
            const uint32_t n = from->neighbour[t][i];
            const uint32_t across = tm_tet_across(from, t, i);
            const uint32_t g = half_of(take, across), h = 4 * k + i;
            if (!(n & TM_FACE_BIT) && g != TM_NONE)
                to->neighbour[k][i] = g;
            else if (g != TM_NONE && g < h) /* the face was met before */
                to->neighbour[k][i] = to->neighbour[g / 4][g % 4];
            else if (!add_face(take, h, across,
                               n & TM_FACE_BIT ? &from->face[n & ~TM_FACE_BIT] : NULL))
                return false;
        }
    }
    return true;
}

static const uint8_t end[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/* Rows of .edge that are edges of tetrahedra of the part. */
static bool add_edges(const taking *take)
{
    const uint8_t *has_edge = take->parts->has_edge;
    tm_tet_mesh *to = take->to;
    for (size_t k = 0; has_edge && k < 6 * to->slots; k++) {
        const uint32_t *n = to->tet[k / 6];
        const uint32_t a = n[end[k % 6][0]], b = n[end[k % 6][1]];
        const uint32_t v = take->part->node[a], w = take->part->node[b];
        if (!has_edge[v] || !has_edge[w])
            continue;
        const tm_marked_edge *edge = tm_tet_mesh_edge(take->from, v, w);
        if (!edge || tm_tet_mesh_edge(to, a, b))
            continue;
        __atomic_store_n(&take->parts->taken[edge - take->from->edge], 1,
                         __ATOMIC_RELAXED);
        if (tm_tet_mesh_reserve(to, 0, 0, 0, 1, take->error) != TM_OK)
            return false;
        const bool turned = edge->node[0] != v;
        tm_edge_map_put(&to->edge_of, a, b, (uint32_t)to->edges);
        to->edge[to->edges++] =
            (tm_marked_edge){{turned ? b : a, turned ? a : b}, edge->marker, false};
    }
    return true;
}

/* Edges of tetrahedra of the part that are locked in the mesh. */
static bool copy_locked(const taking *take)
{
    const tm_edge_map *locked = &take->from->locked;
    tm_tet_mesh *to = take->to;
    for (size_t k = 0; locked->count > 0 && k < 6 * to->slots; k++) {
        const uint32_t *n = to->tet[k / 6];
        const uint32_t a = n[end[k % 6][0]], b = n[end[k % 6][1]];
        if (!tm_edge_map_get(locked, take->part->node[a], take->part->node[b]))
            continue;
        if (!tm_edge_map_reserve(&to->locked, 1))
            return false;
        tm_edge_map_put(&to->locked, a, b, 0);
    }
    return true;
}

tm_status tm_tet_part_take(const tm_tet_parts *parts, size_t p, const tm_tet_mesh *mesh,
                           tm_error *error)
{
    tm_tet_part *part = &parts->part[p];
    taking take = {
        .parts = parts, .from = mesh, .part = part, .to = &part->mesh, .error = error};
    part->mesh = (tm_tet_mesh){.first_dead = TM_NONE,
                               .has_set = mesh->has_set,
                               .edge_markers = mesh->edge_markers,
                               .inner_edges = mesh->inner_edges,
                               .inner_marked_edges = mesh->inner_marked_edges,
                               .flat = mesh->flat};
    const bool done = make_tets(&take) && list_nodes(&take) && copy_nodes(&take) &&
                      connect(&take) && add_edges(&take) && copy_locked(&take);
    tm_hash_free(&take.of_node);
    return done ? TM_OK : tm_fail_memory(error);
}
