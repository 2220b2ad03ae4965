/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who is whose neighbour, and which faces have to stay. */
#include "connect.h"

#include "../base/array.h"
#include "../element/shape.h"
#include "../geom/predicates.h"
#include "../mesh/face_table.h"

#include <stdlib.h>
#include <string.h>

#define FAIL(block, ...) tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, block, __VA_ARGS__)

static int orientation(const tm_tet_mesh *mesh, size_t t)
{
    const uint32_t *n = mesh->tet[t];
    return tm_orient3d(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                       mesh->xyz[n[3]]);
}

static void turn(tm_tet_mesh *mesh, size_t t)
{
    uint32_t n = mesh->tet[t][2];
    mesh->tet[t][2] = mesh->tet[t][3];
    mesh->tet[t][3] = n;
}

/* Makes all tetrahedra positive but the flat ones. */
static tm_status orient(tm_tet_mesh *mesh, unsigned base, tm_error *error)
{
    for (size_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        if (n[0] == n[1] || n[0] == n[2] || n[0] == n[3] || n[1] == n[2] ||
            n[1] == n[3] || n[2] == n[3])
            return FAIL(".ele", "tetrahedron %zu names a node twice", t + base);
        int sign = orientation(mesh, t);
        mesh->flat += sign == 0;
        if (sign < 0) {
            turn(mesh, t);
            mesh->turned++;
        }
    }
    return TM_OK;
}

/* Whether two tetrahedra turn around their common face in the same sense, which those on
 * its two sides do not. */
static bool same_sense(const tm_tet_mesh *mesh, uint32_t h, uint32_t g)
{
    const uint32_t *p = mesh->tet[h / 4], *q = mesh->tet[g / 4];
    const uint8_t *i = tm_face_corner[h % 4], *j = tm_face_corner[g % 4];
    int k = p[i[0]] == q[j[0]] ? 0 : p[i[0]] == q[j[1]] ? 1 : 2;
    return p[i[1]] == q[j[(k + 1) % 3]];
}

/* A face entry that has no row in .face. */
static tm_status add_face(tm_tet_mesh *mesh, uint32_t half, tm_error *error)
{
    tm_status status = tm_tet_mesh_reserve(mesh, 0, 0, 1, 0, error);
    if (status != TM_OK)
        return status;
    tm_constrained_face *face = &mesh->face[mesh->faces++];
    *face = (tm_constrained_face){.side = {TM_NONE, TM_NONE}};
    for (int i = 0; i < 3; i++)
        face->node[i] = mesh->tet[half / 4][tm_face_corner[half % 4][i]];
    return TM_OK;
}

/* Connects one face: half[0 … count) are the tetrahedra at it, `listed` its row of .face
 * or TM_NONE. */
static tm_status connect_face(tm_tet_mesh *mesh, const uint32_t *half, size_t count,
                              uint32_t listed, tm_error *error)
{
    uint32_t h = half[0], g = count == 2 ? half[1] : TM_NONE;
    bool stays = g == TM_NONE || !tm_tet_same_region(mesh, h / 4, g / 4) ||
                 (listed != TM_NONE && mesh->face[listed].marker != 0);
    if (!stays) {
        tm_tet_join(mesh, h, g);
        if (listed != TM_NONE) {
            mesh->face[listed].listed = false;
            mesh->dropped_faces++;
        }
        return TM_OK;
    }
    if (listed == TM_NONE) {
        listed = (uint32_t)mesh->faces;
        tm_status status = add_face(mesh, h, error);
        if (status != TM_OK)
            return status;
    }
    mesh->face[listed].side[0] = h;
    mesh->face[listed].side[1] = g;
    mesh->neighbour[h / 4][h % 4] = listed | TM_FACE_BIT;
    if (g != TM_NONE)
        mesh->neighbour[g / 4][g % 4] = listed | TM_FACE_BIT;
    return TM_OK;
}

/* Takes the members of a face apart: tetrahedra and rows of .face. */
static tm_status connect_members(tm_tet_mesh *mesh, const tm_face_table *table,
                                 const tm_face *face, unsigned base, tm_error *error)
{
    uint32_t half[2], listed = TM_NONE;
    size_t count = 0;
    for (uint32_t m = face->first; m != TM_FACE_END; m = table->member[m].next) {
        const uint32_t id = table->member[m].id;
        if (id >= table->first_row) {
            const uint32_t row = id - table->first_row;
            if (listed != TM_NONE)
                return FAIL(".face", "rows %u and %u are the same triangle",
                            listed + base, row + base);
            listed = row;
        } else if (count == 2) {
            return FAIL(".ele", "tetrahedra %u, %u and %u have one face in common",
                        half[0] / 4 + base, half[1] / 4 + base, id / 4 + base);
        } else {
            half[count++] = id;
        }
    }
    if (count > 0)
        return connect_face(mesh, half, count, listed, error);
    mesh->dangling++;
    return TM_OK;
}

/* Whether a face is between tetrahedra on the same side of it, or flat ones. */
static bool is_folded(const tm_face_table *table, const tm_face *face)
{
    const tm_face_member *first = &table->member[face->first];
    return face->elements == 2 && first->turned == table->member[first->next].turned;
}

/* Joins the two tetrahedra of one region at each face of a node that no row names;
 * *folded as below. Only the other faces are left in the table. */
static void join_pairs(tm_tet_mesh *mesh, tm_face_table *table, bool *folded)
{
    size_t left = 0;
    for (size_t f = 0; f < table->faces; f++) {
        const tm_face *face = &table->face[f];
        const tm_face_member *first = &table->member[face->first];
        const tm_face_member *second = first;
        if (face->elements == 2)
            second = &table->member[first->next];
        if (face->elements != 2 || second->next != TM_FACE_END ||
            !tm_tet_same_region(mesh, first->id / 4, second->id / 4)) {
            table->face[left++] = *face;
            continue;
        }
        *folded |= first->turned == second->turned;
        tm_tet_join(mesh, first->id, second->id);
    }
    table->faces = left;
}

/* *folded: there are tetrahedra on the same side of a face, or flat ones. */
static tm_status connect_faces(tm_tet_mesh *mesh, const uint32_t (*listed)[3],
                               size_t listed_count, unsigned base, bool *folded,
                               tm_error *error)
{
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .elements = mesh->slots,
                               .item = (const uint32_t *)mesh->tet,
                               .faces = listed_count,
                               .face = listed};
    tm_face_table table;
    tm_status status = tm_face_table_make(&table, &view, 1, error);
    for (uint32_t v = 0; v < mesh->nodes && status == TM_OK; v++) {
        status = tm_face_table_at(&table, v, error);
        if (status != TM_OK)
            break;
        join_pairs(mesh, &table, folded);
        tm_face_table_sort(&table);
        for (size_t f = 0; f < table.faces && status == TM_OK; f++) {
            *folded |= is_folded(&table, &table.face[f]);
            status = connect_members(mesh, &table, &table.face[f], base, error);
        }
    }
    tm_face_table_free(&table);
    return status;
}

/* Turns a connected tetrahedron: its corners 2 and 3 change places. */
static void turn_connected(tm_tet_mesh *mesh, uint32_t t)
{
    uint32_t across[2] = {mesh->neighbour[t][2], mesh->neighbour[t][3]};
    turn(mesh, t);
    for (uint32_t i = 0; i < 2; i++) {
        uint32_t half = 4 * t + 3 - i, old = 4 * t + 2 + i;
        mesh->neighbour[t][3 - i] = across[i];
        if (across[i] & TM_FACE_BIT) {
            tm_constrained_face *face = &mesh->face[across[i] & ~TM_FACE_BIT];
            face->side[face->side[0] != old] = half;
        } else {
            mesh->neighbour[across[i] / 4][across[i] % 4] = half;
        }
    }
}

/* Turns flat tetrahedra, which have no sense of their own, to agree with a neighbour
 * that has: so they can be told apart from folded ones, and be improved away. */
static void turn_flat(tm_tet_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->slots && mesh->flat > 0; t++) {
        if (orientation(mesh, t) != 0)
            continue;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t g = tm_tet_across(mesh, t, i);
            if (g == TM_NONE || orientation(mesh, g / 4) == 0)
                continue;
            if (same_sense(mesh, 4 * t + i, g))
                turn_connected(mesh, t);
            break;
        }
    }
}

/* Looks for two tetrahedra on the same side of a face: those overlap. (Flat ones have
 * no side.) */
static tm_status check_sides(const tm_tet_mesh *mesh, unsigned base, tm_error *error)
{
    for (uint32_t t = 0; t < mesh->slots; t++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t h = 4 * t + i, g = tm_tet_across(mesh, t, i);
            if (g != TM_NONE && g < h && same_sense(mesh, h, g) &&
                orientation(mesh, t) != 0 && orientation(mesh, g / 4) != 0)
                return FAIL(".ele",
                            "tetrahedra %u and %u overlap: they are on the same side of "
                            "their common face",
                            g / 4 + base, t + base);
        }
    return TM_OK;
}

/* Forgets the rows of .face that need not stay. */
static void drop_faces(tm_tet_mesh *mesh, size_t listed_count)
{
    size_t kept = 0;
    for (size_t f = 0; f < mesh->faces; f++) {
        tm_constrained_face *face = &mesh->face[f];
        if (f < listed_count && !face->listed)
            continue;
        for (int s = 0; s < 2; s++)
            if (face->side[s] != TM_NONE)
                mesh->neighbour[face->side[s] / 4][face->side[s] % 4] =
                    (uint32_t)kept | TM_FACE_BIT;
        mesh->face[kept++] = *face;
    }
    mesh->faces = kept;
}

tm_status tm_tet_mesh_connect(tm_tet_mesh *mesh, unsigned base, tm_error *error)
{
    size_t listed_count = mesh->faces;
    bool folded = false;
    uint32_t(*listed)[3] = tm_new(listed_count, sizeof *listed);
    if (!listed)
        return tm_fail_memory(error);
    for (size_t f = 0; f < listed_count; f++)
        memcpy(listed[f], mesh->face[f].node, sizeof listed[f]);
    tm_status status = orient(mesh, base, error);
    if (status == TM_OK)
        status = connect_faces(mesh, (const uint32_t(*)[3])listed, listed_count, base,
                               &folded, error);
    free(listed);
    if (status == TM_OK) {
        turn_flat(mesh);
        if (folded || mesh->flat > 0)
            status = check_sides(mesh, base, error);
    }
    if (status == TM_OK && mesh->dropped_faces > 0)
        drop_faces(mesh, listed_count);
    if (status == TM_OK)
        status = tm_tet_mesh_find_edges(mesh, error);
    return status;
}

/* The edges of the boundary, in a bucket for each smaller node. */

typedef struct {
    uint32_t larger; /* node */
    uint32_t faces;  /* of the boundary, at the edge */
} edge;

typedef struct {
    uint32_t *start; /* [nodes + 1] */
    uint32_t *past;  /* [nodes]: the edges of bucket v are start[v] … past[v] */
    edge *edge;
} buckets;

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint32_t greater(uint32_t a, uint32_t b)
{
    return a < b ? b : a;
}

static bool is_on_boundary(const tm_constrained_face *face)
{
    return (face->side[0] == TM_NONE) != (face->side[1] == TM_NONE);
}

static edge *find(const buckets *b, uint32_t v, uint32_t w)
{
    uint32_t low = lesser(v, w), high = greater(v, w);
    edge *past = b->edge + b->past[low];
    for (edge *e = b->edge + b->start[low]; e < past; e++)
        if (e->larger == high)
            return e;
    return NULL;
}

/* Room for three edges of each boundary face; false where memory is out. */
static bool start(buckets *b, const tm_tet_mesh *mesh)
{
    b->start = tm_new(mesh->nodes + 1, sizeof *b->start);
    b->past = calloc(mesh->nodes + 1, sizeof *b->past);
    if (!b->start || !b->past)
        return false;
    uint32_t sum = 0;
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3 && is_on_boundary(&mesh->face[f]); i++)
            b->past[lesser(mesh->face[f].node[i], mesh->face[f].node[(i + 1) % 3])]++;
    for (size_t v = 0; v < mesh->nodes; v++) {
        b->start[v] = sum;
        sum += b->past[v];
        b->past[v] = b->start[v];
    }
    b->edge = tm_new(sum, sizeof *b->edge);
    return b->edge != NULL;
}

static void count_faces(buckets *b, const tm_tet_mesh *mesh)
{
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3 && is_on_boundary(&mesh->face[f]); i++) {
            uint32_t v = mesh->face[f].node[i], w = mesh->face[f].node[(i + 1) % 3];
            edge *e = find(b, v, w);
            if (e)
                e->faces++;
            else
                b->edge[b->past[lesser(v, w)]++] = (edge){greater(v, w), 1};
        }
}

/* Locks the edges with more than two boundary faces. */
static bool lock_edges(const buckets *b, tm_tet_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->nodes; v++)
        for (const edge *e = b->edge + b->start[v]; e < b->edge + b->past[v]; e++) {
            if (e->faces <= 2)
                continue;
            if (!tm_edge_map_reserve(&mesh->locked, 1))
                return false;
            tm_edge_map_put(&mesh->locked, v, e->larger, 0);
        }
    return true;
}

static void look_for_inner_edges(const buckets *b, tm_tet_mesh *mesh)
{
    for (size_t e = 0; e < mesh->edges; e++) {
        if (find(b, mesh->edge[e].node[0], mesh->edge[e].node[1]))
            continue;
        mesh->inner_edges = true;
        mesh->inner_marked_edges |= mesh->edge[e].marker != 0;
    }
}

tm_status tm_tet_mesh_find_edges(tm_tet_mesh *mesh, tm_error *error)
{
    buckets b = {0};
    bool done = start(&b, mesh);
    if (done) {
        count_faces(&b, mesh);
        done = lock_edges(&b, mesh);
        look_for_inner_edges(&b, mesh);
    }
    free(b.start);
    free(b.past);
    free(b.edge);
    return done ? TM_OK : tm_fail_memory(error);
}
