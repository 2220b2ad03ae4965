/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How tetrahedra fit together; a part of tm_tet_examine(). */
#ifndef TM_EXAMINE_TET_EXAMINE_FACES_H
#define TM_EXAMINE_TET_EXAMINE_FACES_H

#include "tet_examine.h"

/* What is known of a tetrahedron: the sign of its volume (-1, 0, 1), or this. */
enum { TM_TET_NODE_TWICE = 2 };

typedef struct tm_boundary_faces {
    size_t count;
    size_t room;
    uint32_t (*node)[3];
} tm_boundary_faces;

/* Finds in *found: unmatched, overlapping, dangling and repeated faces and edges,
 * components, unused nodes, Euler number. Appends the boundary faces to *boundary, in an
 * order that depends on the mesh only. sign[tets]: see above. */
tm_status tm_tet_examine_faces(tm_examination *found, const tm_tet_arrays *mesh,
                               const int8_t *sign, tm_boundary_faces *boundary,
                               tm_error *error);

#endif
