/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octant_points.h"

#include "../../base/array.h"
#include "../../octree/transition/transition.h"

#include <stdlib.h>
#include <string.h>

enum { LEVEL, ANCHOR, FIRST = 4, PAST };

static const uint32_t *row_of(const tm_octant_points *p, size_t o)
{
    return p->octant->integer + tm_block_integers(TM_OCTANT) * o;
}

unsigned tm_octant_level(const tm_octant_points *points, size_t o)
{
    return row_of(points, o)[LEVEL];
}

bool tm_octant_is_filled(const tm_octant_points *points, size_t o)
{
    return row_of(points, o)[FIRST] < row_of(points, o)[PAST];
}

/* A point of an octant in halves of the grid. */
static void place_of(const tm_octant_points *p, const uint32_t *row, unsigned point,
                     uint32_t at[3])
{
    const uint32_t side = (uint32_t)1 << (p->finest - row[LEVEL]);
    for (int i = 0; i < 3; i++)
        at[i] = 2 * row[ANCHOR + i] + side * tm_leaf_point[point][i];
}

/* The slot of a place: its corner, or where it is to be put. */
static uint32_t *find_slot(const tm_octant_points *p, const uint32_t at[3])
{
    uint64_t hash = 0;
    for (int i = 0; i < 3; i++)
        hash = tm_hash(hash, at[i]);
    uint32_t *slot = tm_hash_slot(&p->table, hash);
    while (*slot != TM_HASH_FREE && memcmp(p->corner[*slot], at, sizeof *p->corner) != 0)
        slot = tm_hash_next(&p->table, slot);
    return slot;
}

static void add_corners(tm_octant_points *p, size_t o)
{
    for (unsigned c = TM_LEAF_CORNER; c < TM_LEAF_EDGE; c++) {
        uint32_t at[3];
        place_of(p, row_of(p, o), c, at);
        uint32_t *slot = find_slot(p, at);
        if (*slot != TM_HASH_FREE)
            continue;
        *slot = (uint32_t)p->corners;
        memcpy(p->corner[p->corners++], at, sizeof at);
    }
}

static bool is_on_grid(const tm_octant_points *p, size_t o)
{
    return tm_octant_level(p, o) <= p->finest;
}

tm_status tm_octant_points_make(tm_octant_points *points, const tm_block *mix,
                                const tm_block *octant, const tm_block *root,
                                tm_error *error)
{
    const size_t most = TM_LEAF_EDGE * octant->count;
    *points = (tm_octant_points){.mix = mix, .octant = octant};
    if (root->count > 0 && root->integer[0] <= TM_OCTREE_FINEST)
        points->finest = root->integer[0];
    points->corner = tm_new(most, sizeof *points->corner);
    if (!points->corner || !tm_hash_make(&points->table, most))
        return tm_fail_memory(error);
    for (size_t o = 0; o < octant->count; o++)
        if (tm_octant_is_filled(points, o) && is_on_grid(points, o))
            add_corners(points, o);
    return TM_OK;
}

void tm_octant_points_free(tm_octant_points *points)
{
    tm_hash_free(&points->table);
    free(points->corner);
    *points = (tm_octant_points){0};
}

/* Where an octant has nodes between its corners: corners of smaller ones. */
static tm_leaf_state state_of(const tm_octant_points *p, const uint32_t *row)
{
    tm_leaf_state state = 0;
    for (unsigned i = 0; i < TM_LEAF_STATE_BITS; i++) {
        uint32_t at[3];
        place_of(p, row, TM_LEAF_EDGE + i, at);
        if (*find_slot(p, at) != TM_HASH_FREE)
            state |= (tm_leaf_state)1 << i;
    }
    return state;
}

/* Takes the nodes of an element that a piece is; whether it can be. */
static bool take_piece(const tm_block *mix, size_t e, const tm_piece *piece,
                       uint32_t node[TM_OCTANT_POINTS])
{
    const uint32_t *item = mix->item + mix->start[e];
    if (mix->start[e + 1] - mix->start[e] != piece->k)
        return false;
    for (unsigned c = 0; c < piece->k; c++) {
        uint32_t *at = &node[piece->point[c]];
        if (*at != TM_NONE && *at != item[c])
            return false;
        *at = item[c];
    }
    return true;
}

bool tm_octant_points_find(const tm_octant_points *points, size_t o,
                           uint32_t node[TM_OCTANT_POINTS])
{
    const uint32_t *row = row_of(points, o);
    for (int i = 0; i < TM_OCTANT_POINTS; i++)
        node[i] = TM_NONE;
    if (!is_on_grid(points, o))
        return false;
    const tm_transition t = tm_transition_of(state_of(points, row));
    bool fits = row[FIRST] <= row[PAST] && row[PAST] - row[FIRST] >= t.pieces;
    for (uint32_t i = 0; i < t.pieces && fits; i++)
        fits = take_piece(points->mix, row[FIRST] + i, &t.piece[i], node);
    return fits;
}
