/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Who is whose neighbour, and which faces have to stay. */
#include "connect.h"

#include "../base/array.h"
#include "../base/parallel.h"
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

/* A chunk of tetrahedra that one thread orients. */
enum { CHUNK = 1 << 12 };

typedef struct orienting {
    tm_tet_mesh *mesh;
    struct oriented {
        size_t flat, turned;
        size_t twice; /* the first tetrahedron that names a node twice, or SIZE_MAX */
    } * chunk;
} orienting;

static void orient_chunk(void *context, size_t first, size_t past)
{
    tm_tet_mesh *mesh = ((orienting *)context)->mesh;
    struct oriented found = {.twice = SIZE_MAX};
    for (size_t t = first; t < past && found.twice == SIZE_MAX; t++) {
        if (tm_has_node_twice(mesh->tet[t], TM_TET_NODES)) {
            found.twice = t;
            break;
        }
        const int sign = orientation(mesh, t);
        found.flat += sign == 0;
        if (sign < 0) {
            turn(mesh, t);
            found.turned++;
        }
    }
    ((orienting *)context)->chunk[first / CHUNK] = found;
}

/* Makes all tetrahedra positive but the flat ones. */
static tm_status orient(tm_tet_mesh *mesh, unsigned base, unsigned threads,
                        tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(mesh->slots, CHUNK);
    orienting all = {mesh, tm_new(chunks, sizeof *all.chunk)};
    if (!all.chunk)
        return tm_fail_memory(error);
    tm_parallel_runs(threads, mesh->slots, CHUNK, orient_chunk, &all);
    size_t twice = SIZE_MAX;
    for (size_t c = chunks; c-- > 0;) {
        mesh->flat += all.chunk[c].flat;
        mesh->turned += all.chunk[c].turned;
        if (all.chunk[c].twice != SIZE_MAX)
            twice = all.chunk[c].twice;
    }
    free(all.chunk);
    return twice == SIZE_MAX
               ? TM_OK
               : FAIL(".ele", "tetrahedron %zu names a node twice", twice + base);
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

/* Connects one face: h and g are the tetrahedra at it, `listed` its row of .face; g and
 * `listed` may be TM_NONE. */
static tm_status connect_face(tm_tet_mesh *mesh, uint32_t h, uint32_t g, uint32_t listed,
                              tm_error *error)
{
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

/* A face that is not simply between two tetrahedra of one region. */
typedef struct odd_face {
    uint32_t half[2]; /* the tetrahedra at it, or TM_NONE */
    uint32_t row;     /* of .face, or TM_NONE */
    uint32_t more;    /* a third half face or a second row: first_row + row; or TM_NONE */
} odd_face;

static odd_face take_members(const tm_face_table *table, const tm_face *face)
{
    odd_face odd = {{TM_NONE, TM_NONE}, TM_NONE, TM_NONE};
    for (uint32_t m = face->first; m != TM_FACE_END; m = table->member[m].next) {
        const uint32_t id = table->member[m].id;
        uint32_t *place = id >= table->first_row   ? &odd.row
                          : odd.half[0] == TM_NONE ? &odd.half[0]
                                                   : &odd.half[1];
        if (*place == TM_NONE)
            *place = place == &odd.row ? id - table->first_row : id;
        else if (odd.more == TM_NONE)
            odd.more = id;
    }
    return odd;
}

/* Connects it, and refuses what is more than a face. */
static tm_status connect_odd(tm_tet_mesh *mesh, const odd_face *odd, uint32_t first_row,
                             unsigned base, tm_error *error)
{
    const uint32_t *half = odd->half;
    if (odd->more != TM_NONE)
        return odd->more < first_row
                   ? FAIL(".ele", "tetrahedra %u, %u and %u have one face in common",
                          half[0] / 4 + base, half[1] / 4 + base, odd->more / 4 + base)
                   : FAIL(".face", "rows %u and %u are the same triangle",
                          odd->row + base, odd->more - first_row + base);
    if (half[0] != TM_NONE)
        return connect_face(mesh, half[0], half[1], odd->row, error);
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

/* What one thread finds at the faces of a run of nodes. */
typedef struct run {
    odd_face *odd;
    size_t count, room;
    bool folded; /* there are tetrahedra on the same side of a face, or flat ones */
    tm_status status;
    tm_error error;
} run;

typedef struct connection {
    tm_tet_mesh *mesh;
    tm_face_table table;
    run *run;
    uint32_t *cut; /* run i is of nodes cut[i] … cut[i + 1] - 1 */
} connection;

/* Puts the faces that are left in the table behind those of the run. */
static bool append_odd(run *r, tm_face_table *table)
{
    odd_face *moved = tm_grow(r->odd, &r->room, r->count + table->faces, sizeof *r->odd);
    if (!moved)
        return false;
    r->odd = moved;
    tm_face_table_sort(table);
    for (size_t f = 0; f < table->faces; f++) {
        r->folded |= is_folded(table, &table->face[f]);
        r->odd[r->count++] = take_members(table, &table->face[f]);
    }
    return true;
}

static void connect_run(void *context, size_t i)
{
    connection *all = context;
    run *r = &all->run[i];
    tm_face_table table;
    tm_face_table_share(&table, &all->table);
    for (uint32_t v = all->cut[i]; v < all->cut[i + 1] && r->status == TM_OK; v++) {
        r->status = tm_face_table_at(&table, v, &r->error);
        if (r->status != TM_OK)
            break;
        join_pairs(all->mesh, &table, &r->folded);
        if (table.faces > 0 && !append_odd(r, &table))
            r->status = tm_fail_memory(&r->error);
    }
    tm_face_table_free(&table);
}

/* Connects what is odd, in the order of its nodes. */
static tm_status connect_odd_faces(connection *all, unsigned runs, unsigned base,
                                   bool *folded, tm_error *error)
{
    for (unsigned i = 0; i < runs; i++) {
        const run *r = &all->run[i];
        *folded |= r->folded;
        for (size_t f = 0; f < r->count; f++) {
            const tm_status status =
                connect_odd(all->mesh, &r->odd[f], all->table.first_row, base, error);
            if (status != TM_OK)
                return status;
        }
        if (r->status != TM_OK)
            return tm_fail_as(error, &r->error);
    }
    return TM_OK;
}

static tm_status connect_runs(connection *all, unsigned runs, unsigned base, bool *folded,
                              tm_error *error)
{
    all->run = calloc(runs, sizeof *all->run);
    all->cut = tm_new(runs + (size_t)1, sizeof *all->cut);
    tm_status status = all->run && all->cut ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK) {
        tm_face_table_cut(&all->table, runs, all->cut);
        tm_parallel(runs, runs, connect_run, all);
        status = connect_odd_faces(all, runs, base, folded, error);
    }
    for (unsigned i = 0; all->run && i < runs; i++)
        free(all->run[i].odd);
    free(all->run);
    free(all->cut);
    return status;
}

static tm_status connect_faces(tm_tet_mesh *mesh, const uint32_t (*listed)[3],
                               size_t listed_count, unsigned base, unsigned threads,
                               bool *folded, tm_error *error)
{
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .elements = mesh->slots,
                               .item = (const uint32_t *)mesh->tet,
                               .faces = listed_count,
                               .face = listed};
    connection all = {.mesh = mesh};
    tm_status status = tm_face_table_make(&all.table, &view, threads, error);
    if (status == TM_OK)
        status = connect_runs(&all, tm_threads_for(threads, threads, mesh->slots), base,
                              folded, error);
    tm_face_table_free(&all.table);
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

tm_status tm_tet_mesh_connect(tm_tet_mesh *mesh, unsigned base, unsigned threads,
                              tm_error *error)
{
    size_t listed_count = mesh->faces;
    bool folded = false;
    uint32_t(*listed)[3] = tm_new(listed_count, sizeof *listed);
    if (!listed)
        return tm_fail_memory(error);
    for (size_t f = 0; f < listed_count; f++)
        memcpy(listed[f], mesh->face[f].node, sizeof listed[f]);
    tm_status status = orient(mesh, base, threads, error);
    if (status == TM_OK)
        status = connect_faces(mesh, (const uint32_t(*)[3])listed, listed_count, base,
                               threads, &folded, error);
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
