/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra that are tetrahedra, pyramids, wedges and hexahedra as such. */
#ifndef TM_MESH_ELEMENTS_OF_CELLS_H
#define TM_MESH_ELEMENTS_OF_CELLS_H

#include "../base/error.h"
#include "../stream/stream.h"

/* *others becomes how many cells of .cell are none of these: have other faces, or faces
 * that do not meet as theirs do. If there are none, .cell becomes .ele, where all are
 * tetrahedra, with .face, or .mix with .facet: rows of those facets that have a marker
 * other than 0, or are on the boundary. Attributes come without the first one, which is
 * the number of tetrahedra; elements are numbered as the cells are. TM_ERROR_SYSTEM where
 * memory is out: the stream is then as it was. O(n). */
tm_status tm_elements_of_cells(tm_stream *stream, size_t *others, tm_error *error);

#endif
