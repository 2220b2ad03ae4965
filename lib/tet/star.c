/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "star.h"

#include "../base/array.h"

#include <stdlib.h>

enum { CORNER_SUM = 0 + 1 + 2 + 3 };

/* The edge between two corners. */
static const uint8_t edge_between[4][4] = {
    {0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}};

void tm_star_free(tm_star *star)
{
    free(star->tet);
    free(star->ring);
    free(star->edge);
    *star = (tm_star){0};
}

/* Room for `needed` tetrahedra and their ring. */
static bool reserve(tm_star *star, size_t needed)
{
    if (needed < star->room)
        return true;
    size_t room = star->room;
    uint32_t *tet = tm_grow(star->tet, &room, needed + 1, sizeof *tet);
    if (!tet)
        return false;
    star->tet = tet;
    size_t ring_room = star->room;
    uint32_t *ring = tm_grow(star->ring, &ring_room, room, sizeof *ring);
    if (!ring)
        return false;
    star->ring = ring;
    size_t edge_room = star->room;
    uint8_t *edge = tm_grow(star->edge, &edge_room, room, sizeof *edge);
    if (!edge)
        return false;
    star->edge = edge;
    star->room = room;
    return true;
}

/* An end of what is found of a star: the tetrahedron, and its corner opposite the face
 * through which the walk goes on. */
typedef struct {
    uint32_t t;
    uint32_t behind;
} star_end;

/* The half face beyond the end; TM_NONE on the boundary. */
static inline uint32_t half_beyond(const tm_tet_mesh *mesh, const star_end *end,
                                   bool *constrained_face)
{
    uint32_t across = mesh->neighbour[end->t][end->behind];
    if (!(across & TM_FACE_BIT))
        return across;
    *constrained_face = true;
    return tm_tet_across(mesh, end->t, end->behind);
}

/* Steps through that half face; the place in the star that this is becomes known. */
static inline void step_beyond(const tm_tet_mesh *mesh, tm_star *star, star_end *end,
                               uint32_t across, size_t place, size_t ring_place)
{
    uint32_t u = across / 4, ahead = across % 4;
    /* The corners of u say which neighbour is next: do not wait for both in turn. */
    __builtin_prefetch(mesh->neighbour[u]);
    uint32_t a = tm_tet_corner(mesh, u, star->a), b = tm_tet_corner(mesh, u, star->b);
    star->tet[place] = u;
    star->edge[place] = edge_between[a][b];
    star->ring[ring_place] = mesh->tet[u][ahead];
    *end = (star_end){u, CORNER_SUM - ahead - a - b};
}

/* Moves the tetrahedra from `from` on, and the ring nodes before or behind them, to `to`
 * which is lower. */
static void move_down(tm_star *star, size_t from, size_t to, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        star->tet[to + i] = star->tet[from + i];
        star->ring[to + i] = star->ring[from + i];
        star->edge[to + i] = star->edge[from + i];
    }
}

static void move_up(tm_star *star, size_t from, size_t to, size_t count)
{
    for (size_t i = count; i-- > 0;) {
        star->tet[to + i] = star->tet[from + i];
        star->ring[to + i] = star->ring[from + i];
        star->edge[to + i] = star->edge[from + i];
    }
}

/* More room; the `back` last items stay the last ones. */
static bool widen(tm_star *star, size_t back)
{
    size_t room = star->room;
    if (!reserve(star, 2 * room))
        return false;
    move_up(star, room - back, star->room - back, back);
    return true;
}

/* Walks both ways in turn, so that one need not wait for the other's memory: what is
 * ahead of t is put behind it, what comes before it at the end of the arrays. */
bool tm_star_around(const tm_tet_mesh *mesh, uint32_t t, unsigned e, tm_star *star)
{
    enum { FIRST_ROOM = 32 };
    const uint8_t *corner = tm_edge_corner[e];
    const uint32_t *n = mesh->tet[t];
    if (!reserve(star, FIRST_ROOM))
        return false;
    star->a = n[corner[0]];
    star->b = n[corner[1]];
    star->tet[0] = t;
    star->edge[0] = (uint8_t)e;
    star->ring[0] = n[corner[2]];
    star->ring[1] = n[corner[3]];
    star_end front = {t, corner[2]}, rear = {t, corner[3]};
    size_t ahead = 1, back = 0;
    bool constrained_face = false, closed = false, front_ends = false, rear_ends = false;
    while (!closed && !(front_ends && rear_ends)) {
        if (ahead + 2 * back + 4 > star->room && !widen(star, back))
            return false;
        if (!front_ends) {
            uint32_t across = half_beyond(mesh, &front, &constrained_face);
            front_ends = across == TM_NONE;
            closed = !front_ends && across / 4 == rear.t;
            if (!front_ends && !closed) {
                step_beyond(mesh, star, &front, across, ahead, ahead + 1);
                ahead++;
            }
        }
        if (!closed && !rear_ends) {
            uint32_t across = half_beyond(mesh, &rear, &constrained_face);
            rear_ends = across == TM_NONE;
            closed = !rear_ends && across / 4 == front.t;
            if (!rear_ends && !closed) {
                back++;
                step_beyond(mesh, star, &rear, across, star->room - back,
                            star->room - back);
            }
        }
    }
    star->constrained_face = constrained_face;
    star->closed = closed;
    star->size = ahead + back;
    if (closed) {
        move_down(star, star->room - back, ahead, back);
        star->ring[star->size] = star->ring[0];
    } else if (back > 0) {
        star->ring[ahead + back] = star->ring[ahead];
        move_up(star, 0, back, ahead);
        move_down(star, star->room - back, 0, back);
    }
    return true;
}

bool tm_star_between(const tm_tet_mesh *mesh, uint32_t t, uint32_t a, uint32_t b,
                     tm_star *star)
{
    uint32_t i = tm_tet_corner(mesh, t, a), j = tm_tet_corner(mesh, t, b);
    return tm_star_around(mesh, t, edge_between[i][j], star);
}

bool tm_star_is_simple(const tm_tet_mesh *mesh, const tm_star *star)
{
    if (mesh->flat == 0)
        return true;
    size_t count = star->size + !star->closed;
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++)
            if (star->ring[i] == star->ring[j])
                return false;
    return true;
}

bool tm_star_is_free(const tm_tet_mesh *mesh, const tm_star *star)
{
    if (!star->closed || star->constrained_face)
        return false;
    if (!mesh->inner_marked_edges)
        return true;
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, star->a, star->b);
    return !(edge && edge->marker != 0);
}
