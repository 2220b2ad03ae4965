/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which side of its polygons each cell is on, from nothing but the polygons' nodes. */
#ifndef TM_MESH_CELL_ORIENT_H
#define TM_MESH_CELL_ORIENT_H

#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Cells as lists of polygons, flat arrays: polygon p has the nodes
 * node[start[p] … start[p + 1]), cell c the polygons
 * cell_polygon[cell_start[c] … cell_start[c + 1]), at most two cells each polygon. */
typedef struct tm_polygon_cells {
    size_t nodes;
    const double (*xyz)[3];
    size_t polygons;
    const size_t *start;
    const uint32_t *node;
    size_t cells;
    const size_t *cell_start;
    const uint32_t *cell_polygon;
} tm_polygon_cells;

/* Sets inward[i] for each entry i of cell_polygon: whether the normal of the polygon, as
 * it turns, points into that cell. Polygons of a cell that have an edge for themselves
 * run through it in opposite senses; what is joined in that way is a shell. It is outward
 * if it encloses a positive volume; but in a cell of several shells, or where there is no
 * volume, rather if that is what the cell on the other side of one of its polygons says:
 * so a cell may lie in a hollow of another one.
 * TM_ERROR_INPUT where a cell is not closed or has not two sides, or two cells are on the
 * same side of a polygon. O(size of the arrays). */
tm_status tm_cells_orient(const tm_polygon_cells *mesh, bool *inward, tm_error *error);

#endif
