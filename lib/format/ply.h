/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PLY (G. Turk, 1994), ascii, binary_little_endian and binary_big_endian: x y z of the
 * element `vertex` and the list vertex_indices (or vertex_index) of `face`, of any types
 * and in any order; all other elements and properties are skipped. */
#ifndef TM_FORMAT_PLY_H
#define TM_FORMAT_PLY_H

#include "../surface/polygon_surface.h"

/* *surface must be empty; after an error it is again. O(size). */
tm_status tm_ply_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

#endif
