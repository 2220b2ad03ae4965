/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mixed mesh out of a stream's blocks, and back into them. */
#ifndef TM_MESH_MIXED_STREAM_H
#define TM_MESH_MIXED_STREAM_H

#include "../stream/stream.h"
#include "mixed_mesh.h"

/* Moves the arrays of .node and .mix out of the stream; the blocks stay, with their
 * attributes and markers, and are to be given their arrays back before they are written.
 * What is not there is empty. TM_ERROR_INPUT where an element names a node twice.
 * *mesh need not be initialised; tm_mixed_mesh_free() also after an error. O(n). */
tm_status tm_mixed_mesh_from_stream(tm_mixed_mesh *mesh, tm_stream *stream,
                                    tm_error *error);

/* Gives the arrays to the blocks that they were taken from; the mesh is empty then. There
 * may be more or fewer nodes, or elements, only where that block has neither attributes
 * nor markers: TM_ERROR_INTERNAL, with nothing moved, where it has. O(1). */
tm_status tm_mixed_mesh_to_stream(tm_mixed_mesh *mesh, tm_stream *stream,
                                  tm_error *error);

void tm_mixed_mesh_free(tm_mixed_mesh *mesh);

#endif
