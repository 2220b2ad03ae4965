/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A surface as blocks of a stream. */
#ifndef TM_SURFACE_SURFACE_STREAM_H
#define TM_SURFACE_SURFACE_STREAM_H

#include "surface_file.h"

/* Adds the blocks `part`.node and `part`.face, which must not be there yet: all nodes of
 * the surface and its polygons, those with more than three corners as fans of triangles
 * from the first, those with fewer left out. Attributes and markers come with them.
 * TM_ERROR_SYSTEM where memory or 32-bit ids are out. O(n). */
tm_status tm_polygon_surface_to_stream(const tm_polygon_surface *surface,
                                       tm_stream *stream, const char *part,
                                       tm_error *error);

#endif
