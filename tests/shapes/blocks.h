/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The surface of a set of cells of a grid, with the nodes moved to where they belong, and
 * the walls between regions of them. */
#ifndef TM_SHAPES_BLOCKS_H
#define TM_SHAPES_BLOCKS_H

#include "surface.h"

#include <stdbool.h>

/* A box of cells. Where it is wrapped, the last cell along x is beside the first. */
typedef struct grid {
    size_t cells[3];
    bool wrapped;
} grid;

/* Moves a node of the grid, which is in [0, 1]^3; says which region a cell is in, 0 where
 * there is none. */
typedef void place_function(const grid *g, double at[3]);
typedef unsigned region_function(const grid *g, const size_t cell[3]);

typedef struct blocks {
    grid grid;
    place_function *place;
    region_function *region; /* NULL: all cells are in region 1 */
    surface *surface;
    uint32_t *number; /* of the nodes: for make_blocks() */
} blocks;

/* Adds the sides of cells that no other cell of the same region is beside, once, those
 * that none is counter-clockwise seen from outside where moving nodes keeps them so. */
void make_blocks(blocks *b);

#endif
