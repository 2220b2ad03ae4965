/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of .facet after elements became others. */
#ifndef TM_REPAIR_REPAIR_FACETS_H
#define TM_REPAIR_REPAIR_FACETS_H

#include "../../mesh/mixed_mesh.h"
#include "../../stream/stream.h"
#include "../../surface/surface.h"
#include "repair_state.h"

/* Names the elements at each facet anew, which have a face with its nodes; a
 * quadrilateral that is no more, but two triangles in its place, becomes two rows. A
 * facet that is no face at all is dropped. facet may be NULL. TM_ERROR_SYSTEM where
 * memory is out. O(elements + facets). */
tm_status tm_repair_move_facets(tm_block *facet, const tm_mixed_mesh *mesh,
                                tm_error *error);

/* Makes rows, with markers, of all faces of the boundary, and of those between elements
 * of different regions: the marker is that of the triangle that is closest to the middle.
 * TM_ERROR_SYSTEM where memory is out. O(elements + facets log n). */
tm_status tm_repair_remake_facets(tm_block *facet, const tm_repair_state *state,
                                  const tm_surface *surface, tm_error *error);

#endif
