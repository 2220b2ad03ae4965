/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A stream as an unstructured grid of VTK, in a legacy text file (.vtk) or an XML file
 * (.vtu). (VTK File Formats, in The VTK User's Guide, 11th edition, 2010, section 19.3;
 * polyhedra are lists of faces as in vtkUnstructuredGrid.)
 *
 * Points keep their numbers, from 0. Cells are what tm_content_of() says: vertices for
 * points, triangles for a surface, tetrahedra, mixed elements, or polyhedra with their
 * faces, in their order. After them come, as cells of their own, the rows of .face (where
 * those are not the surface itself), of .facet and of .edge that have a marker other than
 * 0: triangles, quadrilaterals, polygons and lines.
 *
 * Point data are attribute_1 … and marker. Cell data, as far as there are any:
 *
 *     region            the first attribute, attribute_2 …; of polyhedra tetrahedra,
 *                       region, attribute_3 …
 *     marker            of the rows of .face, .facet and .edge; 0 of other cells
 *     dihedral_quality  of .ele: min(α_min, 180° - α_max) of the dihedral angles
 *     jens              of .mix: J_ENS (jens.h)
 *     level             of .mix with .octant: that of the element's octant, -1 of none
 *     volume            of .cell
 *     kernel_radius     of .cell: of the largest ball in the kernel, over the diameter; 0
 *                       of those that are not star-shaped
 *
 * A marked cell has the region, the attributes and the quality of the first of the cells
 * that have all its nodes, so that it does not hide what it lies on; 0 (level -1) where
 * there is none.
 *
 * The rows of .group are the strings group_names of the field data: "2 3 inlet" says
 * dimension, value and name. */
#ifndef TM_FORMAT_VTK_VTK_H
#define TM_FORMAT_VTK_VTK_H

#include "../../base/extern_c.h"
#include "../../text/text.h"
#include "../../stream/stream.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

typedef struct tm_vtk_options {
    bool boundary; /* the marked rows of .face, .facet and .edge */
    bool quality;  /* dihedral_quality and what follows it above */
    bool names;    /* group_names */
} tm_vtk_options;

/* Appends a legacy file, version 3.0, to *text. `threads` measure and format; the bytes
 * are the same for any number. Fails where tm_cell_faces_find() fails for polyhedra,
 * TM_ERROR_INPUT without nodes, TM_ERROR_SYSTEM where memory is out. O(n); for the
 * quality of polyhedra see tm_poly_statistics_measure(). */
tm_status tm_vtk_write(tm_text *text, const tm_stream *stream,
                       const tm_vtk_options *options, unsigned threads, tm_error *error);

/* The same as an XML file, version 1.0: arrays appended raw, little endian, in blocks
 * that zlib has compressed, with 64-bit headers. Tetrahedra are written as they are, so
 * they should be right-hand positive. */
tm_status tm_vtu_write(tm_text *text, const tm_stream *stream,
                       const tm_vtk_options *options, unsigned threads, tm_error *error);

TM_EXTERN_C_END

#endif
