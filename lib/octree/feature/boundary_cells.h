/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nodes of an interior boundary by where they are: which are close to a point. */
#ifndef TM_LAYER_BOUNDARY_CELLS_H
#define TM_LAYER_BOUNDARY_CELLS_H

#include "../interior/interior_boundary.h"

typedef struct tm_boundary_cells {
    const tm_interior_boundary *boundary;
    unsigned shift;                /* a cell has 2^shift grid units along each side */
    struct tm_boundary_cell *cell; /* [nodes], sorted by cell */
} tm_boundary_cells;

/* Sorts the nodes into cells twice as large as the largest leaf of the interior boundary.
 * O(n log n). TM_ERROR_SYSTEM where memory is out. */
tm_status tm_boundary_cells_sort(tm_boundary_cells *cells,
                                 const tm_interior_boundary *boundary, tm_error *error);
void tm_boundary_cells_free(tm_boundary_cells *cells);

/* Calls found(context, node) for all nodes closer to the point than a cell's side, and
 * some that are not. */
void tm_boundary_cells_near(const tm_boundary_cells *cells, const double point[3],
                            void (*found)(void *context, uint32_t node), void *context);

/* Which nodes are looked at: those with taken[node] == 0 and set[node] == which, where
 * these are not NULL. */
typedef struct tm_boundary_filter {
    const uint8_t *taken;
    const uint64_t *set;
    uint64_t which;
} tm_boundary_filter;

/* The closest of these nodes that the filter lets pass; TM_NONE where there is none.
 * *distance2 is its squared distance on the lattice, or infinite. */
uint32_t tm_boundary_cells_nearest(const tm_boundary_cells *cells, const double point[3],
                                   tm_boundary_filter filter, double *distance2);

#endif
