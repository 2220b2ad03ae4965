/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Delaunay property of a mesh.
 *
 * A face inside a mesh is *locally Delaunay* if neither of its two tetrahedra has the far
 * node of the other strictly inside its circumscribed sphere. A mesh counts as Delaunay
 * here if all its faces are but those that have to stay (tm_constrained_face). What that
 * is worth:
 *
 *   - In a convex mesh without faces that have to stay inside, every sphere is empty: B.
 *     Delaunay, Sur la sphère vide, Bulletin de l'Académie des Sciences de l'URSS (1934).
 *   - Otherwise the mesh is constrained Delaunay: a sphere holds only nodes that cannot
 * be seen from inside its tetrahedron, because a face that stays is in between. J. R.
 *     Shewchuk, General-dimensional constrained Delaunay and constrained regular
 *     triangulations I, Discrete & Computational Geometry 39 (2008).
 *
 * Nodes on a common sphere are not inside it: any way to fill a cube is Delaunay. */
#ifndef TM_DELAUNAY_DELAUNAY_H
#define TM_DELAUNAY_DELAUNAY_H

#include "../../base/extern_c.h"
#include "../mesh.h"

TM_EXTERN_C_BEGIN

/* How many faces are not locally Delaunay, exactly. A flat tetrahedron has no sphere; its
 * faces are judged by the sphere on their other side. O(tetrahedra). */
size_t tm_tet_mesh_not_delaunay(const tm_tet_mesh *mesh);

/* What insertions (delaunay_insertion.h) have come to, in sum. */
typedef struct tm_delaunay_report {
    size_t insertions;
    size_t removed;  /* tetrahedra in their cavities */
    size_t flipped;  /* faces that continued a facet */
    size_t stopped;  /* constrained faces with a sphere beyond that held the node */
    size_t refused;  /* points that would have been cut back, and were not inserted */
    size_t cut_back; /* cavities that left a tetrahedron out whose sphere held the node,
                        because that did not see all of it, or it held what has to stay */
} tm_delaunay_report;

TM_EXTERN_C_END

#endif
