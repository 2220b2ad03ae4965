/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a mesh keeps of the surface that it fills: where nodes move nothing of it changes,
 * where octants are split all of it can. */
#ifndef TM_REPAIR_REPAIR_SHAPE_H
#define TM_REPAIR_REPAIR_SHAPE_H

#include "../../base/extern_c.h"
#include "../../mesh/mixed_boundary.h"
#include "../../surface/surface.h"
#include "../../surface/measure/surface_distance.h"
#include "repair_state.h"

TM_EXTERN_C_BEGIN

typedef struct tm_repair_shape {
    size_t corners;    /* of the surface that have a node */
    double curves;     /* length of edges of the mesh along sharp edges of the surface */
    size_t defects;    /* faces that do not match, edges and nodes where the boundary is
                          no closed manifold */
    size_t components; /* of the boundary, and its Euler characteristic */
    int64_t euler;
    double volume;
} tm_repair_shape;

/* O(elements). */
tm_status tm_repair_shape_measure(tm_repair_shape *shape, const tm_repair_state *state,
                                  const tm_surface *surface, tm_error *error);

/* Whether `a` keeps as much as `b` does: all of its corners, its sharp edges but for a
 * hundredth, no more defects, and pieces, Euler characteristic and volume no further from
 * the surface's; the volume may be off by a thousandth. */
bool tm_repair_shape_keeps(const tm_repair_shape *a, const tm_repair_shape *b,
                           const tm_surface *surface);

/* How far the boundary of the mesh, and what is between regions, in triangles, and the
 * surface are from each other, both ways, and their sharp edges and corners. O(n log n).
 */
tm_status tm_repair_shape_compare(tm_surface_comparison *comparison,
                                  const tm_repair_state *state,
                                  const tm_mixed_regions *regions,
                                  const tm_surface *surface, double feature_angle,
                                  tm_error *error);

TM_EXTERN_C_END

#endif
