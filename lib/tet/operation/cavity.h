/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Insertion of a point into a cavity: some tetrahedra, all of which it sees, go, and the
 * point is joined to the faces around them. */
#ifndef TM_OPERATION_CAVITY_H
#define TM_OPERATION_CAVITY_H

#include "../../element/tet_measure.h"
#include "ball.h"
#include "cavity_boundary.h"
#include "replacement.h"

/* A face of the cavity's boundary: (face[i], point) is a positive order. beyond[i] is the
 * half face outside, or a constrained face with TM_FACE_BIT. */
typedef struct tm_cavity {
    size_t size;
    uint32_t *tet;
    size_t faces;
    uint32_t (*face)[3];
    uint32_t *beyond;
    size_t tet_room, face_room, beyond_room;
} tm_cavity;

void tm_cavity_free(tm_cavity *cavity);

/* An empty cavity; no tetrahedron is marked. False where memory is out. */
bool tm_cavity_start(tm_cavity *cavity, const tm_tet_mesh *mesh, tm_tet_marks *marks);

/* Adds tetrahedron t, which is marked then. False where memory is out. O(faces). */
bool tm_cavity_add(tm_cavity *cavity, const tm_tet_mesh *mesh, tm_tet_marks *marks,
                   uint32_t t);

/* The boundary; it holds until the cavity or the mesh is changed. */
static inline tm_cavity_boundary tm_boundary_of_cavity(const tm_cavity *cavity,
                                                       const tm_tet_mesh *mesh)
{
    return (tm_cavity_boundary){(const double(*)[3])mesh->xyz,
                                (const uint32_t(*)[3])cavity->face, cavity->faces};
}

/* Adds tetrahedra beyond faces while that makes the whole cheaper for the point p; each
 * new tetrahedron at least `least` good. quality[t] is that of each by cost->measure.
 * False where memory is out. */
bool tm_cavity_grow(tm_cavity *cavity, const tm_tet_mesh *mesh, tm_tet_marks *marks,
                    const double *quality, const tm_cost *cost, const double p[3]);

/* Joins node v, which sees all of it, to the boundary; created[0 … faces) are the
 * tetrahedra made. TM_ERROR_SYSTEM, with nothing changed, where memory is out. */
tm_status tm_cavity_fill(tm_tet_mesh *mesh, const tm_cavity *cavity, uint32_t v,
                         tm_replacement_table *table, uint32_t (*node)[4],
                         uint32_t *created, tm_error *error);

#endif
