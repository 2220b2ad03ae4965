/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far two sets of triangles are from each other, both ways, and their feature curves
 * and corners: bounds that hold everywhere, not at samples only. */
#ifndef TM_SURFACE_SURFACE_DISTANCE_H
#define TM_SURFACE_SURFACE_DISTANCE_H

#include "../surface.h"

TM_EXTERN_C_BEGIN

/* Makes a set of triangles to compare, without asking what it is the surface of: it may
 * be open, branch where regions meet, or cross itself. Filled are nodes, xyz, triangles,
 * triangle, marker, low, high and tree; the rest is 0. Of polygons: nodes with equal
 * coordinates become one; of triangles: nodes that none has go. TM_ERROR_INPUT where
 * there is no triangle, or where polygons cannot be cut (tm_surface_build() says which).
 * *surface need not be initialised; tm_surface_free() also after an error. O(n log n). */
tm_status tm_surface_of_polygons(tm_surface *surface, const tm_polygon_surface *polygons,
                                 tm_error *error);
tm_status tm_surface_of_triangles(tm_surface *surface, const double (*xyz)[3],
                                  size_t nodes, const uint32_t (*triangle)[3],
                                  const int32_t *marker, size_t triangles,
                                  tm_error *error);

/* From the points of one set to the closest ones of another. Of nothing all is 0; to
 * nothing `most` and `bound` are infinite. */
typedef struct tm_distance {
    size_t parts; /* triangles, segments of curves, or corners, that are measured from */
    double most;  /* the largest distance found, from a point `at` to the point `to` */
    double bound; /* none is larger: most + tolerance, or less where that is proved */
    double mean;  /* over area, length or number, from one point of each piece */
    double at[3], to[3];
} tm_distance;

enum { TM_THERE, TM_BACK, TM_WAYS };

typedef struct tm_surface_comparison {
    double diagonal;  /* of the bounding box of the second set */
    double tolerance; /* bound - most, at most: 1e-6 diagonals; see below */
    bool rough;       /* the second has sharp edges all over: curves are not compared */
    tm_distance surface[TM_WAYS]; /* from the first set to the second, and back */
    tm_distance curve[TM_WAYS];   /* of feature curves to feature curves */
    tm_distance corner[TM_WAYS];  /* of corners to corners */
} tm_surface_comparison;

/* Compares two sets that the functions above have made. Feature curves are the edges that
 * have another number of triangles than two, of which the normals beside them differ by
 * more than feature_angle degrees, and, if both sets have several markers, those between
 * different markers. Corners are nodes where another number of them than two meet, or two
 * at a larger angle.
 *
 * Branch and bound: the distance to a triangle of the other set is convex, so that on a
 * convex piece it is largest at a corner of it, and the distance to the whole set is no
 * more than that; nor does it grow faster than the way along the piece. Where neither
 * shows that a piece cannot have a larger distance than the largest so far, by more than
 * the tolerance, it is cut: between the triangles that are closest to two of its points,
 * at the borders of one, or in halves. (Compare M. Tang, M. Lee, Y. J. Kim, Interactive
 * Hausdorff distance computation for general polygonal models, ACM Transactions on
 * Graphics 28, 2009.) The number of pieces is limited; where that is reached, bound is
 * what was proved until then. Expected O(n log n). */
tm_status tm_surface_compare(tm_surface_comparison *comparison, const tm_surface *first,
                             const tm_surface *second, double feature_angle,
                             tm_error *error);

TM_EXTERN_C_END

#endif
