/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether two triangles meet where they should not. */
#ifndef TM_SURFACE_SURFACE_CROSSINGS_H
#define TM_SURFACE_SURFACE_CROSSINGS_H

#include "../base/extern_c.h"
#include "surface.h"

TM_EXTERN_C_BEGIN

/* Whether the closed triangles of nodes vt and vs meet elsewhere than in the nodes and
 * the edge that they have in common, by exact orientations; touching is meeting, and so
 * are the same three nodes. Constant time. */
bool tm_triangles_meet(const double (*xyz)[3], const uint32_t vt[3],
                       const uint32_t vs[3]);

/* Two triangles that do, the one with the smaller number first, and somewhere in the
 * boxes of both. */
typedef struct tm_crossing {
    uint32_t triangle[2];
    double point[3];
} tm_crossing;

/* Makes *list of all of them, in the order of their numbers; *count is how many. The list
 * is the caller's to free. TM_ERROR_SYSTEM where memory is out. O(n log n + pairs). */
tm_status tm_surface_list_crossings(const tm_surface *surface, tm_crossing **list,
                                    size_t *count, tm_error *error);

TM_EXTERN_C_END

#endif
