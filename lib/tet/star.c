/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "star.h"

#include "../base/array.h"

#include <stdlib.h>

const uint8_t tm_edge_corner[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                      {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

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

/* Walks from tetrahedron t around the edge, entering each next one through the face
 * opposite corner `behind` of the one before, until the boundary or t again. Appends the
 * tetrahedra after t and the ring nodes after the two of t. 1: closed, 0: boundary,
 * -1: no memory. */
static int walk(const tm_tet_mesh *mesh, uint32_t t, uint32_t behind, tm_star *star)
{
    uint32_t first = t;
    for (;;) {
        uint32_t across = mesh->neighbour[t][behind];
        if (across & TM_FACE_BIT) {
            star->kept_face = true;
            across = tm_tet_across(mesh, t, behind);
            if (across == TM_NONE)
                return 0;
        }
        uint32_t u = across / 4, ahead = across % 4;
        if (u == first)
            return 1;
        /* The corners of u say which neighbour is next: do not wait for both in turn. */
        __builtin_prefetch(mesh->neighbour[u]);
        if (!reserve(star, star->size + 2))
            return -1;
        uint32_t a = tm_tet_corner(mesh, u, star->a);
        uint32_t b = tm_tet_corner(mesh, u, star->b);
        star->edge[star->size] = edge_between[a][b];
        star->tet[star->size++] = u;
        star->ring[star->size] = mesh->tet[u][ahead];
        behind = CORNER_SUM - ahead - a - b;
        t = u;
    }
}

static void reverse_bytes(uint8_t *item, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        uint8_t swap = item[i];
        item[i] = item[count - 1 - i];
        item[count - 1 - i] = swap;
    }
}

static void reverse(uint32_t *item, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        uint32_t swap = item[i];
        item[i] = item[count - 1 - i];
        item[count - 1 - i] = swap;
    }
}

bool tm_star_around(const tm_tet_mesh *mesh, uint32_t t, unsigned e, tm_star *star)
{
    const uint8_t *corner = tm_edge_corner[e];
    const uint32_t *n = mesh->tet[t];
    if (!reserve(star, 2))
        return false;
    star->a = n[corner[0]];
    star->b = n[corner[1]];
    star->kept_face = false;
    star->tet[0] = t;
    star->edge[0] = (uint8_t)e;
    star->ring[0] = n[corner[2]];
    star->ring[1] = n[corner[3]];
    star->size = 1;
    int end = walk(mesh, t, corner[2], star);
    star->closed = end == 1;
    if (end != 0)
        return end == 1;
    /* Open: what lies before t is found by walking back, and goes in front. */
    size_t after = star->size;
    reverse(star->tet, after);
    reverse_bytes(star->edge, after);
    reverse(star->ring, after + 1);
    if (walk(mesh, t, corner[3], star) < 0)
        return false;
    reverse(star->tet, star->size);
    reverse_bytes(star->edge, star->size);
    reverse(star->ring, star->size + 1);
    return true;
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
    if (!star->closed || star->kept_face)
        return false;
    if (!mesh->inner_marked_edges)
        return true;
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, star->a, star->b);
    return !(edge && edge->marker != 0);
}
