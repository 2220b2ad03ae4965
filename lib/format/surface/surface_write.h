/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writers of surface formats: faces of a stream's main mesh as polygons, turned outward,
 * with what users call their markers. Only the nodes that these polygons have are
 * written, in their order. */
#ifndef TM_FORMAT_SURFACE_WRITE_H
#define TM_FORMAT_SURFACE_WRITE_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../text/text.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

typedef enum tm_polygons_of {
    TM_POLYGONS_BOUNDARY, /* the faces that one cell has; of a surface all */
    TM_POLYGONS_ALL,      /* all faces once, outward for the first of their cells */
    TM_POLYGONS_REGIONS   /* the closed boundary of each region: faces between two
                             regions twice, outward for each */
} tm_polygons_of;

typedef struct tm_surface_file {
    tm_polygons_of of;
    bool binary; /* STL and PLY: little endian */
} tm_surface_file;

/* What was written. */
typedef struct tm_surface_written {
    size_t polygons; /* STL: triangles */
    size_t flat;     /* triangles of binary STL two of whose corners are one as floats */
} tm_surface_written;

/* Append the file to *text. Polygons are grouped by their marker, of TM_POLYGONS_REGIONS
 * by the region (tm_group_region()); the name is what .group has, else marker_N or
 * region_N; groups come in the order of these numbers, but 0, which has no name, first.
 * Where all are of one group that has no name there are none. TM_ERROR_INPUT as
 * tm_cell_faces_find(), and where there are no faces, or for TM_POLYGONS_REGIONS no
 * cells. Expected O(n), and O(p log p) for p polygons in groups. */
typedef tm_status tm_surface_writer(tm_text *text, const tm_stream *stream,
                                    const tm_surface_file *file,
                                    tm_surface_written *written, tm_error *error);

/* OFF of Geomview, text; it has no groups, and polygons are in the order of their faces.
 */
tm_surface_writer tm_off_write;

/* STL: a solid for each group. Polygons become triangles (tm_cut_ears()). Text has all
 * digits of the coordinates; binary files have 32-bit floats, and no groups:
 * TM_ERROR_INPUT where a coordinate is too large for them. */
tm_surface_writer tm_stl_write;

/* PLY, with 64-bit coordinates. Markers or regions are a property of each face, `marker`
 * or `region`, their names comments: "comment marker 3 inlet". */
tm_surface_writer tm_ply_write;

/* Wavefront OBJ: a group (g) for each group. */
tm_surface_writer tm_obj_write;

TM_EXTERN_C_END

#endif
