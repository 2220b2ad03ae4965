/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Removal of faces: the inverse of the removal of an edge. Tetrahedra with apexes d and e
 * on two sides of a face, or of several faces side by side, become those around the edge
 * de: 2 become 3, and 2m become m + 2. J. R. Shewchuk, Two discrete optimization
 * algorithms for the topological improvement of tetrahedral meshes (2002), section 3. */
#ifndef TM_OPERATION_FACE_REMOVAL_H
#define TM_OPERATION_FACE_REMOVAL_H

#include "../../element/tet_measure.h"
#include "../mesh.h"

/* Faces beyond the first are looked for so many edges away, and are so many at most. */
enum { TM_FACE_REMOVAL_DEPTH = 4, TM_FACE_REMOVAL_MAX = 1 + 3 * 15 };

typedef struct tm_face_removal {
    uint32_t old[2 * TM_FACE_REMOVAL_MAX];
    size_t old_count;
    uint32_t node[TM_FACE_REMOVAL_MAX + 2][4];
    size_t count;
    double gain; /* what the old ones cost, less what the new ones do */
} tm_face_removal;

/* Plans to remove face i of t and what faces beside it lower the cost most: all
 * tetrahedra made are exactly positive and at least `least` good. quality[t] is that of
 * each tetrahedron by cost->measure. False where there is none. Constant time. */
bool tm_face_removal_plan(const tm_tet_mesh *mesh, const double *quality, uint32_t t,
                          uint32_t i, const tm_cost *cost, double least,
                          tm_face_removal *plan);

#endif
