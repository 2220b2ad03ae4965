/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What checkMesh looks at with -allGeometry besides. */
#ifndef TM_EXAMINE_POLY_ALL_GEOMETRY_H
#define TM_EXAMINE_POLY_ALL_GEOMETRY_H

#include "poly_centroids.h"
#include "poly_finite_volume.h"

/* Adds unseen, no_fan, weights, volume ratios, determinants and concave cells.
 * O(corners²) for a facet that is no fan, O(facets²) for a cell that is convex. */
void tm_poly_all_geometry(const tm_poly_centroids *m, tm_poly_finite_volume *out);

/* Whether the centroid of a facet's first (0) or second (1) cell sees all triangles of the
 * facet around its centroid. */
bool tm_facet_is_seen(const tm_poly_centroids *m, size_t f, int s);

#endif
