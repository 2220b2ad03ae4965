/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shape of one polyhedron: the indicators by which virtual element methods tell good
 * ones (T. Sorgente et al., Polyhedral mesh quality indicator for the virtual element
 * method, arXiv 2112.11365, 2021). */
#ifndef TM_EXAMINE_POLY_SHAPE_H
#define TM_EXAMINE_POLY_SHAPE_H

#include "../geom/kernel.h"
#include "poly_boundary.h"

#include <stdbool.h>
#include <stddef.h>

/* A polyhedron is star-shaped if the radius of the largest ball in its kernel is more
 * than so many times its diameter. */
#define TM_POLY_STAR 1e-9

typedef struct tm_poly_shape {
    double volume;
    double diameter;      /* the largest distance of two of its nodes */
    double min_edge;      /* length */
    double min_face_area; /* of its facets */
    double min_dihedral; /* inside, between facets at an edge, in degrees below 360; of */
    double max_dihedral; /* no edges 360 and 0 */
    double kernel_radius; /* of the largest ball in the kernel, over the diameter; or 0 */
    double kernel_ratio;  /* the kernel's volume over the volume, 0 … 1 */
    bool star_shaped;
} tm_poly_shape;

/* Memory that is kept from one polyhedron to the next. {0} is empty. */
typedef struct tm_poly_shape_memory {
    struct tm_poly_point *place; /* of its nodes; then again, farthest first */
    double (*normal)[3];         /* of its facets, length 1; 0 of those without area */
    double (*plane)[4];          /* of those with area */
    size_t room[3];
    tm_kernel_memory kernel;
} tm_poly_shape_memory;

void tm_poly_shape_memory_free(tm_poly_shape_memory *memory);

/* Measures the polyhedron that `b` bounds. The plane of a facet has the normal of its
 * vector area and goes through the innermost of its nodes; those without area have none.
 * TM_ERROR_SYSTEM where memory is out. About O(corners), at worst O(nodes² + facets²):
 * see tm_kernel_volume(); polyhedra that are not star-shaped need no kernel volume. */
tm_status tm_poly_shape_measure(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                                const tm_poly_boundary *b, const double (*xyz)[3],
                                tm_error *error);

#endif
