/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faces of a mixed mesh that belong to one element. */
#ifndef TM_MESH_MIXED_BOUNDARY_H
#define TM_MESH_MIXED_BOUNDARY_H

#include "../base/error.h"
#include "../base/extern_c.h"
#include "../element/shape.h"
#include "mixed_mesh.h"

TM_EXTERN_C_BEGIN

enum { TM_FACE_SHIFT = 3 };

/* The nodes of such a face, seen from outside; returns how many. */
static inline size_t tm_mixed_face_of(const tm_mixed_mesh *mesh, uint32_t face,
                                      uint32_t node[4])
{
    const size_t e = face >> TM_FACE_SHIFT;
    const uint32_t *item = mesh->item + mesh->start[e];
    const uint8_t *corner = tm_element_shapes[mesh->start[e + 1] - mesh->start[e]]
                                .face[face & ((1u << TM_FACE_SHIFT) - 1)];
    const size_t k = tm_mixed_face_nodes(corner);
    for (size_t i = 0; i < k; i++)
        node[i] = item[corner[i]];
    return k;
}

/* The regions of elements: of element e, which is a part of row origin[e], it is
 * value[stride * origin[e]]. With value NULL all are in one. */
typedef struct tm_mixed_regions {
    const double *value;
    size_t stride;
    const uint32_t *origin;
} tm_mixed_regions;

/* *face = element << TM_FACE_SHIFT | its face (shape.h), ascending; malloc'ed.
 * TM_ERROR_SYSTEM: memory, or 2^28 elements. O(elements). */
tm_status tm_mixed_boundary_faces(const tm_mixed_mesh *mesh, uint32_t **face,
                                  size_t *faces, tm_error *error);

/* The same, and of the faces between elements of two regions one side. */
tm_status tm_mixed_region_faces(const tm_mixed_mesh *mesh,
                                const tm_mixed_regions *regions, uint32_t **face,
                                size_t *faces, tm_error *error);

TM_EXTERN_C_END

#endif
