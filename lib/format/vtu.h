/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VTK's XML file of an unstructured grid (.vtu), version 1.0: arrays appended raw, little
 * endian, in blocks that zlib has compressed, with 64-bit headers. (VTK File Formats, in
 * The VTK User's Guide, 11th edition, 2010, section 19.3.)
 *
 * Cells are what tm_content_of() says: vertices for points, triangles for a surface,
 * tetrahedra, mixed elements, or polyhedra with their faces. Points keep their numbers,
 * from 0. Point data are attribute_1 … and marker, cell data region and attribute_2 … of
 * cells, marker of triangles and, for .ele, dihedral_quality: min(α_min, 180° - α_max) of
 * the dihedral angles, in degrees. */
#ifndef TM_FORMAT_VTU_H
#define TM_FORMAT_VTU_H

#include "../stream/stream.h"

/* Appends the file to *text. `threads` compress; the bytes are the same for any number.
 * Tetrahedra are written as they are, so they should be right-hand positive. Fails where
 * tm_cell_faces_find() fails for polyhedra, and where memory is out. O(n). */
tm_status tm_vtu_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error);

#endif
