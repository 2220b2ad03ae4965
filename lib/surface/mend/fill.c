/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Holes: loops of open edges. Where several meet in a node each goes on along the fan of
 * triangles that it is beside there; one that comes to a node again is parted there. */
#include "soup.h"

#include "../../base/array.h"
#include "../../geom/ears.h"
#include "../../mesh/edge_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_soup *soup;
    uint32_t (*side)[2]; /* [nodes]: the open sides, 3 t + i, at a node; TM_NONE */
    uint8_t *sides;      /* [nodes]: how many; more than two count as three */
    bool *done;          /* [3 * triangles] */
    uint32_t *loop, *aside;
    uint32_t *place; /* [nodes]: where in the loop, if it is there */
    const uint32_t *hole;
    size_t looped, loop_room, length, aside_room, piece_room;
    uint32_t (*piece)[3];
    tm_edge_map edges; /* all that there are */
    double most;
    tm_mended *filled;
    tm_error *error;
} filler;

static uint32_t from(const filler *f, uint32_t side)
{
    return f->soup->triangle[side / 3][side % 3];
}

static uint32_t to(const filler *f, uint32_t side)
{
    return f->soup->triangle[side / 3][(side % 3 + 1) % 3];
}

static void add_side(filler *f, uint32_t v, uint32_t side)
{
    if (f->sides[v] < 2)
        f->side[v][f->sides[v]] = side;
    if (f->sides[v] < 3)
        f->sides[v]++;
}

static tm_status prepare(filler *f)
{
    const size_t nodes = f->soup->nodes, triangles = f->soup->triangles;
    f->side = tm_new(nodes, sizeof *f->side);
    f->sides = calloc(nodes + 1, 1);
    f->place = calloc(nodes + 1, sizeof *f->place);
    f->done = calloc(3 * triangles + 1, sizeof *f->done);
    if (!f->side || !f->sides || !f->place || !f->done ||
        !tm_edge_map_reserve(&f->edges, f->soup->edges.edges))
        return tm_fail_memory(f->error);
    for (uint32_t s = 0; s < 3 * triangles; s++) {
        tm_edge_map_put(&f->edges, from(f, s), to(f, s), 0);
        if (!tm_soup_is_open(f->soup, s / 3, s % 3))
            continue;
        add_side(f, from(f, s), s);
        add_side(f, to(f, s), s);
    }
    return TM_OK;
}

static bool is_small(const filler *f)
{
    tm_soup_box box = TM_SOUP_NO_BOX;
    for (size_t i = 0; i < f->length; i++)
        tm_soup_put_in_box(&box, f->soup->xyz[f->hole[i]]);
    return f->length > 2 && tm_soup_box_diagonal(&box) <= f->most;
}

/* Whether an edge is one of the hole. */
static bool is_of_loop(const filler *f, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < f->length; i++) {
        const uint32_t p = f->hole[i], q = f->hole[(i + 1) % f->length];
        if ((p == a && q == b) || (p == b && q == a))
            return true;
    }
    return false;
}

/* Whether no edge inside of the hole is one that there is already. */
static bool is_free(const filler *f, size_t pieces)
{
    for (size_t i = 0; i < pieces; i++)
        for (int k = 0; k < 3; k++) {
            const uint32_t a = f->piece[i][k], b = f->piece[i][(k + 1) % 3];
            if (!is_of_loop(f, a, b) && tm_edge_map_get(&f->edges, a, b))
                return false;
        }
    return true;
}

static tm_status fill(filler *f, int32_t marker)
{
    void *aside = tm_grow(f->aside, &f->aside_room, f->length, sizeof *f->aside);
    if (!aside)
        return tm_fail_memory(f->error);
    f->aside = aside;
    void *piece = tm_grow(f->piece, &f->piece_room, f->length, sizeof *f->piece);
    if (!piece)
        return tm_fail_memory(f->error);
    f->piece = piece;
    const size_t pieces =
        tm_cut_ears(f->soup->xyz, f->hole, f->length, f->aside, f->piece);
    if (pieces != f->length - 2 || !is_free(f, pieces))
        return TM_OK;
    if (!tm_edge_map_reserve(&f->edges, 3 * pieces))
        return tm_fail_memory(f->error);
    tm_mend_count(f->filled, f->soup->xyz[f->hole[0]]);
    tm_status status = TM_OK;
    for (size_t i = 0; i < pieces && status == TM_OK; i++) {
        for (int k = 0; k < 3; k++)
            tm_edge_map_put(&f->edges, f->piece[i][k], f->piece[i][(k + 1) % 3], 0);
        status = tm_soup_add(f->soup, f->piece[i], marker, f->error);
    }
    return status;
}

/* The open side at the other end of the fan of triangles at node v that an open side
 * ends; TM_NONE where a crowded edge is in it. */
static uint32_t turn_around(const filler *f, uint32_t side, uint32_t v)
{
    const tm_polygon_edges *edges = &f->soup->edges;
    for (;;) {
        const uint32_t t = side / 3, i = side % 3;
        const uint32_t other = 3 * t + (i + (from(f, side) == v ? 2 : 1)) % 3;
        const size_t e = edges->edge_of[other], begin = edges->start[e];
        if (edges->start[e + 1] == begin + 1)
            return other;
        if (edges->start[e + 1] > begin + 2)
            return TM_NONE;
        side = 3 * edges->polygon[begin + (edges->polygon[begin] == t)];
        while (edges->edge_of[side] != e)
            side++;
    }
}

static uint32_t next_side(const filler *f, uint32_t side, uint32_t v)
{
    return f->sides[v] == 2 ? f->side[v][f->side[v][0] == side] : turn_around(f, side, v);
}

/* Adds a node to the loop. If it has that already, what came since then is a hole. */
static tm_status add_node(filler *f, uint32_t v, int32_t marker)
{
    const uint32_t place = f->place[v];
    if (place >= f->looped || f->loop[place] != v) {
        f->place[v] = (uint32_t)f->looped;
        return tm_append(&f->loop, &f->looped, &f->loop_room, v)
                   ? TM_OK
                   : tm_fail_memory(f->error);
    }
    f->hole = f->loop + place;
    f->length = f->looped - place;
    f->looped = place + 1;
    return is_small(f) ? fill(f, marker) : TM_OK;
}

/* Goes around a hole, against the triangle of the side that it begins with. */
static tm_status walk(filler *f, uint32_t first)
{
    const int32_t marker = f->soup->marker ? f->soup->marker[first / 3] : 0;
    uint32_t side = first, v = to(f, first);
    f->looped = 0;
    tm_status status = add_node(f, v, marker);
    while (status == TM_OK && side != TM_NONE && !f->done[side]) {
        f->done[side] = true;
        v = from(f, side) == v ? to(f, side) : from(f, side);
        status = add_node(f, v, marker);
        side = next_side(f, side, v);
    }
    return status;
}

tm_status tm_soup_fill(tm_soup *soup, double most, tm_mended *filled, tm_error *error)
{
    filler f = {.soup = soup, .most = most, .filled = filled, .error = error};
    const size_t sides = 3 * soup->triangles;
    tm_status status = prepare(&f);
    for (uint32_t s = 0; s < sides && status == TM_OK; s++)
        if (!f.done[s] && tm_soup_is_open(soup, s / 3, s % 3))
            status = walk(&f, s);
    free(f.side);
    free(f.sides);
    free(f.place);
    free(f.done);
    free(f.loop);
    free(f.aside);
    free(f.piece);
    tm_edge_map_free(&f.edges);
    return status;
}
