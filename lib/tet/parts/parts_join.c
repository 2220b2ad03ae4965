/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts made one mesh again. */
#include "parts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"

#include <stdlib.h>
#include <string.h>

/* A face of a part that has one side there. */
typedef struct open_face {
    uint32_t node[3]; /* in ascending order */
    uint32_t half;
    uint32_t part, face; /* whose, and which one there */
} open_face;

typedef struct joining {
    tm_tet_parts *parts;
    tm_tet_mesh *mesh;
    uint32_t *first;   /* [parts + 1]: the number of the first tetrahedron of a part */
    uint32_t **number; /* [parts][slots]: the tetrahedron that one becomes */
    open_face *open;
    size_t opens;
    tm_error *error;
} joining;

/* Nodes ---------------------------------------------------------------------------- */

/* node[] of the part is for all that it has now. */
static bool join_nodes(joining *join, tm_tet_part *part)
{
    const tm_tet_mesh *from = &part->mesh;
    uint32_t *node = realloc(part->node, (from->nodes + 1) * sizeof *node);
    if (!node)
        return false;
    part->node = node;
    if (tm_tet_mesh_reserve(join->mesh, from->nodes - part->nodes, 0, 0, 0,
                            join->error) != TM_OK)
        return false;
    for (uint32_t v = 0; v < from->nodes; v++) {
        if (!tm_node_lives(from, v)) {
            if (v < part->nodes)
                tm_tet_mesh_delete_node(join->mesh, node[v]);
            continue;
        }
        if (v >= part->nodes)
            node[v] = (uint32_t)join->mesh->nodes++;
        tm_tet_copy_node(join->mesh, node[v], from, v);
    }
    return true;
}

/* Tetrahedra ----------------------------------------------------------------------- */

/* All but the faces that stay. */
static void join_tets(void *context, size_t p)
{
    joining *join = context;
    const tm_tet_part *part = &join->parts->part[p];
    const tm_tet_mesh *from = &part->mesh;
    tm_tet_mesh *to = join->mesh;
    const size_t width = from->regions;
    const uint32_t *number = join->number[p];
    for (uint32_t t = 0; t < from->slots; t++) {
        if (!tm_tet_lives(from, t))
            continue;
        const uint32_t k = number[t];
        for (int i = 0; i < 4; i++) {
            const uint32_t n = from->neighbour[t][i];
            to->tet[k][i] = part->node[from->tet[t][i]];
            to->neighbour[k][i] = n & TM_FACE_BIT ? n : 4 * number[n / 4] + n % 4;
        }
        if (width > 0)
            memcpy(to->region + k * width, from->region + t * width,
                   width * sizeof *to->region);
    }
}

static bool number_tets(joining *join, size_t p)
{
    const tm_tet_mesh *from = &join->parts->part[p].mesh;
    uint32_t next = join->first[p];
    uint32_t *number = join->number[p] = tm_new(from->slots, sizeof *number);
    for (uint32_t t = 0; t < from->slots && number; t++)
        number[t] = tm_tet_lives(from, t) ? next++ : TM_NONE;
    join->first[p + 1] = next;
    return number;
}

/* Room for all tetrahedra in the place of those that were there. */
static bool make_tets(joining *join)
{
    tm_tet_mesh *mesh = join->mesh;
    const size_t tets = join->first[join->parts->count];
    free(mesh->tet);
    free(mesh->neighbour);
    free(mesh->region);
    mesh->slots = mesh->tets = mesh->slot_room = tets;
    mesh->first_dead = TM_NONE;
    mesh->tet = tm_new(tets, sizeof *mesh->tet);
    mesh->neighbour = tm_new(tets, sizeof *mesh->neighbour);
    mesh->region =
        mesh->regions > 0 ? tm_new(tets * mesh->regions, sizeof *mesh->region) : NULL;
    return mesh->tet && mesh->neighbour && (mesh->region || mesh->regions == 0);
}

/* Faces ---------------------------------------------------------------------------- */

static uint32_t half_of(const joining *join, size_t p, uint32_t half)
{
    return half == TM_NONE ? TM_NONE : 4 * join->number[p][half / 4] + half % 4;
}

/* A face of a part as one of the mesh, for which there is room. */
static void add_face(joining *join, size_t p, uint32_t f, const uint32_t side[2])
{
    const tm_tet_part *part = &join->parts->part[p];
    tm_tet_mesh *mesh = join->mesh;
    tm_constrained_face *face = &mesh->face[mesh->faces];
    *face = part->mesh.face[f];
    for (int i = 0; i < 3; i++)
        face->node[i] = part->node[face->node[i]];
    for (int s = 0; s < 2; s++) {
        face->side[s] = side[s];
        if (side[s] != TM_NONE)
            mesh->neighbour[side[s] / 4][side[s] % 4] =
                (uint32_t)mesh->faces | TM_FACE_BIT;
    }
    mesh->faces++;
}

/* Those with both sides in the part; the others are listed. */
static void join_faces(joining *join, uint32_t p)
{
    const tm_tet_part *part = &join->parts->part[p];
    for (uint32_t f = 0; f < part->mesh.faces; f++) {
        const tm_constrained_face *face = &part->mesh.face[f];
        const uint32_t side[2] = {half_of(join, p, face->side[0]),
                                  half_of(join, p, face->side[1])};
        if (side[0] != TM_NONE && side[1] != TM_NONE)
            add_face(join, p, f, side);
        if ((side[0] == TM_NONE) == (side[1] == TM_NONE))
            continue;
        open_face *open = &join->open[join->opens++];
        *open = (open_face){.half = side[side[0] == TM_NONE], .part = p, .face = f};
        for (int i = 0; i < 3; i++)
            open->node[i] = part->node[face->node[i]];
        qsort(open->node, 3, sizeof *open->node, tm_compare_numbers);
    }
}

static int compare(const void *a, const void *b)
{
    const open_face *f = a, *g = b;
    for (int i = 0; i < 3; i++)
        if (f->node[i] != g->node[i])
            return f->node[i] < g->node[i] ? -1 : 1;
    return (f->part > g->part) - (f->part < g->part);
}

/* A face between two parts, seen from both: it is one that stays, or none. */
static void close_face(joining *join, const open_face *f, const open_face *g)
{
    const tm_constrained_face *face = &join->parts->part[f->part].mesh.face[f->face];
    uint32_t side[2] = {f->half, g->half};
    if (face->marker == 0 && tm_tet_same_region(join->mesh, f->half / 4, g->half / 4)) {
        tm_tet_join(join->mesh, f->half, g->half);
        return;
    }
    if (face->side[0] == TM_NONE) {
        side[0] = g->half;
        side[1] = f->half;
    }
    add_face(join, f->part, f->face, side);
}

static void close_faces(joining *join)
{
    qsort(join->open, join->opens, sizeof *join->open, compare);
    for (size_t k = 0; k < join->opens; k++) {
        const open_face *f = &join->open[k];
        if (k + 1 < join->opens && memcmp(f->node, f[1].node, sizeof f->node) == 0) {
            close_face(join, f, f + 1);
            k++;
            continue;
        }
        const uint32_t *own = join->parts->part[f->part].mesh.face[f->face].side;
        const uint32_t side[2] = {own[0] == TM_NONE ? TM_NONE : f->half,
                                  own[0] == TM_NONE ? f->half : TM_NONE};
        add_face(join, f->part, f->face, side);
    }
}

/* Edges ---------------------------------------------------------------------------- */

static void add_edge(tm_tet_mesh *mesh, tm_marked_edge edge)
{
    if (tm_tet_mesh_edge(mesh, edge.node[0], edge.node[1]))
        return;
    tm_edge_map_put(&mesh->edge_of, edge.node[0], edge.node[1], (uint32_t)mesh->edges);
    mesh->edge[mesh->edges++] = edge;
}

/* Those of the parts, and those that no part had. */
static bool join_edges(joining *join)
{
    tm_tet_mesh *mesh = join->mesh;
    tm_marked_edge *old = mesh->edge;
    const size_t edges = mesh->edges;
    size_t all = edges;
    for (size_t p = 0; p < join->parts->count; p++)
        all += join->parts->part[p].mesh.edges;
    mesh->edge = NULL;
    mesh->edges = mesh->edge_room = 0;
    tm_edge_map_free(&mesh->edge_of);
    const bool done = tm_tet_mesh_reserve(mesh, 0, 0, 0, all, join->error) == TM_OK;
    for (size_t e = 0; e < edges && done; e++)
        if (!old[e].gone && !join->parts->taken[e])
            add_edge(mesh, old[e]);
    for (size_t p = 0; p < join->parts->count && done; p++) {
        const tm_tet_part *part = &join->parts->part[p];
        for (size_t e = 0; e < part->mesh.edges; e++) {
            tm_marked_edge edge = part->mesh.edge[e];
            edge.node[0] = part->node[edge.node[0]];
            edge.node[1] = part->node[edge.node[1]];
            if (!edge.gone)
                add_edge(mesh, edge);
        }
    }
    free(old);
    return done;
}

/* All ------------------------------------------------------------------------------- */

static bool join_all(joining *join, unsigned threads)
{
    tm_tet_parts *parts = join->parts;
    tm_tet_mesh *mesh = join->mesh;
    size_t faces = 0;
    join->first[0] = 0;
    for (size_t p = 0; p < parts->count; p++) {
        if (!join_nodes(join, &parts->part[p]) || !number_tets(join, p))
            return false;
        faces += parts->part[p].mesh.faces;
    }
    join->open = tm_new(faces, sizeof *join->open);
    if (!join->open || !make_tets(join))
        return false;
    tm_parallel(threads, parts->count, join_tets, join);
    mesh->faces = 0;
    if (tm_tet_mesh_reserve(mesh, 0, 0, faces, 0, join->error) != TM_OK)
        return false;
    for (size_t p = 0; p < parts->count; p++)
        join_faces(join, (uint32_t)p);
    close_faces(join);
    return mesh->edges == 0 || join_edges(join);
}

tm_status tm_tet_parts_join(tm_tet_parts *parts, tm_tet_mesh *mesh, unsigned threads,
                            tm_error *error)
{
    joining join = {.parts = parts, .mesh = mesh, .error = error};
    join.first = tm_new(parts->count + 1, sizeof *join.first);
    join.number = calloc(parts->count, sizeof *join.number);
    const bool done = join.first && join.number && join_all(&join, threads);
    for (size_t p = 0; join.number && p < parts->count; p++)
        free(join.number[p]);
    free(join.number);
    free(join.first);
    free(join.open);
    tm_tet_parts_free(parts);
    return done ? TM_OK : tm_fail_memory(error);
}
