/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The .mdl surface of the mixed-element octree mesher: sections in any order, of which
 *     [Vertices, ARRAY1<POINT3D>]   N, then N times x y z
 *     [Triangles, ARRAY1<STRING>]   M, then M times a b c x x x  (0-based; x is ignored)
 * are read, each known by its type, the other ones skipped. */
#ifndef TM_FORMAT_MDL_H
#define TM_FORMAT_MDL_H

#include "../surface/polygon_surface.h"

/* *surface must be empty; after an error it is again. O(size). */
tm_status tm_mdl_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

#endif
