/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the parts of several ranks begin in a brick: leaves of a rank are next to each
 * other in the order of all, so that whose a point is follows from where the ranks begin.
 */
#ifndef TM_FOREST_RANK_CUTS_H
#define TM_FOREST_RANK_CUTS_H

#include "leaf_list.h"

typedef struct tm_rank_cuts {
    unsigned rank, ranks;
    uint32_t (*begin)[3]; /* [ranks]: the low corner of the first leaf of each; of one
                             without leaves that of the next that has some, or what no
                             point is behind */
} tm_rank_cuts;

/* Whether a point of the grid comes before another one in Z order of the whole brick: by
 * the axis in which they differ in the highest bit, of several the last (T. M. Chan,
 * Closest-point problems simplified on the RAM, 2002). */
static inline bool tm_z_is_before(const uint32_t a[3], const uint32_t b[3])
{
    int axis = 2;
    for (int i = 1; i >= 0; i--) {
        const uint32_t most = a[axis] ^ b[axis], own = a[i] ^ b[i];
        if (most < own && most < (most ^ own))
            axis = i;
    }
    return a[axis] < b[axis];
}

/* The work that a leaf is: where surface meets it there are the layer and its queries. */
static inline size_t tm_leaf_weight(const tm_leaf *leaf)
{
    const size_t crossed = 4;
    return leaf->crossed ? crossed : 1;
}

/* The rank of a leaf that leaves of that weight are before, of a weight of all. There are
 * no more than 2^31 leaves and 2^30 ranks. */
static inline unsigned tm_rank_of_weight(size_t before, size_t all, unsigned ranks)
{
    return (unsigned)(before * ranks / all);
}

/* Makes the cuts of lists of which each rank has one, in order; all ranks call it.
 * TM_ERROR_SYSTEM where memory is out. */
tm_status tm_rank_cuts_make(tm_rank_cuts *cuts, const tm_leaf_list *own, tm_error *error);

void tm_rank_cuts_free(tm_rank_cuts *cuts);

/* The rank that has the cell of the finest grid whose low corner is that point, in the
 * brick. O(log ranks). */
unsigned tm_rank_cuts_at(const tm_rank_cuts *cuts, const uint32_t point[3]);

/* Moves leaves between ranks so that they have about the same work (rank_cuts.c); the
 * order of all stays. The lists are in the order of ranks, before and after.
 * TM_ERROR_SYSTEM where memory is out, TM_ERROR_INPUT where all together are more than
 * TM_LEAVES_MAX; all ranks call it. */
tm_status tm_leaf_list_spread(tm_leaf_list *list, tm_error *error);

#endif
