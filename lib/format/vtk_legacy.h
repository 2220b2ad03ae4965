/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's legacy text file of an unstructured grid (.vtk), version 3.0. (VTK File Formats,
 * in The VTK User's Guide, 11th edition, 2010, section 19.3; polyhedra are lists of faces
 * as in vtkUnstructuredGrid.)
 *
 * Cells are what tm_content_of() says: vertices for points, triangles for a surface,
 * tetrahedra, mixed elements, or polyhedra with their faces. Points keep their numbers,
 * from 0. Point data are attribute_1 … and marker; cell data region (of polyhedra:
 * tetrahedra), attribute_2 … and, of triangles, marker. */
#ifndef TM_FORMAT_VTK_LEGACY_H
#define TM_FORMAT_VTK_LEGACY_H

#include "../stream/stream.h"

/* Appends the file to *text. `threads` format; the bytes are the same for any number.
 * Fails where tm_cell_faces_find() fails for polyhedra, and where memory is out. O(n). */
tm_status tm_vtk_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error);

#endif
