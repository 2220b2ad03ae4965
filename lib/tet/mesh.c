/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../geom/barycentric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_tet_mesh_free(tm_tet_mesh *mesh)
{
    free(mesh->xyz);
    free(mesh->node_attribute);
    free(mesh->node_marker);
    free(mesh->tet);
    free(mesh->neighbour);
    free(mesh->region);
    free(mesh->face);
    free(mesh->edge);
    tm_edge_map_free(&mesh->edge_of);
    tm_edge_map_free(&mesh->locked);
    *mesh = (tm_tet_mesh){.first_dead = TM_NONE};
}

/* Grows one array to hold `needed` items; *room is left alone. */
#define GROW(array, room, needed)                                                        \
    do {                                                                                 \
        size_t capacity = (room);                                                        \
        void *moved = tm_grow(array, &capacity, needed, sizeof *(array));                \
        if (!moved)                                                                      \
            return tm_fail_memory(error);                                                \
        (array) = moved;                                                                 \
        grown = capacity;                                                                \
    } while (0)

static tm_status reserve_nodes(tm_tet_mesh *mesh, size_t needed, tm_error *error)
{
    size_t grown = 0;
    if (needed <= mesh->node_room)
        return TM_OK;
    if (needed >= TM_IDS)
        return tm_fail(error, TM_ERROR_SYSTEM, "more than %u nodes", TM_IDS - 1);
    GROW(mesh->xyz, mesh->node_room, needed);
    if (mesh->node_marker)
        GROW(mesh->node_marker, mesh->node_room, needed);
    if (mesh->node_attributes) {
        size_t width = mesh->node_attributes;
        GROW(mesh->node_attribute, mesh->node_room * width, grown * width);
        grown /= width;
    }
    mesh->node_room = grown;
    return TM_OK;
}

static tm_status reserve_tets(tm_tet_mesh *mesh, size_t needed, tm_error *error)
{
    size_t grown = 0;
    if (needed <= mesh->slot_room)
        return TM_OK;
    if (needed >= TM_TETS_MAX)
        return tm_fail(error, TM_ERROR_SYSTEM, "more than %zu tetrahedra", TM_TETS_MAX);
    GROW(mesh->tet, mesh->slot_room, needed);
    GROW(mesh->neighbour, mesh->slot_room, needed);
    if (mesh->regions) {
        size_t width = mesh->regions;
        GROW(mesh->region, mesh->slot_room * width, grown * width);
        grown /= width;
    }
    mesh->slot_room = grown;
    return TM_OK;
}

tm_status tm_tet_mesh_reserve(tm_tet_mesh *mesh, size_t nodes, size_t tets, size_t faces,
                              size_t edges, tm_error *error)
{
    size_t grown;
    tm_status status = reserve_nodes(mesh, mesh->nodes + nodes, error);
    if (status == TM_OK)
        status = reserve_tets(mesh, mesh->slots + tets, error);
    if (status != TM_OK)
        return status;
    if (mesh->faces + faces > mesh->face_room) {
        if (mesh->faces + faces >= TM_IDS_HALF)
            return tm_fail(error, TM_ERROR_SYSTEM, "more than %zu faces",
                           TM_IDS_HALF - 1);
        GROW(mesh->face, mesh->face_room, mesh->faces + faces);
        mesh->face_room = grown;
    }
    if (mesh->edges + edges > mesh->edge_room) {
        GROW(mesh->edge, mesh->edge_room, mesh->edges + edges);
        mesh->edge_room = grown;
    }
    if (edges > 0 && !tm_edge_map_reserve(&mesh->edge_of, edges))
        return tm_fail_memory(error);
    return TM_OK;
}

/* A copy of so many items of an array, if there is one. */
static void *copy(const void *array, size_t count, size_t size, bool *done)
{
    void *made = array ? tm_new(count, size) : NULL;
    *done &= made || !array;
    if (made)
        memcpy(made, array, count * size);
    return made;
}

tm_status tm_tet_mesh_copy(tm_tet_mesh *to, const tm_tet_mesh *from, tm_error *error)
{
    bool done = true;
    size_t nodes = from->nodes, slots = from->slots;
    tm_tet_mesh made = *from;
    made.node_room = nodes;
    made.slot_room = slots;
    made.face_room = from->faces;
    made.edge_room = from->edges;
    made.xyz = copy(from->xyz, nodes, sizeof *made.xyz, &done);
    made.node_attribute = copy(from->node_attribute, nodes * from->node_attributes,
                               sizeof *made.node_attribute, &done);
    made.node_marker = copy(from->node_marker, nodes, sizeof *made.node_marker, &done);
    made.tet = copy(from->tet, slots, sizeof *made.tet, &done);
    made.neighbour = copy(from->neighbour, slots, sizeof *made.neighbour, &done);
    made.region = copy(from->region, slots * from->regions, sizeof *made.region, &done);
    made.face = copy(from->face, from->faces, sizeof *made.face, &done);
    made.edge = copy(from->edge, from->edges, sizeof *made.edge, &done);
    made.edge_of.slot =
        copy(from->edge_of.slot, from->edge_of.room, sizeof *made.edge_of.slot, &done);
    made.locked.slot =
        copy(from->locked.slot, from->locked.room, sizeof *made.locked.slot, &done);
    tm_tet_mesh_free(done ? to : &made);
    if (!done)
        return tm_fail_memory(error);
    *to = made;
    return TM_OK;
}

size_t tm_tet_mesh_most(const tm_tet_mesh *mesh, double growth)
{
    const size_t limit = TM_TETS_MAX;
    const double most = growth * (double)mesh->tets;
    return growth > 0 && most < (double)limit ? (size_t)most : limit;
}

uint32_t tm_tet_mesh_new_tet(tm_tet_mesh *mesh)
{
    uint32_t t = mesh->first_dead;
    mesh->tets++;
    if (t == TM_NONE)
        return (uint32_t)mesh->slots++;
    mesh->first_dead = mesh->tet[t][1];
    return t;
}

void tm_tet_mesh_delete_tet(tm_tet_mesh *mesh, uint32_t t)
{
    mesh->tet[t][0] = TM_NONE;
    mesh->tet[t][1] = mesh->first_dead;
    mesh->first_dead = t;
    mesh->tets--;
}

uint32_t tm_tet_mesh_new_node(tm_tet_mesh *mesh, const double p[3])
{
    uint32_t v = (uint32_t)mesh->nodes;
    if (mesh->removed_nodes > 0) {
        v = mesh->last_removed;
        mesh->removed_nodes--;
        mesh->last_removed = (uint32_t)mesh->xyz[v][1];
    } else {
        mesh->nodes++;
    }
    memcpy(mesh->xyz[v], p, sizeof mesh->xyz[v]);
    for (size_t k = 0; k < mesh->node_attributes; k++)
        mesh->node_attribute[v * mesh->node_attributes + k] = 0;
    if (mesh->node_marker)
        mesh->node_marker[v] = 0;
    return v;
}

void tm_tet_mesh_delete_node(tm_tet_mesh *mesh, uint32_t v)
{
    mesh->xyz[v][0] = NAN;
    mesh->xyz[v][1] = mesh->last_removed;
    mesh->last_removed = v;
    mesh->removed_nodes++;
}

tm_marked_edge *tm_tet_mesh_edge(const tm_tet_mesh *mesh, uint32_t a, uint32_t b)
{
    const uint32_t *e = tm_edge_map_get(&mesh->edge_of, a, b);
    return e ? &mesh->edge[*e] : NULL;
}

void tm_tet_mesh_forget_edge(tm_tet_mesh *mesh, uint32_t a, uint32_t b)
{
    tm_marked_edge *edge = tm_tet_mesh_edge(mesh, a, b);
    if (!edge)
        return;
    edge->gone = true;
    tm_edge_map_remove(&mesh->edge_of, a, b);
}

double tm_tet_coordinates(const tm_tet_mesh *mesh, uint32_t t, const double p[3],
                          double weight[4])
{
    const double *x[4];
    for (int i = 0; i < 4; i++)
        x[i] = mesh->xyz[mesh->tet[t][i]];
    return tm_barycentric(x, p, weight);
}

void tm_tet_interpolate(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                        const double p[3], double *value)
{
    size_t width = mesh->node_attributes;
    const uint32_t *nodes = mesh->tet[tet[0]];
    double weight[4] = {1, 0, 0, 0}, deepest = -HUGE_VAL;
    for (size_t i = 0; i < count && width > 0; i++) {
        double w[4], depth = tm_tet_coordinates(mesh, tet[i], p, w);
        if (!(depth > deepest))
            continue;
        deepest = depth;
        nodes = mesh->tet[tet[i]];
        memcpy(weight, w, sizeof weight);
    }
    for (size_t k = 0; k < width; k++) {
        value[k] = 0;
        for (int i = 0; i < 4; i++)
            value[k] += weight[i] * mesh->node_attribute[nodes[i] * width + k];
    }
}
