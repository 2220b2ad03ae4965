/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells of any kind joined to polyhedra by their labels. */
#ifndef TM_POLY_JOIN_CELLS_H
#define TM_POLY_JOIN_CELLS_H

#include "../base/extern_c.h"
#include "../mesh/cell_faces.h"
#include "../stream/stream.h"

TM_EXTERN_C_BEGIN

/* Fills the empty blocks .facet, with markers if faces->marker, and .cell. Facets between
 * two cells of one label go. Those between the same two labels, or a label and the
 * boundary, with the same marker and in one plane (all nodes within flatness[0], on the
 * boundary flatness[1], of that of one of them, and turned the same way) become one
 * polygon, if that has one border that does not touch itself; its nodes are all on that,
 * so that hanging nodes are corners. Facets are ordered by their labels, the smaller of
 * two first. *joined is how many facets are less for that.
 * O(facets log facets) where few are between two labels. */
tm_status tm_join_cells(const tm_cell_faces *faces, const double (*xyz)[3],
                        const double flatness[2], const uint32_t *label, size_t cells,
                        tm_block *facet, tm_block *cell, size_t *joined, tm_error *error);

TM_EXTERN_C_END

#endif
