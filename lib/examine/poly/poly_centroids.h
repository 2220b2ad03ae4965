/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Centroids of facets and cells as OpenFOAM finds them (primitiveMeshTools.C), from which
 * all its measures look: a facet's by its triangles around the mean of its nodes, a
 * cell's by its pyramids around the mean of its facets' centroids. */
#ifndef TM_EXAMINE_POLY_CENTROIDS_H
#define TM_EXAMINE_POLY_CENTROIDS_H

#include "../../base/error.h"
#include "../../geom/vector.h"
#include "../../mesh/poly_arrays.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct tm_facet_centroid {
    double centre[3];
    double area[3]; /* outward from its first cell */
    double size;    /* |area| */
} tm_facet_centroid;

typedef struct tm_cell_centroid {
    double centre[3];
    double volume;
    double mean[3]; /* of the centroids of its facets */
    size_t facets;
} tm_cell_centroid;

typedef struct tm_poly_centroids {
    const tm_poly_arrays *mesh;
    tm_facet_centroid *face; /* [facets] */
    tm_cell_centroid *cell;  /* [cells] */
    double max_bend;         /* of facets: 1 - area / sum of the triangles' areas */
} tm_poly_centroids;

/* TM_ERROR_SYSTEM where memory is out; tm_poly_centroids_free() also then. O(corners). */
tm_status tm_poly_centroids_find(tm_poly_centroids *c, const tm_poly_arrays *mesh,
                                 tm_error *error);
void tm_poly_centroids_free(tm_poly_centroids *c);

/* The same of facets only: `cell` is NULL. */
tm_status tm_poly_centroids_find_facets(tm_poly_centroids *c, const tm_poly_arrays *mesh,
                                        tm_error *error);

/* Finds the centroid of one facet again, and of one cell from those of its facets, as
 * cell_facet has them; where nodes have moved. */
void tm_facet_centroid_find(const tm_poly_centroids *c, size_t f);
void tm_cell_centroid_find(const tm_poly_centroids *c, size_t cell);

static inline const double *tm_facet_corner(const tm_poly_arrays *mesh, size_t f,
                                            size_t i)
{
    return mesh->xyz[mesh->facet_node[mesh->facet_start[f] + i]];
}

static inline size_t tm_facet_corners(const tm_poly_arrays *mesh, size_t f)
{
    return mesh->facet_start[f + 1] - mesh->facet_start[f];
}

/* Whether the facet is one of cells that there are. */
static inline bool tm_facet_fits(const tm_poly_arrays *mesh, size_t f)
{
    return tm_facet_corners(mesh, f) >= 3 && mesh->side[f][0] < mesh->cells &&
           (mesh->side[f][1] == TM_NONE || mesh->side[f][1] < mesh->cells);
}

/* Three times the volume of the pyramid of a facet and a point; `sign` is 1 for its first
 * cell, -1 for its second. */
static inline double tm_facet_pyramid(const tm_facet_centroid *f, const double apex[3],
                                      double sign)
{
    double to[3];
    tm_subtract(to, f->centre, apex);
    return sign * tm_dot(f->area, to);
}

#endif
