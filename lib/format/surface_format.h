/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which foreign format a surface file is in, and the reader for it. */
#ifndef TM_FORMAT_SURFACE_FORMAT_H
#define TM_FORMAT_SURFACE_FORMAT_H

#include "../surface/polygon_surface.h"

typedef enum tm_format {
    TM_FORMAT_UNKNOWN,
    TM_FORMAT_STREAM, /* a termesh stream: read by tm_stream_read() */
    TM_FORMAT_OFF,
    TM_FORMAT_STL,
    TM_FORMAT_PLY,
    TM_FORMAT_OBJ,
    TM_FORMAT_MDL,
    TM_FORMAT_NODE,
    TM_FORMAT_POLY,
    TM_FORMAT_SMESH
} tm_format;

/* Told by the content. The suffix of `name` decides only where the content does not:
 * between .node, .poly and .smesh, and for a binary STL file that is cut short. */
tm_format tm_format_of(const char *bytes, size_t size, const char *name);

/* "OFF", …; "" for the unknown one. */
const char *tm_format_name(tm_format format);

/* Calls the reader of the format. *surface must be empty (but see tm_plc_read() for
 * .poly and .smesh files whose nodes are in a .node file); after an error it is. For
 * TM_FORMAT_UNKNOWN and TM_FORMAT_STREAM it fails with a list of what is read. */
tm_status tm_format_read(tm_polygon_surface *surface, tm_format format, const char *bytes,
                         size_t size, const char *name, tm_error *error);

#endif
