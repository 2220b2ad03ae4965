/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which rank gets a leaf: all get about the same work. */
#ifndef TM_SHARE_SHARE_WEIGHT_H
#define TM_SHARE_SHARE_WEIGHT_H

#include "../forest/octree.h"

/* The work that a leaf is: where surface meets it there are the layer and its queries. */
static inline size_t tm_share_weight(const tm_leaf *leaf)
{
    const size_t crossed = 4;
    return leaf->crossed ? crossed : 1;
}

/* The rank of a leaf that leaves of that weight are before, of a weight of all. There are
 * no more than 2^31 leaves and 2^30 ranks. */
static inline unsigned tm_share_rank_at(size_t before, size_t all, unsigned ranks)
{
    return (unsigned)(before * ranks / all);
}

#endif
