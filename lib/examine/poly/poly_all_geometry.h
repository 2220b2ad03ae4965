/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What checkMesh looks at with -allGeometry besides. */
#ifndef TM_EXAMINE_POLY_ALL_GEOMETRY_H
#define TM_EXAMINE_POLY_ALL_GEOMETRY_H

#include "poly_centroids.h"
#include "poly_finite_volume.h"

/* Adds of a facet that fits: unseen, no_fan, weights, volume ratios. O(corners²) where it
 * is no fan. */
void tm_facet_all_geometry(const tm_poly_centroids *m, size_t f,
                           tm_poly_finite_volume *out);

/* Adds of a cell: determinants and concave. O(facets²) where it is convex. */
void tm_cell_all_geometry(const tm_poly_centroids *m, size_t c,
                          tm_poly_finite_volume *out);

/* One by one; all but the last are to be above a limit, 0 where no other is named.
 *
 * How far the nearer centroid is from the plane of an inner facet, by how far both are:
 * TM_FV_WEIGHT. The smaller volume beside it over the larger one: TM_FV_VOLUME_RATIO. */
double tm_facet_weight(const tm_poly_centroids *m, size_t f);
double tm_facet_volume_ratio(const tm_poly_centroids *m, size_t f);

/* How far the line between the centroids misses the facet's, by the facet's extent that
 * way; on the boundary the line along its normal: to be below TM_FV_SKEWNESS. In
 * poly_finite_volume.c. */
double tm_facet_skewness(const tm_poly_centroids *m, size_t f);

/* The least of the volumes of tetrahedra, by their scale, that triangles of a facet make
 * with the centroid of its first (s = 0) or second cell: of the triangles around the
 * facet's centroid, for one cell, and for both; and of those around the corner where the
 * least for both is largest, or the first one where it is `enough`. */
double tm_facet_sight(const tm_poly_centroids *m, size_t f, int s);
double tm_facet_sights(const tm_poly_centroids *m, size_t f);
double tm_facet_fan(const tm_poly_centroids *m, size_t f, double enough);

/* Of the sum of n n^T over the inner facets of a cell, where n is their area by the mean
 * of these areas, over that of a cube: TM_FV_DETERMINANT. */
double tm_cell_determinant(const tm_poly_centroids *m, size_t c);

/* The same from Σ a aᵀ, Σ |a|, and how many they are. */
double tm_determinant_of(const double spread[3][3], double area, size_t inside);

/* The sine of the angle at which the centroid of facet `other` of cell c is beyond the
 * plane of its facet f: to be below -TM_FV_PLANE, so that a cell with facets around a
 * hanging node in one plane is concave to checkMesh. */
double tm_facet_beyond(const tm_poly_centroids *m, size_t f, size_t other, size_t c);
bool tm_cell_is_concave(const tm_poly_centroids *m, size_t c);

#endif
