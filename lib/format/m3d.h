/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The meshes of the mixed-element octree mesher (C. Lobos and others, 2013-2021), .m3d
 * and .mvm, both of text with ids from 0:
 *
 *     [Nodes, ARRAY1<STRING>]                   MIXED
 *     n, then n times 1 x y z                   n m, then n times x y z,
 *     [Elements, ARRAY1<STRING>]                then m times an element
 *     m, then m times an element, 1000.0 0.45 1.0
 *
 * An element is a letter and its nodes: T a tetrahedron, P a pyramid, R a wedge, H a
 * hexahedron. They are ordered as in .mix, but the wedge's triangle 0 1 2 turns the other
 * way: nodes 1 and 2 are swapped, and 4 and 5. The three numbers are constants of the
 * material. */
#ifndef TM_FORMAT_M3D_H
#define TM_FORMAT_M3D_H

#include "../stream/stream.h"

/* Reads a file of either form, which its first word tells, as the blocks .node and .mix,
 * base 0. Sections come in any order, those of other names are skipped. The numbers
 * before the coordinates are not looked at; *materials is how many elements have other
 * constants than those above, which .mix does not keep. *stream must be empty; after an
 * error it is again: TM_ERROR_INPUT with the line. O(size). */
tm_status tm_m3d_read(tm_stream *stream, const char *bytes, size_t size, const char *name,
                      size_t *materials, tm_error *error);

/* Appends a file of that form to *text: the elements of .mix, or of .ele where that has
 * none. TM_ERROR_INPUT where the stream has neither. `threads` format. O(n). */
tm_status tm_m3d_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error);
tm_status tm_mvm_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error);

#endif
