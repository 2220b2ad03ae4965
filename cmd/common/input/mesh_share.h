/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rank's share of a mesh: its slice of the elements, with the nodes that they have. All
 * functions are called by all ranks and exit on failure. */
#ifndef CMD_COMMON_MESH_SHARE_H
#define CMD_COMMON_MESH_SHARE_H

#include "../../../lib/examine/ranks/examine_ranks.h"
#include "../app/filter.h"

typedef struct mesh_share {
    tm_block *block; /* of the slices, whose rows name xyz */
    tm_slice slice;  /* of the block */
    size_t nodes;
    uint32_t *number; /* [nodes]: in the stream, from 0, ascending */
    double (*xyz)[3]; /* [nodes] */
} mesh_share;

/* mesh_input_read_to_compute() of slices. */
void mesh_share_read(const filter *f, tm_slices *slices);

/* How many rows all ranks have of a block; 0 where there is none. */
size_t mesh_share_rows(const tm_slices *slices, const char *name);

/* The tetrahedra of a stream. */
tm_element_slices mesh_share_tets(const tm_slices *slices);

/* Takes the nodes of a block's rows, .ele or .mix. */
void mesh_share_take(const filter *f, mesh_share *share, const tm_slices *slices,
                     const char *name);
void mesh_share_free(mesh_share *share);

/* mesh_input_turn() of .ele. */
void mesh_share_turn(const filter *f, mesh_share *share, const char *what);

/* All ranks' items, `size` bytes each, on rank 0, in the place of this one's; on the
 * others none is left. */
void mesh_share_gather(const filter *f, void **items, size_t *count, size_t size);

/* The slices become a stream of rank 0, which goes on alone; the others end. */
void mesh_share_leave(const filter *f, tm_slices *slices, tm_stream *stream);

#endif
