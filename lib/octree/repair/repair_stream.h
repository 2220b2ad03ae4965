/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh for the repair out of the blocks of a stream, and back. */
#ifndef TM_REPAIR_REPAIR_STREAM_H
#define TM_REPAIR_REPAIR_STREAM_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../surface/surface.h"
#include "repair_state.h"

TM_EXTERN_C_BEGIN

/* What of the stream could be used, and what was left out. */
typedef struct tm_repair_notes {
    bool attributed;    /* the attribute of .node says where nodes are */
    bool regions;       /* nodes between regions have places, too: no octree is found */
    tm_error no_octree; /* why there is none; its message is empty where there is one */
    char dropped[256];  /* what was removed, with commas between */
} tm_repair_notes;

/* Takes the arrays of .node and .mix; the blocks stay. TM_ERROR_INPUT: there are no
 * elements, an element names a node twice, or coordinates are too large or too small
 * (stream/coordinates.h). *state need not be initialised; it is to be
 * freed, after an error too. */
tm_status tm_repair_from_stream(tm_repair_state *state, tm_stream *stream,
                                tm_error *error);

/* Whether there is something to do: an element is bad, or there is a surface and a node
 * is off the surface, or may be, as the attribute of .node does not say that none is. */
bool tm_repair_is_needed(const tm_repair_state *state, const tm_stream *stream,
                         double threshold);

/* Finds what nodes may do, and the octree. The place of a node is that of the only
 * attribute of .node, as tm_octree_mesh_to_stream() writes it, if the nodes of the
 * boundary, or these and those between regions of .mix, and no others, have one; else it
 * is found. With surface NULL nodes of the
 * boundary do not move, and there is no octree. *notes need not be initialised.
 * TM_ERROR_SYSTEM where memory is out. */
tm_status tm_repair_prepare(tm_repair_state *state, const tm_stream *stream,
                            const tm_surface *surface, tm_repair_notes *notes,
                            tm_error *error);

/* Gives them back. Where elements are parts of what they were, .octant, .facet and
 * attributes follow; where all is remade .octant, .root and .facet are new; blocks of the
 * mesh that refer to elements that are no more, or that nobody knows, are removed.
 * *state is to be freed still. */
tm_status tm_repair_to_stream(tm_repair_state *state, tm_stream *stream,
                              const tm_surface *surface, tm_repair_notes *notes,
                              tm_error *error);

TM_EXTERN_C_END

#endif
