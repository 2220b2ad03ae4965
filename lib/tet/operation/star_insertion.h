/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Insertion of a point into the star of an edge: the edge goes, and the point is joined
 * to all outer faces of the star; n tetrahedra become 2n. (Balboa 2020, section 3.1.) */
#ifndef TM_OPERATION_STAR_INSERTION_H
#define TM_OPERATION_STAR_INSERTION_H

#include "../../element/tet_measure.h"
#include "../star.h"

/* The mean of the star's nodes. */
void tm_star_centroid(const tm_tet_mesh *mesh, const tm_star *star, double p[3]);

/* The mean of the centroids of the star's tetrahedra. */
void tm_star_wcentroid(const tm_tet_mesh *mesh, const tm_star *star, double p[3]);

/* The midpoint of the edge. */
void tm_star_midpoint(const tm_tet_mesh *mesh, const tm_star *star, double p[3]);

/* Whether p sees every outer face from inside: all 2n tetrahedra that its insertion
 * would make are positive, exactly. O(n). */
bool tm_star_sees(const tm_tet_mesh *mesh, const tm_star *star, const double p[3]);

/* Whether p is in one of the star's tetrahedra. O(n). */
bool tm_star_contains(const tm_tet_mesh *mesh, const tm_star *star, const double p[3]);

/* The quality of the worst tetrahedron that the insertion of p would make; 0 where that
 * is below `least`. O(n). */
double tm_star_insertion_quality(const tm_tet_mesh *mesh, const tm_star *star,
                                 const double p[3], tm_tet_measure measure, double least);

/* Both: tm_star_sees(), and if so, *quality as above. O(n). */
bool tm_star_try_insertion(const tm_tet_mesh *mesh, const tm_star *star,
                           const double p[3], tm_tet_measure measure, double least,
                           double *quality);

/* Inserts p, which tm_star_sees(), as a new node: the corner of created[0] that replaces
 * star->b. With on_edge, p is the midpoint of the edge: faces that stay, and an edge of
 * .edge, are split, and p gets the marker of the edge, or of a face; else
 * tm_star_is_free() must hold. Node attributes are interpolated. created[0 … 2n) are the
 * tetrahedra made. TM_ERROR_SYSTEM, with nothing changed, where memory is out. O(n). */
tm_status tm_star_insert(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                         bool on_edge, uint32_t *created, tm_error *error);

#endif
