/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How mixed elements fit together; a part of tm_mixed_examine(). */
#ifndef TM_EXAMINE_MIXED_EXAMINE_FACES_H
#define TM_EXAMINE_MIXED_EXAMINE_FACES_H

#include "mixed_examine.h"

/* Faces that belong to one element; the fourth node of a triangle is TM_NONE. */
typedef struct tm_mixed_boundary {
    size_t count;
    size_t room;
    uint32_t (*node)[4];
} tm_mixed_boundary;

/* Finds in *found: unmatched faces of equal kind, overlapping, dangling and repeated
 * ones, dangling and repeated edges, components, unused nodes, Euler number. Appends the
 * boundary faces to *boundary, in an order that depends on the mesh only. sign[elements]:
 * see mixed_face_order.h. */
tm_status tm_mixed_examine_faces(tm_examination *found, const tm_mixed_arrays *mesh,
                                 const int8_t *sign, tm_mixed_boundary *boundary,
                                 tm_error *error);

/* Finds in *found: triangles that are half of a quadrilateral, both on the boundary.
 * Expected O(faces). */
tm_status tm_mixed_examine_nonconforming(tm_examination *found,
                                         const tm_mixed_boundary *boundary,
                                         tm_error *error);

#endif
