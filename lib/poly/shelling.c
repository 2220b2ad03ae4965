/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shelling_star.h"

#include "../base/array.h"
#include "../base/hash.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>
#include <string.h>

void tm_shelling_fork(tm_shelling *other, const tm_shelling *s)
{
    *other = (tm_shelling){.mesh = s->mesh,
                           .options = s->options,
                           .xyz = s->xyz,
                           .piece = s->piece,
                           .centroid = s->centroid};
}

void tm_shelling_end(tm_shelling *other)
{
    free(other->has);
    free(other->member);
    free(other->queue);
    free(other->plane);
    tm_star_free(&other->star);
    *other = (tm_shelling){0};
}

void tm_shelling_free(tm_shelling *s)
{
    free(s->piece);
    free(s->xyz);
    free(s->centroid);
    tm_shelling_end(s);
}

tm_status tm_shelling_start(tm_shelling *s, const tm_tet_mesh *mesh,
                            const tm_poly_options *options, tm_error *error)
{
    *s = (tm_shelling){.mesh = mesh, .options = options};
    s->piece = tm_new(mesh->slots, sizeof *s->piece);
    const bool centred = options->star == TM_STAR_CENTROID;
    s->centroid = calloc(centred ? mesh->slots + 1 : 1, sizeof *s->centroid);
    if (!s->piece || !s->centroid || !tm_shelling_scale(s))
        return tm_fail_memory(error);
    for (size_t t = 0; t < mesh->slots; t++)
        s->piece[t] = TM_NONE;
    return TM_OK;
}

/* The slot of a node, or a free one if the piece has not got it. */
static tm_shelling_node *slot_of(const tm_shelling *s, uint32_t v)
{
    const size_t mask = s->has_room - 1;
    size_t k = tm_hash(0, v) & mask;
    while (s->has[k].turn == s->turn && s->has[k].node != v)
        k = (k + 1) & mask;
    return &s->has[k];
}

static bool has_node(const tm_shelling *s, uint32_t v)
{
    return slot_of(s, v)->turn == s->turn;
}

static void add_node(tm_shelling *s, uint32_t v)
{
    tm_shelling_node *slot = slot_of(s, v);
    s->used += slot->turn != s->turn;
    *slot = (tm_shelling_node){v, s->turn};
}

/* Room for four more nodes: at most half of the slots are used. */
static bool reserve_nodes(tm_shelling *s)
{
    enum { LEAST = 64 };
    const tm_shelling old = *s;
    if (2 * (s->used + 4) <= s->has_room)
        return true;
    const size_t room = s->has_room ? 2 * s->has_room : LEAST;
    tm_shelling_node *has = calloc(room, sizeof *has);
    if (!has)
        return false;
    s->has = has;
    s->has_room = room;
    s->used = 0;
    for (size_t k = 0; k < old.has_room; k++)
        if (old.has[k].turn == s->turn && old.has[k].node != TM_NONE)
            add_node(s, old.has[k].node);
    free(old.has);
    return true;
}

static bool push_neighbours(tm_shelling *s, uint32_t t)
{
    uint32_t *queue = tm_grow(s->queue, &s->queue_room, s->queued + 4, sizeof *queue);
    if (!queue)
        return false;
    s->queue = queue;
    for (int i = 0; i < 4; i++) {
        uint32_t across = s->mesh->neighbour[t][i];
        if (!(across & TM_FACE_BIT) && tm_piece_of(s->piece, across / 4) != s->id)
            queue[s->queued++] = across / 4;
    }
    return true;
}

static bool add(tm_shelling *s, uint32_t t)
{
    uint32_t *member = tm_grow(s->member, &s->member_room, s->size + 1, sizeof *member);
    s->member = member ? member : s->member;
    if (!member || !reserve_nodes(s))
        return false;
    member[s->size++] = t;
    tm_set_piece(s->piece, t, s->id);
    for (int i = 0; i < 4; i++)
        add_node(s, s->mesh->tet[t][i]);
    if (s->options->star)
        tm_shelling_measure(s, t);
    return push_neighbours(s, t);
}

static void begin(tm_shelling *s, uint32_t id, uint32_t t)
{
    s->id = id;
    s->size = s->queued = s->used = 0;
    s->turn++;
    s->depth = -1; /* no centre */
    memcpy(s->origin, s->xyz[s->mesh->tet[t][0]], sizeof s->origin);
    for (int x = 0; x < 3; x++) {
        s->low[x] = HUGE_VAL;
        s->high[x] = -HUGE_VAL;
    }
    memset(s->moment, 0, sizeof s->moment);
}

bool tm_shelling_begin(tm_shelling *s, uint32_t id, uint32_t t)
{
    begin(s, id, t);
    return add(s, t);
}

bool tm_shelling_resume(tm_shelling *s, uint32_t id, const uint32_t *member, size_t size)
{
    begin(s, id, member[0]);
    for (size_t k = 0; k < size; k++)
        if (!add(s, member[k]))
            return false;
    return true;
}

/* Whether a tetrahedron of the piece is at the edge of t between corners i and j; also
 * where that cannot be told. */
static bool has_edge(tm_shelling *s, uint32_t t, unsigned i, unsigned j, bool *memory)
{
    const uint32_t *n = s->mesh->tet[t];
    unsigned e = 0;
    while (!((tm_edge_corner[e][0] == i && tm_edge_corner[e][1] == j) ||
             (tm_edge_corner[e][0] == j && tm_edge_corner[e][1] == i)))
        e++;
    if (tm_edge_map_get(&s->mesh->locked, n[i], n[j]))
        return true;
    if (!tm_star_around(s->mesh, t, e, &s->star)) {
        *memory = false;
        return true;
    }
    for (size_t k = 0; k < s->star.size; k++)
        if (tm_piece_of(s->piece, s->star.tet[k]) == s->id)
            return true;
    return false;
}

/* Whether what t shares with the piece is a disc. */
static bool meets_in_disc(tm_shelling *s, uint32_t t, bool *memory)
{
    unsigned shared[4], shares = 0;
    for (unsigned i = 0; i < 4; i++) {
        uint32_t across = s->mesh->neighbour[t][i];
        bool is_constrained = across & TM_FACE_BIT;
        if (is_constrained)
            across = tm_tet_across(s->mesh, t, i);
        bool is_in = across != TM_NONE && tm_piece_of(s->piece, across / 4) == s->id;
        if (is_in && is_constrained)
            return false; /* the face would be inside */
        if (is_in)
            shared[shares++] = i;
    }
    if (shares == 1)
        return !has_node(s, s->mesh->tet[t][shared[0]]);
    if (shares == 2)
        return !has_edge(s, t, shared[0], shared[1], memory);
    return shares == 3 && !s->options->no_swallow;
}

/* Whether t can be added. */
static bool fits(tm_shelling *s, uint32_t t, bool *memory)
{
    return meets_in_disc(s, t, memory) &&
           (!s->options->star || tm_shelling_stays_star(s, t, memory));
}

static size_t most_tets(const tm_shelling *s)
{
    return s->options->max_tets ? s->options->max_tets : SIZE_MAX;
}

bool tm_shelling_grow(tm_shelling *s, const uint32_t *label, uint32_t name)
{
    bool memory = true;
    for (size_t next = 0; next < s->queued && s->size < most_tets(s); next++) {
        uint32_t t = s->queue[next];
        if (label[t] != name || tm_piece_of(s->piece, t) != TM_NONE ||
            !fits(s, t, &memory)) {
            if (!memory)
                return false;
            continue;
        }
        if (!add(s, t))
            return false;
    }
    return true;
}

/* Takes the last tetrahedra out again, down to the piece as it was, and the nodes that
 * came with them: their slots are no node's then. */
static void undo(tm_shelling *s, const tm_shelling *was, uint32_t old,
                 bool fresh[TM_SHELLING_ADD][4])
{
    while (s->size > was->size) {
        uint32_t t = s->member[--s->size];
        tm_set_piece(s->piece, t, old);
        for (int i = 0; i < 4; i++)
            if (fresh[s->size - was->size][i])
                slot_of(s, s->mesh->tet[t][i])->node = TM_NONE;
    }
    s->queued = was->queued;
    s->depth = was->depth;
    memcpy(s->centre, was->centre, sizeof s->centre);
    memcpy(s->low, was->low, sizeof s->low);
    memcpy(s->high, was->high, sizeof s->high);
    memcpy(s->moment, was->moment, sizeof s->moment);
    if (s->options->star == TM_STAR_CENTROID)
        tm_shelling_set_centroid(s);
}

bool tm_shelling_add(tm_shelling *s, const uint32_t *tet, size_t count, bool *taken)
{
    tm_shelling was = *s;
    const uint32_t old = s->piece[tet[0]];
    bool fresh[TM_SHELLING_ADD][4], memory = true, any = true;
    *taken = false;
    if (s->size + count > most_tets(s))
        return true;
    while (any && s->size < was.size + count) {
        any = false;
        for (size_t k = 0; k < count; k++) {
            if (s->piece[tet[k]] == s->id || !fits(s, tet[k], &memory))
                continue;
            for (int i = 0; i < 4; i++)
                fresh[s->size - was.size][i] = !has_node(s, s->mesh->tet[tet[k]][i]);
            if (!add(s, tet[k]))
                return false;
            any = true;
        }
    }
    *taken = s->size == was.size + count;
    if (!*taken)
        undo(s, &was, old, fresh);
    return memory;
}
