/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The star of an edge: the tetrahedra around it. */
#ifndef TM_TET_STAR_H
#define TM_TET_STAR_H

#include "../base/extern_c.h"
#include "../element/shape.h"
#include "mesh.h"

TM_EXTERN_C_BEGIN

/* Tetrahedron i has the nodes a, b, ring[i], ring[i + 1], and (a, b, ring[i],
 * ring[i + 1]) is a positive order of them: seen from b the ring turns counter-clockwise
 * around the edge. ring[size] is ring[0] in a closed star; an open one is at the
 * boundary. */
typedef struct tm_star {
    uint32_t a, b;
    size_t size;
    bool closed;
    bool constrained_face; /* a face that has to stay is at the edge: always if not closed
                            */
    uint32_t *tet;
    uint32_t *ring;
    uint8_t *edge; /* which edge of tetrahedron i it is, 0 … 5 */
    size_t room;
} tm_star;

void tm_star_free(tm_star *star);

/* Collects the star of edge e (0 … 5) of tetrahedron t, which is its first one if the
 * star is closed. False where memory is out. O(size). */
bool tm_star_around(const tm_tet_mesh *mesh, uint32_t t, unsigned e, tm_star *star);

/* Whether the edge may go: the star is closed, no face at the edge has to stay and the
 * edge has no marker. */
bool tm_star_is_free(const tm_tet_mesh *mesh, const tm_star *star);

/* Whether the ring has no node twice, as flat tetrahedra on top of each other may make
 * it: such a star is not to be changed. */
bool tm_star_is_simple(const tm_tet_mesh *mesh, const tm_star *star);

TM_EXTERN_C_END

#endif
