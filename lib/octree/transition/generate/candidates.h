/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All elements that a division may have. */
#ifndef TM_GENERATE_CANDIDATES_H
#define TM_GENERATE_CANDIDATES_H

#include "piece.h"

#include <stddef.h>

/* An element and what the search asks of it. */
typedef struct candidate {
    tm_piece piece;
    unsigned faces;
    piece_face face[PIECE_FACES];
    uint8_t on_side; /* bit f: face f is on a side of the cube */
    uint64_t samples;
    int volume;
    double quality;
} candidate;

typedef struct candidates {
    size_t n, room;
    candidate *at;
    uint32_t *points; /* [n]: the set of points of each */
} candidates;

/* Every tetrahedron, pyramid, wedge and hexahedron on the 27 points that is convex with
 * plane faces and has at least this J_ENS, each once, large ones first. False: there is
 * not enough memory. */
bool all_candidates(double least, candidates *all);

void free_candidates(candidates *all);

#endif
