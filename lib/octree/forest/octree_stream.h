/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An octree in a stream: the blocks .root and .octant of termesh-stream(5). */
#ifndef TM_FOREST_OCTREE_STREAM_H
#define TM_FOREST_OCTREE_STREAM_H

#include "../../stream/stream.h"
#include "octree.h"

/* Adds .root and .octant, which must not be there yet. Leaf i, which is row i, has the
 * elements element[i] up to, but not including, element[i + 1] of .mix; [leaves + 1].
 * Anchors are in units of the level `finest`, the deepest that a leaf has
 * (tm_octree_deepest()), which is that of .root. O(leaves). */
tm_status tm_octree_to_stream(const tm_octree *octree, unsigned finest,
                              const uint32_t *element, tm_stream *stream,
                              tm_error *error);

/* The octree of the blocks .root and .octant; *octree is overwritten. Leaf i is row
 * order[i], TM_NONE where no octant is there (tm_octree_from_leaves); order is malloc'ed,
 * NULL after an error. TM_ERROR_INPUT: a block is missing, the roots are no brick of
 * equal cubes, octants overlap or are not balanced. */
tm_status tm_octree_read_blocks(tm_octree *octree, const tm_stream *stream,
                                const tm_surface *surface, uint32_t **order,
                                tm_error *error);

#endif
