/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a mesh differs from a copy of it that was made before some operations; and to
 * make one of the two the same as the other there, in time that depends on that part
 * only. */
#ifndef TM_OPERATION_MESH_PART_H
#define TM_OPERATION_MESH_PART_H

#include "ball.h"

/* {0} is an empty part. */
typedef struct tm_mesh_part {
    size_t tets;
    uint32_t *tet; /* slots; no slot twice once the part is closed */
    size_t nodes;
    uint32_t *node;
    size_t tet_room, node_room;
} tm_mesh_part;

void tm_mesh_part_free(tm_mesh_part *part);

/* A part without anything. */
void tm_mesh_part_clear(tm_mesh_part *part);

/* Adds a tetrahedron that an operation made or changed, with its nodes. False where
 * memory is out. */
bool tm_mesh_part_add(tm_mesh_part *part, const tm_tet_mesh *mesh, uint32_t t);

/* Adds what else the operations changed: what went, and neighbours. Every tetrahedron
 * that they made was added. False where memory is out. O(part). */
bool tm_mesh_part_close(tm_mesh_part *part, const tm_tet_mesh *mesh,
                        const tm_tet_mesh *old, tm_tet_marks *marks);

/* Makes *to the same as *from, which differ nowhere but in the part, which is closed.
 * TM_ERROR_SYSTEM, with *to as it was, where memory is out. O(part). */
tm_status tm_mesh_part_copy(const tm_mesh_part *part, tm_tet_mesh *to,
                            const tm_tet_mesh *from, tm_error *error);

#endif
