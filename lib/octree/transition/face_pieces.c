/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rule for one face. Both leaves at a face see the same of its edges split, and each
 * pattern below is its own mirror image, so they divide it alike. */
#include "../forest/octree.h"
#include "transition.h"

enum { SIDES = 4, RING = 2 * SIDES, RING_CENTRE = RING, PATTERNS = 7 };

/* The corners and edges of each face, counter-clockwise seen from outside: edge i is
 * between corners i and i + 1. */
static const uint8_t face_corner[6][SIDES] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
static const uint8_t face_edge[6][SIDES] = {{8, 6, 10, 4},  {5, 11, 7, 9}, {0, 9, 2, 8},
                                            {10, 3, 11, 1}, {4, 1, 5, 0},  {2, 7, 3, 6}};

/* What a square becomes of which the edges `split` are split: corner i is 2 i, the middle
 * of edge i is 2 i + 1, the centre is 8. */
typedef struct pattern {
    unsigned split;
    bool centre;
    unsigned pieces;
    tm_piece piece[TM_FACE_PIECES];
} pattern;

static const pattern patterns[PATTERNS] = {
    {0x0, false, 1, {{4, {0, 2, 4, 6}}}},
    {0x1, false, 3, {{3, {1, 2, 4}}, {3, {1, 4, 6}}, {3, {1, 6, 0}}}},
    {0x3, false, 4, {{3, {1, 2, 3}}, {3, {3, 4, 6}}, {3, {3, 6, 1}}, {3, {1, 6, 0}}}},
    {0x5, false, 2, {{4, {0, 1, 5, 6}}, {4, {1, 2, 4, 5}}}},
    {0x7, false, 4, {{4, {0, 1, 5, 6}}, {3, {1, 2, 3}}, {3, {3, 4, 5}}, {3, {1, 3, 5}}}},
    {0xf,
     false,
     5,
     {{3, {7, 0, 1}}, {3, {1, 2, 3}}, {3, {3, 4, 5}}, {3, {5, 6, 7}}, {4, {1, 3, 5, 7}}}},
    {0xf,
     true,
     4,
     {{4, {0, 1, 8, 7}}, {4, {1, 2, 3, 8}}, {4, {3, 4, 5, 8}}, {4, {5, 6, 7, 8}}}},
};

/* The pattern that a square with these edges split has after `turn` quarter turns. */
static const pattern *pattern_of(unsigned split, bool centre, unsigned *turn)
{
    for (*turn = 0; *turn < SIDES; ++*turn) {
        const unsigned turned =
            (split >> *turn | split << (SIDES - *turn)) & ((1U << SIDES) - 1);
        for (unsigned p = 0; p < PATTERNS; p++) {
            if (patterns[p].split == turned && patterns[p].centre == centre)
                return &patterns[p];
        }
    }
    return NULL; /* a centre without four edges: not a state that occurs */
}

unsigned tm_face_pieces(tm_leaf_state state, unsigned f, tm_piece piece[TM_FACE_PIECES])
{
    unsigned split = 0;
    uint8_t ring[RING];
    for (unsigned i = 0; i < SIDES; i++) {
        split |= (state >> face_edge[f][i] & 1) << i;
        ring[2 * i] = (uint8_t)(TM_LEAF_CORNER + face_corner[f][i]);
        ring[2 * i + 1] = (uint8_t)(TM_LEAF_EDGE + face_edge[f][i]);
    }
    unsigned turn;
    const pattern *is =
        pattern_of(split, state >> (TM_LEAF_FACE - TM_LEAF_EDGE + f) & 1, &turn);
    if (is == NULL)
        return 0;
    for (unsigned p = 0; p < is->pieces; p++) {
        piece[p].k = is->piece[p].k;
        for (unsigned i = 0; i < is->piece[p].k; i++) {
            const unsigned at = is->piece[p].point[i];
            piece[p].point[i] = at == RING_CENTRE ? (uint8_t)(TM_LEAF_FACE + f)
                                                  : ring[(at + 2 * turn) % RING];
        }
    }
    return is->pieces;
}
