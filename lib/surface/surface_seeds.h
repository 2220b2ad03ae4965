/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A point in each part of space that a surface closes in, for what fills it from there.
 */
#ifndef TM_SURFACE_SURFACE_SEEDS_H
#define TM_SURFACE_SURFACE_SEEDS_H

#include "../base/extern_c.h"
#include "surface.h"

TM_EXTERN_C_BEGIN

typedef struct tm_surface_seed {
    double point[3];
    double clearance; /* from the point to the surface; 0: no point was found */
    bool nested;      /* the shell around it is within another one, */
    bool inward;      /* and its faces look inward in the file, as those of a hole do */
} tm_surface_seed;

/* How many parts there are: of a surface with walls its cells, else its shells, of which
 * each has the part right behind it. */
static inline size_t tm_surface_seeds(const tm_surface *surface)
{
    return surface->walls ? surface->cells : surface->components;
}

/* Fills seed[tm_surface_seeds()] of a surface that was built of these polygons, without
 * `lenient`. Below and above the middles of the largest triangles of a part points are
 * tried, and that which is the farthest from the surface is taken; that each is in its
 * part is exact. TM_ERROR_SYSTEM where memory is out. O(n) and some hundred queries for
 * each part. */
tm_status tm_surface_find_seeds(const tm_surface *surface,
                                const tm_polygon_surface *polygons, tm_surface_seed *seed,
                                tm_error *error);

TM_EXTERN_C_END

#endif
