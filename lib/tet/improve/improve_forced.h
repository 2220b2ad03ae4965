/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bad tetrahedra that the surface forces on a mesh: no other tetrahedra would do. */
#ifndef TM_IMPROVE_IMPROVE_FORCED_H
#define TM_IMPROVE_IMPROVE_FORCED_H

#include "../../base/extern_c.h"
#include "../../text/json.h"
#include "../mesh.h"

TM_EXTERN_C_BEGIN

/* A sector: what is between two faces that stay, at an edge that they have in common. All
 * tetrahedra in it have an angle there, and these are the sector's angle together. */
typedef struct tm_forced_sector {
    double midpoint[3]; /* of the edge */
    double degrees;     /* of the sector */
    size_t tets;        /* in it */
} tm_forced_sector;

typedef struct tm_forced {
    size_t bad;  /* tetrahedra */
    size_t tets; /* of these, in a sector that is below the limit */
    size_t sectors;
    tm_forced_sector *sector;
    size_t room;
} tm_forced;

void tm_forced_free(tm_forced *forced);

/* Finds the sectors, between constrained faces, that are below so many degrees: each
 * tetrahedron in them is bad for that limit. (A sector above 180 degrees less the limit
 * forces nothing: two tetrahedra share it.) TM_ERROR_SYSTEM where memory is out.
 * O(tetrahedra). */
tm_status tm_forced_find(tm_forced *forced, const tm_tet_mesh *mesh, double degrees,
                         tm_error *error);

/* The same of some tetrahedra, own[slots], and the sectors whose lowest they are. */
tm_status tm_forced_find_in(tm_forced *forced, const tm_tet_mesh *mesh, const bool *own,
                            double degrees, tm_error *error);

/* Adds the key `forced` of lepp-improve(1). */
void tm_forced_json(tm_json *json, const tm_forced *forced);

TM_EXTERN_C_END

#endif
