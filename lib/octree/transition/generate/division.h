/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The division of a leaf in one state. */
#ifndef TM_GENERATE_DIVISION_H
#define TM_GENERATE_DIVISION_H

#include "candidates.h"

enum { MOST_PIECES = 32 };

typedef struct division {
    unsigned pieces;
    bool centre;
    double worst; /* the smallest J_ENS */
    tm_piece piece[MOST_PIECES];
} division;

/* Every piece of a face, joined to the centre. */
void star_of(tm_leaf_state state, division *star);

/* Room for a search; to be given to free(). NULL: there is not enough memory. */
typedef struct search search;

search *new_search(const candidates *all);

/* The best division of which no element is worse than the star's worst: the fewest
 * elements, then no node in the centre, then the best worst element. */
void best_division(search *s, tm_leaf_state state, division *best);

#endif
