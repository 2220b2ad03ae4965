/* SPDX-License-Identifier: GPL-3.0-or-later */
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
#ifndef TM_FORMAT_GETFEM_H
#define TM_FORMAT_GETFEM_H

#include "../stream/stream.h"

/* Regions of elements: number + this, so that they are none of the boundary's. */
enum { TM_GETFEM_ELEMENTS = 1000000 };

/* Appends the file to *text: mixed elements, tetrahedra or, where there are neither,
 * triangles in space. Faces of elements that .face gives a marker m > 0 are the region m,
 * elements whose first attribute is a whole number r >= 0 the region
 * TM_GETFEM_ELEMENTS + r; triangles with a marker m > 0 the region m.
 * A face between two elements is in the region as that of the first.
 * TM_ERROR_INPUT for other contents, where a marker or attribute is TM_GETFEM_ELEMENTS or
 * more, and where two nodes are in one place, which GetFEM refuses. `threads` format.
 * Expected O(n), but for the regions, which are sorted: O(n log n). */
tm_status tm_getfem_write(tm_text *text, const tm_stream *stream, unsigned threads,
                          tm_error *error);

#endif
