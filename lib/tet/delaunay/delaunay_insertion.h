/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Insertion of a point into a mesh that keeps it Delaunay (delaunay.h). */
#ifndef TM_DELAUNAY_DELAUNAY_INSERTION_H
#define TM_DELAUNAY_DELAUNAY_INSERTION_H

#include "delaunay_cavity.h"
#include "../star.h"

typedef struct tm_delaunay {
    tm_delaunay_cavity cavity;
    uint32_t *created; /* [made]: the tetrahedra of the last insertion */
    size_t made;
    double *region;
    size_t created_room, region_room;
} tm_delaunay;

tm_delaunay tm_delaunay_for(const tm_tet_mesh *mesh);
void tm_delaunay_free(tm_delaunay *d);

/* Whether the insertion of p would take all tetrahedra that it should: for callers that
 * rather leave p out than lose the Delaunay property, and counted as refused where not.
 * The same conditions and cost as for the insertion; the mesh stays as it is. */
tm_status tm_delaunay_foresee(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                              tm_delaunay *d, bool *is_whole, tm_error *error);

/* Inserts p, the midpoint of the edge of a star that tm_star_sees() it: the edge is split
 * by tm_star_insert(), and then the node's cavity is joined to it.
 *
 * A Delaunay mesh stays Delaunay if no cavity is cut back; none is in a convex mesh
 * without constrained faces inside, but for what the rounding of midpoints does to its
 * boundary. In any mesh all tetrahedra made are exactly positive. TM_ERROR_SYSTEM where
 * memory is out: the mesh is valid, with p or without. Expected O(n) for n tetrahedra. */
tm_status tm_delaunay_insert(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                             tm_delaunay *d, tm_error *error);

#endif
