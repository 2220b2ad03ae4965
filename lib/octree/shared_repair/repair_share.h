/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of which each rank has a slice, for the repair: ranks measure what they have and
 * find what its nodes may do; the little that is bad rank 0 mends, with what is around
 * it. All functions are called by all ranks, and have the same status on all. */
#ifndef TM_REPAIR_REPAIR_SHARE_H
#define TM_REPAIR_REPAIR_SHARE_H

#include "../../base/extern_c.h"
#include "../../stream/ranks/slices.h"
#include "../repair/repair.h"

TM_EXTERN_C_BEGIN

typedef struct tm_repair_share {
    tm_slices *slices;
    tm_block *node, *mix;
    size_t nodes, elements; /* of all ranks */
    tm_mixed_mesh mesh; /* its elements, borrowed, with their nodes, whoever has these */
    uint32_t *number;   /* [mesh.nodes]: in the stream, ascending */
    tm_repair_score score; /* of the whole mesh; no average */
    bool attributed;       /* the attribute of .node says where nodes are */
    tm_node_rule *rule;    /* [rows of .node]: of the nodes that this rank has */
    uint8_t *on;           /* [rows of .node] */
} tm_repair_share;

/* Takes the blocks .node and .mix, whose elements name other nodes until it is freed, and
 * measures the elements. *can: not where tm_repair_from_stream() fails. To be freed,
 * after an error too. */
tm_status tm_repair_share_take(tm_repair_share *share, tm_slices *slices,
                               double threshold, unsigned threads, bool *can,
                               tm_error *error);
void tm_repair_share_free(tm_repair_share *share);

/* tm_repair_is_needed(). */
bool tm_repair_share_is_needed(const tm_repair_share *share);

/* tm_repair_prepare() without the octree, with a surface that all ranks have. *can: not
 * where nodes between regions may have places. */
tm_status tm_repair_share_prepare(tm_repair_share *share, const tm_surface *surface,
                                  bool *can, tm_error *error);

/* tm_repair() by TM_REPAIR_FULL, if moving nodes is enough to leave nothing bad and none
 * off the surface, and the stream has the result then. Else *can is false, and the stream
 * is as it was. Rank 0 gets what is so many elements or fewer away from bad ones, and
 * from nodes off the surface, and moves the nodes; `forced` of the elements that were bad
 * are so only because the surface is as sharp. */
tm_status tm_repair_share_mend(tm_repair_share *share, tm_surface *surface,
                               const tm_repair_options *options, size_t *forced,
                               bool *can, tm_error *error);

TM_EXTERN_C_END

#endif
