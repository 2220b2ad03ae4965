/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A copy of a state of the repair, to be written. */
#ifndef TM_REPAIR_REPAIR_TRACE_H
#define TM_REPAIR_REPAIR_TRACE_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../surface/surface.h"
#include "repair_state.h"

TM_EXTERN_C_BEGIN

/* Fills an empty stream with .node (and the place of nodes), .mix, .root and .octant,
 * whose rows have the numbers of the state, and surface.node and surface.face; without
 * octree no octants, without surface none. O(nodes + elements). */
tm_status tm_repair_trace(const tm_repair_state *state, const tm_surface *surface,
                          tm_stream *stream, tm_error *error);

TM_EXTERN_C_END

#endif
