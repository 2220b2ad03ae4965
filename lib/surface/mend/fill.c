/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Holes: loops of open edges of which each node has two. */
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
    size_t length, loop_room, aside_room, piece_room;
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
    f->done = calloc(3 * triangles + 1, sizeof *f->done);
    if (!f->side || !f->sides || !f->done ||
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

/* Goes around a hole, against the triangle of the side that it begins with. False where
 * a node has another number of open sides than two; *ok where memory is in. */
static bool walk(filler *f, uint32_t side, bool *ok)
{
    uint32_t v = from(f, side);
    const uint32_t first = to(f, side);
    bool simple = f->sides[first] == 2;
    f->length = 0;
    f->done[side] = true;
    *ok = tm_append(&f->loop, &f->length, &f->loop_room, first);
    while (*ok && v != first && simple) {
        simple = f->sides[v] == 2;
        if (!simple)
            break;
        *ok = tm_append(&f->loop, &f->length, &f->loop_room, v);
        side = f->side[v][f->side[v][0] == side];
        f->done[side] = true;
        v = from(f, side) == v ? to(f, side) : from(f, side);
    }
    return simple;
}

static bool is_small(const filler *f)
{
    tm_soup_box box = TM_SOUP_NO_BOX;
    for (size_t i = 0; i < f->length; i++)
        tm_soup_put_in_box(&box, f->soup->xyz[f->loop[i]]);
    return f->length > 2 && tm_soup_box_diagonal(&box) <= f->most;
}

/* Whether an edge is one of the loop. */
static bool is_of_loop(const filler *f, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < f->length; i++) {
        const uint32_t p = f->loop[i], q = f->loop[(i + 1) % f->length];
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
        tm_cut_ears(f->soup->xyz, f->loop, f->length, f->aside, f->piece);
    if (pieces != f->length - 2 || !is_free(f, pieces))
        return TM_OK;
    if (!tm_edge_map_reserve(&f->edges, 3 * pieces))
        return tm_fail_memory(f->error);
    tm_mend_count(f->filled, f->soup->xyz[f->loop[0]]);
    tm_status status = TM_OK;
    for (size_t i = 0; i < pieces && status == TM_OK; i++) {
        for (int k = 0; k < 3; k++)
            tm_edge_map_put(&f->edges, f->piece[i][k], f->piece[i][(k + 1) % 3], 0);
        status = tm_soup_add(f->soup, f->piece[i], marker, f->error);
    }
    return status;
}

tm_status tm_soup_fill(tm_soup *soup, double most, tm_mended *filled, tm_error *error)
{
    filler f = {.soup = soup, .most = most, .filled = filled, .error = error};
    const size_t sides = 3 * soup->triangles;
    tm_status status = prepare(&f);
    for (uint32_t s = 0; s < sides && status == TM_OK; s++) {
        bool ok = true;
        if (f.done[s] || !tm_soup_is_open(soup, s / 3, s % 3))
            continue;
        const bool simple = walk(&f, s, &ok);
        if (!ok)
            status = tm_fail_memory(error);
        else if (simple && is_small(&f))
            status = fill(&f, soup->marker ? soup->marker[s / 3] : 0);
    }
    free(f.side);
    free(f.sides);
    free(f.done);
    free(f.loop);
    free(f.aside);
    free(f.piece);
    tm_edge_map_free(&f.edges);
    return status;
}
