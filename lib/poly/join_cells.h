/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells of any kind joined to polyhedra by their labels; and the labels by which the
 * elements of an octree's mesh become one polyhedron for each octant. */
#ifndef TM_POLY_JOIN_CELLS_H
#define TM_POLY_JOIN_CELLS_H

#include "../base/extern_c.h"
#include "../mesh/cell_faces.h"
#include "../stream/stream.h"

TM_EXTERN_C_BEGIN

/* Labels elements: those of one row of .octant that have no node on the boundary get the
 * same label, the elements of the layer at the surface one each. Labels are 0 … *cells-1
 * in the order of their first elements. O(elements + corners). */
tm_status tm_label_octants(const tm_cell_faces *faces, const tm_block *octant,
                           size_t nodes, uint32_t *label, size_t *cells, tm_error *error);

/* Fills the empty blocks .facet, with markers if faces->marker, and .cell. Facets between
 * two cells of one label go. Those between the same two labels, or a label and the
 * boundary, with the same marker and in one plane (all nodes within `flatness` of that of
 * one of them) become one polygon, if that has one border that does not touch itself; its
 * nodes are all on that, so that hanging nodes are corners. Facets are ordered by their
 * labels, the smaller of two first. *joined is how many facets are less for that.
 * O(facets log facets) where few are between two labels. */
tm_status tm_join_cells(const tm_cell_faces *faces, const double (*xyz)[3],
                        double flatness, const uint32_t *label, size_t cells,
                        tm_block *facet, tm_block *cell, size_t *joined, tm_error *error);

TM_EXTERN_C_END

#endif
