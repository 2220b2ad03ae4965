/* SPDX-License-Identifier: GPL-3.0-or-later */
/* STL, text and binary. Triangles come with coordinates; points with equal ones become
 * one node, in the order in which they come first. Normals, names, attribute bytes and
 * colours are skipped. */
#ifndef TM_FORMAT_STL_H
#define TM_FORMAT_STL_H

#include "../surface/polygon_surface.h"

/* True for a binary file that is as long as its count says, whatever its first word. */
bool tm_stl_is_binary(const char *bytes, size_t size);

/* *surface must be empty; after an error it is again. O(size). */
tm_status tm_stl_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

#endif
