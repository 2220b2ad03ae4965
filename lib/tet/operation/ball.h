/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ball of a node: the tetrahedra that have it as a corner. */
#ifndef TM_OPERATION_BALL_H
#define TM_OPERATION_BALL_H

#include "cavity_boundary.h"
#include "../marks.h"
#include "../mesh.h"

/* Tetrahedron i and its face opposite the node: (face[i][0], face[i][1], face[i][2],
 * node) is a positive order. Where the mesh only touches itself in the node, the ball is
 * what can be reached from the first tetrahedron through faces. */
typedef struct tm_ball {
    uint32_t node;
    size_t size;
    uint32_t *tet;
    uint32_t (*face)[3];
    size_t room;
    /* The constrained faces at the node; those between two of the tetrahedra twice. */
    uint32_t *constrained;
    size_t constrained_count, constrained_room;
} tm_ball;

void tm_ball_free(tm_ball *ball);

/* Collects the ball of node v, which is a corner of t; marks its tetrahedra, after all
 * other marks are gone. False where memory is out. O(size). */
bool tm_ball_around(const tm_tet_mesh *mesh, uint32_t t, uint32_t v, tm_tet_marks *marks,
                    tm_ball *ball);

/* Moves the node of a ball to p; attributes stay a field. There must be room for one more
 * node, whose attributes are written over. O(size). */
void tm_ball_move_node(tm_tet_mesh *mesh, const tm_ball *ball, const double p[3]);

/* The faces around the ball; they hold until the ball or the mesh is changed. */
static inline tm_cavity_boundary tm_boundary_of_ball(const tm_ball *ball,
                                                     const tm_tet_mesh *mesh)
{
    return (tm_cavity_boundary){(const double(*)[3])mesh->xyz,
                                (const uint32_t(*)[3])ball->face, ball->size};
}

/* The face opposite corner i of t, as in a ball. */
static inline void tm_tet_face_below(const tm_tet_mesh *mesh, uint32_t t, uint32_t i,
                                     uint32_t face[3])
{
    const uint32_t *n = mesh->tet[t];
    const uint8_t *corner = tm_face_corner[i];
    face[0] = n[corner[0]];
    face[1] = n[corner[2]];
    face[2] = n[corner[1]];
}

#endif
