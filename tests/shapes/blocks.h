/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The surface of a set of cells of a grid, with the nodes moved to where they belong. */
#ifndef TM_SHAPES_BLOCKS_H
#define TM_SHAPES_BLOCKS_H

#include "surface.h"

#include <stdbool.h>

/* A box of cells. Where it is wrapped, the last cell along x is beside the first. */
typedef struct grid {
    size_t cells[3];
    bool wrapped;
} grid;

/* Moves a node of the grid, which is in [0, 1]^3; says whether there is a cell. */
typedef void place_function(const grid *g, double at[3]);
typedef bool has_function(const grid *g, const size_t cell[3]);

typedef struct blocks {
    grid grid;
    place_function *place;
    has_function *has; /* NULL: all cells */
    surface *surface;
    uint32_t *number; /* of the nodes: for make_blocks() */
} blocks;

/* Adds the sides of cells that no other cell is beside, counter-clockwise seen from
 * outside where moving nodes keeps them so. */
void make_blocks(blocks *b);

#endif
