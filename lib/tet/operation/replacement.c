/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "replacement.h"

#include "../mesh_set.h"

#include <stdlib.h>
#include <string.h>

/* A face of the cavity, by its nodes. */
typedef struct tm_face_slot {
    uint32_t node[3]; /* ascending */
    uint32_t half;
    uint32_t across;
} face_slot;

/* What a slot is; in bytes of their own, so that few have to be cleared. */
enum {
    EMPTY,
    OUTER, /* of an old tetrahedron, as `half`; `across` is what stood beside it */
    INNER, /* between two old ones: free again */
    FRESH  /* of a new tetrahedron, as `half` */
};

void tm_replacement_table_free(tm_replacement_table *table)
{
    free(table->slot);
    free(table->state);
    *table = (tm_replacement_table){0};
}

/* How many slots keep the table at most half full: two new tetrahedra share a face, or it
 * is an outer one of an old tetrahedron, or a renewed one. */
static size_t room_for(size_t old_count, size_t count)
{
    enum { FIRST = 64, RENEWALS = 2 };
    size_t room = FIRST, faces = 4 * old_count + 2 * count + RENEWALS;
    while (room < 2 * faces)
        room *= 2;
    return room;
}

bool tm_replacement_table_reserve(tm_replacement_table *table, size_t old_count,
                                  size_t count)
{
    size_t room = room_for(old_count, count);
    if (room <= table->room)
        return true;
    face_slot *slot = malloc(room * sizeof *slot);
    uint8_t *state = malloc(room);
    if (!slot || !state) {
        free(slot);
        free(state);
        return false;
    }
    tm_replacement_table_free(table);
    table->slot = slot;
    table->state = state;
    table->room = room;
    return true;
}

static void order(uint32_t *a, uint32_t *b)
{
    uint32_t low = *a < *b ? *a : *b, high = *a < *b ? *b : *a;
    *a = low;
    *b = high;
}

/* The slot of a face, with its nodes set. */
static inline size_t find(const tm_replacement_table *table, size_t used, uint32_t a,
                          uint32_t b, uint32_t c)
{
    const uint64_t golden = 0x9E3779B97F4A7C15u; /* 2^64 / golden ratio */
    order(&a, &b);
    order(&b, &c);
    order(&a, &b);
    uint64_t key = (((uint64_t)a << 32 | b) * golden) ^ c;
    size_t s = (size_t)((key * golden) >> 32) & (used - 1);
    for (;; s = (s + 1) & (used - 1)) {
        face_slot *slot = &table->slot[s];
        if (table->state[s] == EMPTY) {
            slot->node[0] = a;
            slot->node[1] = b;
            slot->node[2] = c;
            return s;
        }
        if (slot->node[0] == a && slot->node[1] == b && slot->node[2] == c)
            return s;
    }
}

static inline size_t find_half(const tm_replacement_table *table, size_t used,
                               const uint32_t n[4], uint32_t i)
{
    return find(table, used, n[(i + 1) & 3], n[(i + 2) & 3], n[(i + 3) & 3]);
}

static void note_old_faces(const tm_tet_mesh *mesh, const tm_replacement *what,
                           const tm_replacement_table *table, size_t used)
{
    for (size_t k = 0; k < what->old_count; k++) {
        uint32_t t = what->old[k];
        for (uint32_t i = 0; i < 4; i++) {
            size_t s = find_half(table, used, mesh->tet[t], i);
            table->state[s] = table->state[s] == EMPTY ? OUTER : INNER;
            table->slot[s].half = 4 * t + i;
            table->slot[s].across = mesh->neighbour[t][i];
        }
    }
}

/* Gives renewed faces their nodes: each is an outer face of the cavity still, in another
 * place. */
static void renew_faces(tm_tet_mesh *mesh, const tm_replacement *what,
                        const tm_replacement_table *table, size_t used)
{
    uint32_t half[2] = {TM_NONE, TM_NONE};
    for (size_t k = 0; k < what->renewals; k++)
        for (size_t s = 0; s < used; s++)
            if (table->state[s] == OUTER &&
                table->slot[s].across == (what->renewal[k].face | TM_FACE_BIT))
                half[k] = table->slot[s].half;
    for (size_t k = 0; k < what->renewals; k++) {
        const uint32_t *n = what->renewal[k].node;
        uint32_t f = what->renewal[k].face;
        memcpy(mesh->face[f].node, n, sizeof mesh->face[f].node);
        size_t s = find(table, used, n[0], n[1], n[2]);
        table->state[s] = OUTER;
        table->slot[s].half = half[k];
        table->slot[s].across = f | TM_FACE_BIT;
    }
}

/* The slots of the new tetrahedra: those of the old ones, then new ones. */
static void take_slots(tm_tet_mesh *mesh, const tm_replacement *what)
{
    size_t width = mesh->regions;
    tm_tet_mesh_spread_set(mesh, what->old, what->old_count);
    for (size_t i = 0; i < what->count; i++) {
        if (i < what->old_count) {
            what->created[i] = what->old[i];
            continue;
        }
        uint32_t t = tm_tet_mesh_new_tet(mesh);
        what->created[i] = t;
        for (size_t k = 0; k < width; k++)
            mesh->region[t * width + k] = mesh->region[what->old[0] * width + k];
    }
    for (size_t i = what->count; i < what->old_count; i++)
        tm_tet_mesh_delete_tet(mesh, what->old[i]);
}

static void connect(tm_tet_mesh *mesh, const tm_replacement *what,
                    const tm_replacement_table *table, size_t used)
{
    for (size_t k = 0; k < what->count; k++) {
        uint32_t t = what->created[k];
        memcpy(mesh->tet[t], what->node[k], sizeof mesh->tet[t]);
        for (uint32_t i = 0; i < 4; i++) {
            size_t s = find_half(table, used, what->node[k], i);
            face_slot *slot = &table->slot[s];
            uint32_t half = 4 * t + i;
            if (table->state[s] == OUTER)
                tm_tet_replace_half(mesh, half, slot->half, slot->across);
            else if (table->state[s] == FRESH)
                tm_tet_join(mesh, half, slot->half);
            table->state[s] = FRESH;
            slot->half = half;
        }
    }
}

static bool has_edge(const uint32_t n[4], uint32_t a, uint32_t b)
{
    return (n[0] == a || n[1] == a || n[2] == a || n[3] == a) &&
           (n[0] == b || n[1] == b || n[2] == b || n[3] == b);
}

/* Forgets the edges of .edge that were in the cavity and are in no new tetrahedron. They
 * are inside the mesh, but where faces are renewed. */
static void forget_edges(tm_tet_mesh *mesh, const tm_replacement *what)
{
    if (!mesh->inner_edges && what->renewals == 0)
        return;
    for (size_t k = 0; k < what->old_count && mesh->edge_of.count > 0; k++) {
        const uint32_t *n = mesh->tet[what->old[k]];
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++) {
                size_t m = 0;
                if (!tm_tet_mesh_edge(mesh, n[i], n[j]))
                    continue;
                while (m < what->count && !has_edge(what->node[m], n[i], n[j]))
                    m++;
                if (m == what->count)
                    tm_tet_mesh_forget_edge(mesh, n[i], n[j]);
            }
    }
}

tm_status tm_tet_replace(tm_tet_mesh *mesh, const tm_replacement *what,
                         tm_replacement_table *table, tm_error *error)
{
    size_t more = what->count > what->old_count ? what->count - what->old_count : 0;
    size_t used = room_for(what->old_count, what->count);
    tm_status status = tm_tet_mesh_reserve(mesh, 0, more, 0, 0, error);
    if (status != TM_OK)
        return status;
    if (!tm_replacement_table_reserve(table, what->old_count, what->count))
        return tm_fail_memory(error);
    memset(table->state, EMPTY, used);
    note_old_faces(mesh, what, table, used);
    renew_faces(mesh, what, table, used);
    forget_edges(mesh, what);
    take_slots(mesh, what);
    connect(mesh, what, table, used);
    return TM_OK;
}
