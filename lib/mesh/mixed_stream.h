/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mixed mesh out of a stream's blocks. */
#ifndef TM_MESH_MIXED_STREAM_H
#define TM_MESH_MIXED_STREAM_H

#include "../stream/stream.h"
#include "mixed_mesh.h"

/* Moves the arrays of .node and .mix out of the stream; the blocks stay, with their
 * attributes and markers, but cannot be written. What is not there is empty.
 * TM_ERROR_INPUT where an element names a node twice. *mesh need not be initialised; its
 * arrays are to be freed, also after an error. O(n). */
tm_status tm_mixed_mesh_from_stream(tm_mixed_mesh *mesh, tm_stream *stream,
                                    tm_error *error);

#endif
