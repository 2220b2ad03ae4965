/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The surface where a function vanishes, by marching tetrahedra. */
#ifndef TM_SHAPES_MARCHING_H
#define TM_SHAPES_MARCHING_H

#include "surface.h"

/* Negative inside. */
typedef double shape_function(const double at[3]);

typedef struct marching {
    size_t cells;
    double low, side; /* of the cube that the cells fill */
    surface *surface;
    /* For make_marching(): */
    double *value;
    uint32_t *number; /* of the node on an edge: 7 for each node of the grid */
} marching;

/* Cuts each of the six tetrahedra along the diagonal of each cell. The function has to be
 * positive on the sides of the cube, and smooth where it vanishes: nodes are spread
 * evenly over the surface in the end. */
void make_marching(marching *m, shape_function *function);

#endif
