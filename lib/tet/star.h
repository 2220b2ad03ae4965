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

/* The same of the edge between two nodes of tetrahedron t. */
bool tm_star_between(const tm_tet_mesh *mesh, uint32_t t, uint32_t a, uint32_t b,
                     tm_star *star);

/* The constrained face at the edge that has ring node i, 0 … size - 1, and size in an
 * open star; TM_NONE where that face is none. */
static inline uint32_t tm_star_face(const tm_tet_mesh *mesh, const tm_star *star,
                                    size_t i)
{
    /* It is opposite ring[i + 1] in tetrahedron i; the last one of an open star opposite
     * ring[size - 1]. */
    bool last = i == star->size;
    uint32_t t = star->tet[last ? i - 1 : i], opposite = star->ring[last ? i - 1 : i + 1];
    uint32_t across = mesh->neighbour[t][tm_tet_corner(mesh, t, opposite)];
    return across & TM_FACE_BIT ? across & ~TM_FACE_BIT : TM_NONE;
}

/* Whether the edge may go: the star is closed, no face at the edge has to stay and the
 * edge has no marker. */
bool tm_star_is_free(const tm_tet_mesh *mesh, const tm_star *star);

/* Whether the ring has no node twice, as flat tetrahedra on top of each other may make
 * it: such a star is not to be changed. */
bool tm_star_is_simple(const tm_tet_mesh *mesh, const tm_star *star);

TM_EXTERN_C_END

#endif
