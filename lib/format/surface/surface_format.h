/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formats of surface files: which one a file is in, and their readers. A new format
 * is a reader, here, and a row of the table in surface_format.c. */
#ifndef TM_FORMAT_SURFACE_FORMAT_H
#define TM_FORMAT_SURFACE_FORMAT_H

#include "../../base/extern_c.h"
#include "../../surface/polygon_surface.h"

TM_EXTERN_C_BEGIN

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

/* The readers. *surface must be empty; after an error it is again. TM_ERROR_INPUT, with
 * `name` and where there are lines the line, for what is wrong in the file. O(size). */

/* OFF of Geomview, text: OFF, and with colours, normals or texture coordinates per
 * vertex COFF, NOFF, STOFF and their combinations. One vertex and one face a line;
 * colours and all else behind them are skipped, `#` begins a comment, the three counts
 * stand behind the keyword or on the next line (the number of edges may lack).
 * 4OFF, nOFF and OFF BINARY are refused. */
tm_status tm_off_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

/* Wavefront OBJ: `v x y z` and `f a b c …`, whose corners are v, v/vt, v//vn or v/vt/vn
 * with numbers from 1, or negative ones that count back from the last vertex so far. A
 * backslash at the end of a line goes on in the next. The names of `o`, `g` and `usemtl`
 * make the groups of the faces: those of these three that are not the same for all faces,
 * joined by '/'. All other statements (normals, lines, points) are skipped. */
tm_status tm_obj_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

/* PLY (G. Turk, 1994), ascii, binary_little_endian and binary_big_endian: x y z of the
 * element `vertex` and the list vertex_indices (or vertex_index) of `face`, of any types
 * and in any order. An integer property `marker` of faces is their marker, and comments
 * "marker N NAME" are its names, as tm_ply_write() puts them. All other elements and
 * properties are skipped. */
tm_status tm_ply_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

/* STL, text and binary. Triangles come with coordinates; points with equal ones become
 * one node, in the order in which they come first. The solids of a text file are its
 * groups, but for a single one without a name. Normals, attribute bytes and colours are
 * skipped, and bytes behind the last triangle of a binary file: left_bytes. */
tm_status tm_stl_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

/* True for a binary file that is as long as its count says, whatever its first word; and
 * for one that goes on behind that, where it looks like triangles. */
bool tm_stl_is_binary(const char *bytes, size_t size);

/* The .mdl surface of the mixed-element octree mesher: sections in any order, of which
 *     [Vertices, ARRAY1<POINT3D>]   N, then N times x y z
 *     [Triangles, ARRAY1<STRING>]   M, then M times a b c x x x  (0-based; x is ignored)
 * are read, each known by its type, the other ones skipped. */
tm_status tm_mdl_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);

TM_EXTERN_C_END

#endif
