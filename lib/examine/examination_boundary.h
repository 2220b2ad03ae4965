/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a boundary of triangles and quadrilaterals is a closed manifold surface; a part
 * of tm_element_examine(). */
#ifndef TM_EXAMINE_EXAMINATION_BOUNDARY_H
#define TM_EXAMINE_EXAMINATION_BOUNDARY_H

#include "../base/sum.h"
#include "examination.h"

/* Finds in *found: open and non-manifold edges, non-manifold vertices, those at the nodes
 * first … past-1, an edge at its smaller node. There are `nodes` of them. TM_NONE for the
 * fourth node of a face makes it a triangle. All nodes of a face differ, and no two faces
 * are the same. O(nodes + faces) where few faces meet at a node. */
tm_status tm_examine_boundary(tm_examination *found, size_t nodes, uint32_t first,
                              uint32_t past, const uint32_t (*face)[4], size_t faces,
                              tm_error *error);

/* Adds the areas of such faces to a sum: tm_triangle_area() and tm_bilinear_area(). */
void tm_add_boundary_area(tm_sum *sum, const double (*xyz)[3], const uint32_t (*face)[4],
                          size_t faces);

#endif
