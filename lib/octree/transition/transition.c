/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks up the table that generate/transitions.c wrote. */
#include "transition.h"

#include "../forest/octree.h"

#include "transitions.h"

enum { EDGES = 12, FACES = 6 };

/* The states with the same edges split follow each other; the bits of those faces that
 * have four split edges, moved together, say which of them it is. */
tm_transition tm_transition_of(tm_leaf_state state)
{
    const unsigned edges = state & ((1U << EDGES) - 1);
    unsigned which = 0, bit = 0;
    for (unsigned f = 0; f < FACES; f++) {
        if ((transition_faces[edges] >> f & 1) != 0)
            which |= (state >> (EDGES + f) & 1) << bit++;
    }
    const size_t s = transition_first[edges] + which;
    const uint32_t first = transition_start[s], end = transition_start[s + 1];
    return (tm_transition){.pieces = (uint16_t)(end - first),
                           .centre = transition_centre[s] != 0,
                           .piece = &transition_piece[first]};
}
