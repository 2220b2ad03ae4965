/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What finite volume methods judge polyhedra by. They look from the centroids of cells
 * and facets; the measures and limits are those of OpenFOAM's checkMesh
 * (primitiveMeshCheck.C, polyMeshCheck.C). */
#ifndef TM_EXAMINE_POLY_FINITE_VOLUME_H
#define TM_EXAMINE_POLY_FINITE_VOLUME_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../mesh/poly_arrays.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* Beyond these checkMesh complains. */
#define TM_FV_NON_ORTHOGONALITY 70.0              /* degrees */
#define TM_FV_COSINE            0.342020143325669 /* of that */
#define TM_FV_SKEWNESS          4.0
/* Below these, with -allGeometry. */
#define TM_FV_WEIGHT       0.05
#define TM_FV_VOLUME_RATIO 0.01
#define TM_FV_DETERMINANT  0.001
#define TM_FV_PLANE        1e-6

/* All are 0 where there is nothing to be measured. */
typedef struct tm_poly_finite_volume {
    /* Degrees between the normal of a facet and the line from one cell's centroid to the
     * other's; facets above TM_FV_NON_ORTHOGONALITY, and of these those of 90 and more.
     */
    double max_non_orthogonality;
    double mean_non_orthogonality;
    size_t non_orthogonal;
    size_t reversed;
    /* How far that line misses the facet's centroid, by the facet's extent; facets above
     * TM_FV_SKEWNESS. */
    double max_skewness;
    size_t skew;
    /* The volume of the pyramid of a facet and a centroid beside it; not above 0. */
    double min_pyramid;
    size_t wrong_pyramids;
    double max_bend; /* 1 - area / sum of the triangles' areas: 0 for plane facets */

    /* What follows is not measured by tm_poly_finite_volume_check(). */
    double volume_spread; /* the volume that 95 % do not exceed, over that for 5 % */
    size_t unseen;        /* facets not all of which a centroid beside them sees */
    size_t no_fan; /* facets that are seen as triangles around none of their nodes */
    /* Of a facet inside: the nearer centroid's share of the way between both, along the
     * normal; facets below TM_FV_WEIGHT. */
    double min_weight;
    size_t small_weights;
    /* Of the cells beside a facet; below TM_FV_VOLUME_RATIO. */
    double min_volume_ratio;
    size_t small_volume_ratios;
    /* Of a cell: that of the sum of a a^T over its facets inside, where a is their area
     * by the mean of these, over 8; cells below TM_FV_DETERMINANT. */
    double min_determinant;
    size_t small_determinants;
    size_t concave; /* cells with a facet's centroid beyond another's plane, or in it */
} tm_poly_finite_volume;

/* Measures all facets that belong to the cells that they name. The same result for every
 * number of threads. TM_ERROR_SYSTEM where memory is out. O(corners + cells log cells),
 * and O(facets²) for a cell that is convex. */
tm_status tm_poly_finite_volume_measure(tm_poly_finite_volume *measures,
                                        const tm_poly_arrays *mesh, unsigned threads,
                                        tm_error *error);

/* The same, but only what checkMesh looks at without -allGeometry. O(corners). */
tm_status tm_poly_finite_volume_check(tm_poly_finite_volume *measures,
                                      const tm_poly_arrays *mesh, tm_error *error);

/* Tells of each cell whether its centroid does not see all of its facets, or has a
 * pyramid that is not of positive volume. TM_ERROR_SYSTEM where memory is out.
 * O(corners). */
tm_status tm_poly_find_unseen(bool *unseen, const tm_poly_arrays *mesh, tm_error *error);

TM_EXTERN_C_END

#endif
