/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether two triangles meet where they should not. */
#ifndef TM_SURFACE_SURFACE_CROSSINGS_H
#define TM_SURFACE_SURFACE_CROSSINGS_H

#include <stdbool.h>
#include <stdint.h>

/* Whether the closed triangles of nodes vt and vs meet elsewhere than in the nodes and
 * the edge that they have in common, by exact orientations; touching is meeting, and so
 * are the same three nodes. Constant time. */
bool tm_triangles_meet(const double (*xyz)[3], const uint32_t vt[3],
                       const uint32_t vs[3]);

#endif
