/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faces of a mixed mesh that belong to one element. */
#ifndef TM_MESH_MIXED_BOUNDARY_H
#define TM_MESH_MIXED_BOUNDARY_H

#include "../base/error.h"
#include "mixed_mesh.h"

enum { TM_FACE_SHIFT = 3 };

/* *face = element << TM_FACE_SHIFT | its face (shape.h), ascending; malloc'ed.
 * TM_ERROR_SYSTEM: memory, or 2^28 elements. O(elements). */
tm_status tm_mixed_boundary_faces(const tm_mixed_mesh *mesh, uint32_t **face,
                                  size_t *faces, tm_error *error);

#endif
