/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's two formats of unstructured grids as streams; see also vtk.h, which writes them.
 *
 * A stream gets the nodes, numbered from 0, and
 *
 *     .cell .facet   where there is a polyhedron or a prism: of all cells with a volume
 *     .mix           else, where they are not all tetrahedra
 *     .ele           where they are
 *     .face          without any, triangles; larger polygons are cut into such
 *
 * Polygons beside cells with a volume are rows of .face beside .ele, of .facet beside
 * .mix, and beside .cell they mark facets. Lines are rows of .edge. A cell of second or
 * higher order is its corners, and nodes that are nothing but its others are left out.
 * Pixels and voxels are quadrilaterals and hexahedra. Elements that are left-handed are
 * turned. Points of several pieces that are in one place are one node; cells that are
 * marked as ghosts of another piece are left out.
 *
 * Data of points and cells are attributes, one for each component. What cells with a
 * volume have is after the region, which is 0 where there is none; of polyhedra the
 * number of tetrahedra is before that, as .cell has it. Regions and markers are arrays of
 * certain names, see vtk_names.c, or those that are named; what vtu-export measures is
 * left out. */
#ifndef TM_FORMAT_VTK_VTK_READ_H
#define TM_FORMAT_VTK_VTK_READ_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../text/text.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* For a list of pieces (.pvtu): appends the bytes of the file that `source`, which stands
 * in it, is to *bytes, and what messages are to call it to *name. */
typedef tm_status tm_vtu_load(void *context, const char *source, tm_text *name,
                              tm_text *bytes, tm_error *error);

typedef struct tm_vtk_read_options {
    const char *region; /* the name of the cell data that are regions; NULL: see above */
    const char *marker; /* the same of markers, of points, too */
    unsigned threads;   /* unpack */
    tm_vtu_load *load;  /* NULL: lists of pieces are refused */
    void *context;      /* for it */
} tm_vtk_read_options;

/* What was done to be a stream, and what is not in it. Texts are to be freed with
 * tm_vtk_read_report_free(), and may be empty. */
typedef struct tm_vtk_read_report {
    size_t turned;               /* left-handed elements */
    size_t higher_order;         /* elements that are their corners now, */
    size_t middle_nodes;         /* and nodes that are left out */
    size_t joined;               /* points of several pieces that became others */
    size_t ghosts;               /* cells of other pieces, left out */
    size_t empty;                /* cells without points, left out */
    size_t loose;                /* polygons that no cell with a volume has, left out */
    size_t vertices;             /* cells of one point that mark no node, left out */
    size_t cut;                  /* polygons of a surface, cut into triangles */
    size_t polygons_joined;      /* those of polyhedra that became one with another */
    const char *region, *marker; /* names of the arrays that were taken; or NULL */
    tm_text node_attributes;     /* "temperature, velocity (3)" */
    tm_text cell_attributes;
    tm_text left_out; /* arrays that a stream has no place for, with why */
    tm_text measures; /* arrays that vtu-export had measured */
    tm_text names;    /* what region and marker point to */
} tm_vtk_read_report;

void tm_vtk_read_report_free(tm_vtk_read_report *report);

/* Reads a .vtu file: text, base64 or raw, appended or not, compressed by zlib or not, of
 * either byte order; or a list of such, .pvtu, one after the other. *stream must be
 * empty; after an error it is again: TM_ERROR_INPUT, with the line of the element, where
 * the file is damaged or has what a stream cannot hold. Memory grows with what is there,
 * not with what counts claim. Expected O(size). */
tm_status tm_vtu_read(tm_stream *stream, const char *bytes, size_t size, const char *name,
                      const tm_vtk_read_options *options, tm_vtk_read_report *report,
                      tm_error *error);

/* The same of a legacy file of version 1 to 5.1, text or binary: an unstructured grid, or
 * polygons. */
tm_status tm_vtk_read(tm_stream *stream, const char *bytes, size_t size, const char *name,
                      const tm_vtk_read_options *options, tm_vtk_read_report *report,
                      tm_error *error);

TM_EXTERN_C_END

#endif
