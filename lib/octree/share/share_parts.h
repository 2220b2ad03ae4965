/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of making a share of an octree, a file each. All ranks call them together. */
#ifndef TM_SHARE_SHARE_PARTS_H
#define TM_SHARE_SHARE_PARTS_H

#include "../forest/rank_cuts.h"
#include "octree_share.h"

/* A leaf of another rank, and its number in the whole octree. */
typedef struct tm_ghost {
    tm_leaf leaf;
    uint32_t number;
} tm_ghost;

typedef struct tm_ghost_list {
    size_t count, room;
    tm_ghost *ghost;
} tm_ghost_list;

bool tm_ghost_list_add(tm_ghost_list *list, const tm_leaf *leaf, uint32_t number);

/* share_ghosts.c: the leaves of other ranks that touch those of this one, ascending.
 * first[ranks + 1]: the number of each rank's first leaf. */
tm_status tm_share_find_ghosts(tm_ghost_list *ghosts, const tm_octree *brick,
                               const tm_leaf_list *own, const size_t *first,
                               const tm_rank_cuts *cuts, tm_error *error);

/* Adds to these, of which the share has its leaves and numbers, what touches them, with
 * so many rings more. */
tm_status tm_share_add_rings(tm_ghost_list *ghosts, const tm_octree_share *share,
                             unsigned more, tm_error *error);

/* share_nodes.c: of a share whose octree has nodes by the leaves that it has, the first
 * ring of ghosts only, these of all, with these ghosts in place of its own. */
tm_status tm_share_number_nodes(tm_octree_share *share, const tm_ghost_list *ghosts,
                                tm_error *error);

/* Exchanges items as tm_ranks_exchange() does if all ranks are done; else memory is out
 * on one. */
tm_status tm_share_exchange(bool done, const void *send, size_t *count, size_t size,
                            void **got, tm_error *error);

/* The sum of counts[ranks]. */
size_t tm_share_total(const tm_octree_share *share, const size_t *count);

#endif
