/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements at a sharp tip of the surface, made anew with one element on the tip. */
#ifndef TM_REPAIR_SHARP_CORNER_H
#define TM_REPAIR_SHARP_CORNER_H

#include "repair_trial.h"

enum { TM_SHARP_CORNER_PARTS = 48, TM_SHARP_CORNER_ITEMS = 5 * TM_SHARP_CORNER_PARTS };

typedef struct tm_sharp_corner {
    size_t parts;
    size_t start[TM_SHARP_CORNER_PARTS + 1];
    uint32_t item[TM_SHARP_CORNER_ITEMS];
} tm_sharp_corner;

/* `tip` is a node of the boundary, all of whose elements have an edge to the node
 * `middle` inside. The boundary at the tip is three or four faces; the ends of its edges
 * there become the base of a tetrahedron or a pyramid on the tip, and what else is of the
 * `count` elements, which are all at the middle, is divided from the middle: where
 * an element had the dihedral angle of a third of the tip, this one has all of it.
 * Quadrilaterals of the boundary at the tip are cut. Where the tip is not `whole`, there
 * is a tetrahedron to the middle from each of its triangles instead: one element on a tip
 * that is nearly flat would be as flat. False where that cannot be. */
bool tm_sharp_corner_divide(tm_sharp_corner *parts, const tm_mixed_mesh *mesh,
                            const uint32_t *element, size_t count, uint32_t corner,
                            uint32_t middle, bool whole);

#endif
