/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formats of meshes that need no header of their own (see also oct.h, tetgen.h,
 * visf.h, openfoam/openfoam.h and vtk/vtk.h). A writer appends the file to *text;
 * `threads` format or compress, and the bytes are the same for any number of them. */
#ifndef TM_FORMAT_MESH_FORMAT_H
#define TM_FORMAT_MESH_FORMAT_H

#include "../base/extern_c.h"
#include "../text/text.h"
#include "../stream/stream.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

/* GetFEM --------------------------------------------------------------------------- */

/* The mesh file of the finite element library GetFEM (mesh::write_to_file() of version
 * 5.4): points and convexes from 0, each convex with the name of its geometric
 * transformation, then regions.
 *
 *     BEGIN POINTS LIST
 *       POINT  i  x  y  z
 *     END POINTS LIST
 *     BEGIN MESH STRUCTURE DESCRIPTION
 *       CONVEX i  'GT_PK(3,1)'  points
 *     END MESH STRUCTURE DESCRIPTION
 *     BEGIN REGION r
 *     i i …  i/f …
 *     END REGION r
 *
 * Nodes are in the order of the reference elements: GT_PK(3,1) and GT_PK(2,1) as in .ele
 * and .face; of GT_QK(3,1) x runs fastest, then y, then z; GT_PYRAMID(1) has the apex
 * last and its base in that order; GT_PRISM(3,1) the triangles 0 1 2 and 3 4 5, the first
 * counter-clockwise seen from the second. */

/* Regions of elements: number + this, so that they are none of the boundary's. */
enum { TM_GETFEM_ELEMENTS = 1000000 };

/* Appends the file to *text: mixed elements, tetrahedra or, where there are neither,
 * triangles in space. Faces of elements that .face, or .facet beside .mix, gives a marker
 * m > 0 are the region m,
 * elements whose first attribute is a whole number r >= 0 the region
 * TM_GETFEM_ELEMENTS + r; triangles with a marker m > 0 the region m.
 * A face between two elements is in the region as that of the first. The names of .group
 * stand in comments, "% REGION 3: inlet".
 * TM_ERROR_INPUT for other contents, where a marker or attribute is TM_GETFEM_ELEMENTS or
 * more, and where two nodes are in one place, which GetFEM refuses. `threads` format.
 * Expected O(n), but for the regions, which are sorted: O(n log n). */
tm_status tm_getfem_write(tm_text *text, const tm_stream *stream, unsigned threads,
                          tm_error *error);

/* The mixed-element octree mesher -------------------------------------------------- */

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

TM_EXTERN_C_END

#endif
