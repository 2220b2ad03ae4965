/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wavefront OBJ: `v x y z` and `f a b c …`, whose corners are v, v/vt, v//vn or v/vt/vn
 * with numbers from 1, or negative ones that count back from the last vertex so far. A
 * backslash at the end of a line goes on in the next. All other statements (normals,
 * groups, materials, lines, points) are skipped. */
#ifndef TM_FORMAT_OBJ_H
#define TM_FORMAT_OBJ_H

#include "../surface/polygon_surface.h"

/* *surface must be empty; after an error it is again. O(size). */
tm_status tm_obj_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

#endif
