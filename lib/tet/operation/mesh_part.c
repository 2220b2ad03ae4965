/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_part.h"

#include "../../base/array.h"
#include "../../element/tet_quality.h"

#include <stdlib.h>
#include <string.h>

void tm_mesh_part_free(tm_mesh_part *part)
{
    free(part->tet);
    free(part->node);
    *part = (tm_mesh_part){0};
}

void tm_mesh_part_clear(tm_mesh_part *part)
{
    part->tets = part->nodes = 0;
}

static bool add_tet(tm_mesh_part *part, uint32_t t)
{
    return tm_append(&part->tet, &part->tets, &part->tet_room, t);
}

static bool add_node(tm_mesh_part *part, uint32_t v)
{
    return tm_append(&part->node, &part->nodes, &part->node_room, v);
}

bool tm_mesh_part_add(tm_mesh_part *part, const tm_tet_mesh *mesh, uint32_t t)
{
    for (int i = 0; i < 4; i++)
        if (!add_node(part, mesh->tet[t][i]))
            return false;
    return add_tet(part, t);
}

static bool has_tet(const tm_tet_mesh *mesh, uint32_t t)
{
    return t < mesh->slots && tm_tet_lives(mesh, t);
}

/* Leaves each item once, of those that are below `limit`. */
static bool drop_doubles(uint32_t *item, size_t *count, size_t limit, tm_tet_marks *marks)
{
    size_t kept = 0;
    if (!tm_tet_marks_clear(marks, limit))
        return false;
    for (size_t k = 0; k < *count; k++)
        if (tm_tet_mark(marks, item[k]))
            item[kept++] = item[k];
    *count = kept;
    return true;
}

/* Slots that died; those of the part are marked. They are before those that were dead
 * already and were not used since. */
static bool add_dead(tm_mesh_part *part, const tm_tet_mesh *mesh, const tm_tet_mesh *old,
                     const tm_tet_marks *marks)
{
    for (uint32_t t = mesh->first_dead; t != TM_NONE; t = mesh->tet[t][1]) {
        if (tm_tet_is_marked(marks, t))
            continue;
        if (t < old->slots && !tm_tet_lives(old, t))
            break;
        if (!add_tet(part, t))
            return false;
    }
    return true;
}

/* The same of nodes. */
static bool add_removed(tm_mesh_part *part, const tm_tet_mesh *mesh,
                        const tm_tet_mesh *old, const tm_tet_marks *marks)
{
    uint32_t v = mesh->last_removed;
    for (size_t k = 0; k < mesh->removed_nodes; k++, v = (uint32_t)mesh->xyz[v][1]) {
        if (tm_tet_is_marked(marks, v))
            continue;
        if (v < old->nodes && !tm_node_lives(old, v))
            break;
        if (!add_node(part, v))
            return false;
    }
    return true;
}

/* The neighbours that a tetrahedron has in a mesh. */
static bool add_neighbours(tm_mesh_part *part, const tm_tet_mesh *mesh, uint32_t t)
{
    for (int i = 0; i < 4 && has_tet(mesh, t); i++)
        if (!(mesh->neighbour[t][i] & TM_FACE_BIT) &&
            !add_tet(part, mesh->neighbour[t][i] / 4))
            return false;
    return true;
}

static bool add_nodes(tm_mesh_part *part, const tm_tet_mesh *mesh, uint32_t t)
{
    for (int i = 0; i < 4 && has_tet(mesh, t); i++)
        if (!add_node(part, mesh->tet[t][i]))
            return false;
    return true;
}

static size_t most(size_t a, size_t b)
{
    return a > b ? a : b;
}

bool tm_mesh_part_close(tm_mesh_part *part, const tm_tet_mesh *mesh,
                        const tm_tet_mesh *old, tm_tet_marks *marks)
{
    size_t slots = most(mesh->slots, old->slots), nodes = most(mesh->nodes, old->nodes);
    if (!drop_doubles(part->tet, &part->tets, slots, marks) ||
        !add_dead(part, mesh, old, marks))
        return false;
    size_t changed = part->tets;
    for (size_t k = 0; k < changed; k++)
        if (!add_neighbours(part, mesh, part->tet[k]) ||
            !add_neighbours(part, old, part->tet[k]))
            return false;
    if (!drop_doubles(part->tet, &part->tets, slots, marks))
        return false;
    for (size_t k = 0; k < part->tets; k++)
        if (!add_nodes(part, mesh, part->tet[k]) || !add_nodes(part, old, part->tet[k]))
            return false;
    return drop_doubles(part->node, &part->nodes, nodes, marks) &&
           add_removed(part, mesh, old, marks);
}

static void copy_nodes(const tm_mesh_part *part, tm_tet_mesh *to, const tm_tet_mesh *from)
{
    for (size_t k = 0; k < part->nodes; k++)
        if (part->node[k] < from->nodes)
            tm_tet_copy_node(to, part->node[k], from, part->node[k]);
}

/* The constrained faces of a tetrahedron in one of the two. */
static void copy_faces(tm_tet_mesh *to, const tm_tet_mesh *from, const tm_tet_mesh *of,
                       uint32_t t)
{
    for (int i = 0; i < 4 && has_tet(of, t); i++) {
        uint32_t f = of->neighbour[t][i] & ~TM_FACE_BIT;
        if (of->neighbour[t][i] & TM_FACE_BIT && f < from->faces)
            to->face[f] = from->face[f];
    }
}

/* What .edge says of the edges of a tetrahedron that *to has is forgotten. */
static void forget_edges(tm_tet_mesh *to, const tm_tet_mesh *from, uint32_t t)
{
    for (int e = 0; e < TM_TET_EDGES && has_tet(to, t); e++) {
        uint32_t a = to->tet[t][tm_edge_corner[e][0]],
                 b = to->tet[t][tm_edge_corner[e][1]];
        const uint32_t *at = tm_edge_map_get(&to->edge_of, a, b);
        if (!at)
            continue;
        if (*at < from->edges)
            to->edge[*at] = from->edge[*at];
        tm_edge_map_remove(&to->edge_of, a, b);
    }
}

/* And what it says of those that *from has is put in. */
static void put_edges(tm_tet_mesh *to, const tm_tet_mesh *from, uint32_t t)
{
    for (int e = 0; e < TM_TET_EDGES && has_tet(from, t); e++) {
        uint32_t a = from->tet[t][tm_edge_corner[e][0]];
        uint32_t b = from->tet[t][tm_edge_corner[e][1]];
        const uint32_t *at = tm_edge_map_get(&from->edge_of, a, b);
        if (!at)
            continue;
        to->edge[*at] = from->edge[*at];
        tm_edge_map_put(&to->edge_of, a, b, *at);
    }
}

static void copy_tet(tm_tet_mesh *to, const tm_tet_mesh *from, uint32_t t)
{
    if (t >= from->slots)
        return;
    memcpy(to->tet[t], from->tet[t], sizeof to->tet[t]);
    memcpy(to->neighbour[t], from->neighbour[t], sizeof to->neighbour[t]);
    if (from->regions > 0)
        memcpy(to->region + t * from->regions, from->region + t * from->regions,
               from->regions * sizeof *to->region);
}

/* Counts, and where the lists of what is free begin. */
static void copy_heads(tm_tet_mesh *to, const tm_tet_mesh *from)
{
    to->nodes = from->nodes;
    to->removed_nodes = from->removed_nodes;
    to->last_removed = from->last_removed;
    to->slots = from->slots;
    to->tets = from->tets;
    to->first_dead = from->first_dead;
    to->faces = from->faces;
    to->edges = from->edges;
    to->inner_edges = from->inner_edges;
    to->inner_marked_edges = from->inner_marked_edges;
}

/* What was appended: it may be gone again, and have no place in the mesh. */
static void copy_appended(tm_tet_mesh *to, const tm_tet_mesh *from)
{
    for (size_t f = to->faces; f < from->faces; f++)
        to->face[f] = from->face[f];
    for (size_t e = to->edges; e < from->edges; e++)
        to->edge[e] = from->edge[e];
}

static size_t more(size_t from, size_t to)
{
    return from > to ? from - to : 0;
}

tm_status tm_mesh_part_copy(const tm_mesh_part *part, tm_tet_mesh *to,
                            const tm_tet_mesh *from, tm_error *error)
{
    bool edges = from->edge_of.count > 0 || to->edge_of.count > 0;
    tm_status status = tm_tet_mesh_reserve(
        to, more(from->nodes, to->nodes), more(from->slots, to->slots),
        more(from->faces, to->faces), more(from->edges, to->edges), error);
    if (status != TM_OK)
        return status;
    if (edges && !tm_edge_map_reserve(&to->edge_of, TM_TET_EDGES * part->tets))
        return tm_fail_memory(error);
    for (size_t k = 0; k < part->tets; k++) {
        copy_faces(to, from, to, part->tet[k]);
        copy_faces(to, from, from, part->tet[k]);
        if (edges)
            forget_edges(to, from, part->tet[k]);
    }
    for (size_t k = 0; k < part->tets && edges; k++)
        put_edges(to, from, part->tet[k]);
    for (size_t k = 0; k < part->tets; k++)
        copy_tet(to, from, part->tet[k]);
    copy_nodes(part, to, from);
    copy_appended(to, from);
    copy_heads(to, from);
    return TM_OK;
}
