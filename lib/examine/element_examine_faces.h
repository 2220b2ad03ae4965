/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How elements fit together; a part of tm_element_examine(). */
#ifndef TM_EXAMINE_ELEMENT_EXAMINE_FACES_H
#define TM_EXAMINE_ELEMENT_EXAMINE_FACES_H

#include "element_examine.h"

/* What is known of an element: 1 upright, -1 turned, 0 without a side, or this. */
enum { TM_NODE_TWICE = 2 };

/* Faces that belong to one element; the fourth node of a triangle is TM_NONE. */
typedef struct tm_boundary_faces {
    size_t count;
    size_t room;
    uint32_t (*node)[4];
} tm_boundary_faces;

/* Finds in *found: unmatched faces of equal kind, overlapping, dangling and repeated
 * ones, dangling and repeated edges, components, unused nodes, Euler number. Appends the
 * boundary faces to *boundary, in an order that depends on the mesh only. sign[elements]:
 * see above. Each of threads >= 1 walks over a part of the nodes. */
tm_status tm_element_examine_faces(tm_examination *found, const tm_mesh_view *mesh,
                                   const int8_t *sign, tm_boundary_faces *boundary,
                                   unsigned threads, tm_error *error);

/* Finds in *found: triangles that are half of a quadrilateral, both on the boundary.
 * Expected O(faces). */
tm_status tm_element_examine_nonconforming(tm_examination *found,
                                           const tm_boundary_faces *boundary,
                                           tm_error *error);

#endif
