/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows that this rank has of all ranks' ones: its slice (slice.h). */
#ifndef TM_MESH_RANKS_ROWS_H
#define TM_MESH_RANKS_ROWS_H

#include "../../ranks/ranks.h"
#include "../../stream/slice.h"

typedef struct tm_rows {
    size_t total, first, count;
} tm_rows;

static inline tm_rows tm_rows_of(size_t total)
{
    const unsigned ranks = tm_ranks_count(), rank = tm_rank();
    const size_t first = tm_slice_first(total, ranks, rank);
    return (tm_rows){total, first, tm_slice_first(total, ranks, rank + 1) - first};
}

/* Whether a row is one of them. */
static inline bool tm_rows_have(const tm_rows *rows, size_t row)
{
    return row - rows->first < rows->count;
}

/* The rank that has a row. */
static inline unsigned tm_rows_owner(const tm_rows *rows, size_t row)
{
    return tm_slice_owner(rows->total, tm_ranks_count(), row);
}

#endif
