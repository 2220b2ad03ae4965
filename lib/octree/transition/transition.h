/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How a leaf with smaller neighbours is divided into hexahedra, wedges, pyramids and
 * tetrahedra. Neighbours agree because each face is divided by what is split on it alone.
 * Points of a leaf are those of octree.h. */
#ifndef TM_TRANSITION_TRANSITION_H
#define TM_TRANSITION_TRANSITION_H

#include "../../base/extern_c.h"

#include <stdbool.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* The state of a leaf: bit e (0 … 11) where edge e has a node in its middle, bit 12 + f
 * where face f has one; then all four edges of the face have one too. */
typedef uint32_t tm_leaf_state;

enum { TM_LEAF_STATE_BITS = 18, TM_FACE_PIECES = 5 };

/* An element or a face piece: k points. Elements in the order of .mix. */
typedef struct tm_piece {
    uint8_t k;
    uint8_t point[8];
} tm_piece;

/* The division of a leaf; `centre`: it has a node at TM_LEAF_CENTRE. */
typedef struct tm_transition {
    uint16_t pieces;
    bool centre;
    const tm_piece *piece;
} tm_transition;

/* The division of the leaf of that state, which must be one that occurs. O(1). */
tm_transition tm_transition_of(tm_leaf_state state);

/* The triangles and quadrilaterals that face f becomes, at most TM_FACE_PIECES; seen from
 * outside the leaf they turn counter-clockwise. Returns how many. */
unsigned tm_face_pieces(tm_leaf_state state, unsigned f, tm_piece piece[TM_FACE_PIECES]);

TM_EXTERN_C_END

#endif
