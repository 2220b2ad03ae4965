/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of .facet after elements became others. */
#ifndef TM_REPAIR_REPAIR_FACETS_H
#define TM_REPAIR_REPAIR_FACETS_H

#include "../../mesh/mixed_mesh.h"
#include "../../stream/stream.h"

/* Names the elements at each facet anew, which have a face with its nodes; a
 * quadrilateral that is no more, but two triangles in its place, becomes two rows. A
 * facet that is no face at all is dropped. facet may be NULL. TM_ERROR_SYSTEM where
 * memory is out. O(elements + facets). */
tm_status tm_repair_move_facets(tm_block *facet, const tm_mixed_mesh *mesh,
                                tm_error *error);

#endif
