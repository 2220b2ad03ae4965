/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How much a surface bends. */
#ifndef TM_SURFACE_SURFACE_CURVATURE_H
#define TM_SURFACE_SURFACE_CURVATURE_H

#include "../../base/extern_c.h"
#include "../surface.h"

TM_EXTERN_C_BEGIN

/* Fills curvature[triangles], as 1 / length: the largest of what the normal turns, in
 * radians, across an edge of the triangle that has the same patch on both sides, by the
 * distance of the middles of both triangles across the edge: a third of their heights,
 * or half where two are a flat quadrilateral.
 * Of a sphere of radius r it is about 1 / r. O(n). */
void tm_surface_find_curvature(const tm_surface *surface, double *curvature);

TM_EXTERN_C_END

#endif
