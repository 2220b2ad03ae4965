/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What finite volume methods judge polyhedra by. They look from the centroids of cells
 * and facets; the measures are those of OpenFOAM's checkMesh (primitiveMeshCheck.C),
 * which has a facet's centroid and area by its triangles around the mean of its nodes,
 * and a cell's by its pyramids around the mean of its facets' centroids. */
#ifndef TM_EXAMINE_POLY_FINITE_VOLUME_H
#define TM_EXAMINE_POLY_FINITE_VOLUME_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../mesh/poly_arrays.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* Beyond these checkMesh complains. */
#define TM_FV_NON_ORTHOGONALITY 70.0 /* degrees */
#define TM_FV_SKEWNESS          4.0

/* All are 0 where there is nothing to be measured. */
typedef struct tm_poly_finite_volume {
    double max_non_orthogonality; /* degrees between the normal of a facet and the line */
    double mean_non_orthogonality; /* from one cell's centroid to the other's */
    size_t non_orthogonal;         /* facets above TM_FV_NON_ORTHOGONALITY */
    double
        max_skewness; /* how far that line misses the facet's centroid, by its extent */
    size_t skew;      /* facets above TM_FV_SKEWNESS */
    size_t wrong_pyramids; /* of a facet and a centroid: not of positive volume */
    size_t unseen;         /* facets not all of which a centroid beside them sees */
    double max_bend;      /* 1 - area / sum of the triangles' areas: 0 for plane facets */
    double volume_spread; /* the volume that 95 % do not exceed, over that for 5 % */
    double max_diameter;  /* of the boxes around cells: their diagonal */
} tm_poly_finite_volume;

/* Measures all facets that belong to the cells that they name. TM_ERROR_SYSTEM where
 * memory is out. O(corners + cells log cells). */
tm_status tm_poly_finite_volume_measure(tm_poly_finite_volume *measures,
                                        const tm_poly_arrays *mesh, tm_error *error);

/* Tells of each cell whether its centroid does not see all of its facets, or has a
 * pyramid that is not of positive volume. TM_ERROR_SYSTEM where memory is out.
 * O(corners). */
tm_status tm_poly_find_unseen(bool *unseen, const tm_poly_arrays *mesh, tm_error *error);

TM_EXTERN_C_END

#endif
