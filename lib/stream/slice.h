/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which rows a rank has of a block of which each rank has a slice. The slices are as even
 * as multiples of TM_SLICE_ROWS rows can be: what is rounded chunk by chunk is rounded
 * alike for every number of ranks, where its chunks divide these. Rank 0 has all of few.
 */
#ifndef TM_STREAM_SLICE_H
#define TM_STREAM_SLICE_H

#include "../base/extern_c.h"
#include "../base/parallel.h"

TM_EXTERN_C_BEGIN

enum { TM_SLICE_ROWS = 8192 };

/* This rank's rows of a block have so many before them on other ranks; all ranks have
 * `total`. */
typedef struct tm_slice {
    size_t before, total;
} tm_slice;

/* The first row of a rank, which for rank `ranks` is `total`. total * ranks is below
 * 2^64. */
static inline size_t tm_slice_first(size_t total, unsigned ranks, unsigned rank)
{
    const size_t chunks = tm_parallel_chunks(total, TM_SLICE_ROWS);
    const size_t first = (size_t)TM_SLICE_ROWS * ((chunks * rank + ranks - 1) / ranks);
    return first < total ? first : total;
}

/* The rank that has a row, which is below total. */
static inline unsigned tm_slice_owner(size_t total, unsigned ranks, size_t row)
{
    return (unsigned)(row / TM_SLICE_ROWS * ranks /
                      tm_parallel_chunks(total, TM_SLICE_ROWS));
}

/* How many of the rows before … before + count - 1 are in a rank's slice; in each one's:
 * of[ranks]. */
static inline size_t tm_slice_share(size_t total, unsigned ranks, unsigned rank,
                                    size_t before, size_t count)
{
    size_t first = tm_slice_first(total, ranks, rank);
    size_t past = tm_slice_first(total, ranks, rank + 1);
    first = first > before ? first : before;
    past = past < before + count ? past : before + count;
    return past > first ? past - first : 0;
}

static inline void tm_slice_shares(size_t total, unsigned ranks, size_t before,
                                   size_t count, size_t *of)
{
    for (unsigned r = 0; r < ranks; r++)
        of[r] = tm_slice_share(total, ranks, r, before, count);
}

TM_EXTERN_C_END

#endif
