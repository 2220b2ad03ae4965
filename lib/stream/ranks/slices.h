/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A stream of which each rank has a slice of each block (slice.h): reading, writing, and
 * getting at rows that others have. All functions are called by all ranks. */
#ifndef TM_STREAM_RANKS_SLICES_H
#define TM_STREAM_RANKS_SLICES_H

#include "../../base/extern_c.h"
#include "../slice.h"
#include "../stream.h"

TM_EXTERN_C_BEGIN

/* The indices in rows are those of all ranks' rows. Rank 0 has all of .group and of what
 * is of unknown kind, where the others' blocks are empty, and the history. */
typedef struct tm_slices {
    tm_stream stream; /* the same blocks on all ranks, with this one's rows */
    tm_slice *slice;  /* [blocks of the stream] */
} tm_slices;

/* Reads a stream as tm_stream_read() does, with the same errors. Of a regular file each
 * rank, which has opened it as fd, reads its part, which begins at 0; of anything else
 * rank 0 reads and deals (others' fd may be anything). *slices is empty before, and after
 * an error. O(bytes / ranks), of a pipe O(bytes) on rank 0. */
tm_status tm_slices_read(tm_slices *slices, int fd, const char *name, unsigned threads,
                         tm_error *error);
void tm_slices_free(tm_slices *slices);

/* The block of that name and its slice; NULL where there is none. */
tm_block *tm_slices_find(const tm_slices *slices, const char *name, tm_slice *slice);

/* Writes the stream as tm_stream_write() does, the same bytes: rank 0 to fd, which others
 * need not have, in order. Errors are those of tm_stream_write(), on all ranks. */
tm_status tm_slices_write(const tm_slices *slices, int fd, unsigned threads,
                          tm_error *error);

/* The same to a file that is there and empty, of which each rank writes its part. */
tm_status tm_slices_write_file(const tm_slices *slices, const char *name,
                               unsigned threads, tm_error *error);

/* Rows with these ascending numbers of a flat array of which each rank has a slice: `own`
 * has this one's rows, of `size` bytes. They go to `row`. O(count + what others ask for).
 */
tm_status tm_slices_fetch(const void *own, size_t total, size_t size,
                          const uint32_t *number, size_t count, void *row,
                          tm_error *error);

/* The numbers that are in a list, ascending, none twice: *number, to be freed; the list
 * then names their places. A row of a slice with `items` such numbers becomes one of a
 * mesh of its own, whose node n has the number (*number)[n]. TM_NONE stays. On this rank
 * alone. O(items + range of the numbers / 64). */
tm_status tm_slices_localize(uint32_t *item, size_t items, uint32_t **number,
                             size_t *numbers, tm_error *error);

/* Both for what names the nodes of .node: the list then names *xyz, which are as many as
 * *number has, both to be freed. */
tm_status tm_slices_take_nodes(const tm_slices *slices, uint32_t *item, size_t items,
                               uint32_t **number, size_t *numbers, double (**xyz)[3],
                               tm_error *error);

/* As tm_stream_check_coordinates(). */
tm_status tm_slices_check_coordinates(const tm_slices *slices, tm_error *error);

/* What each rank has of blocks of arbitrary slices, as slices are: makes block b of the
 * stream, of which this rank has rows `before` on, one of slices. For who has made a
 * stream. */
tm_status tm_slices_even(tm_slices *slices, size_t b, tm_error *error);

/* Removes a block. */
void tm_slices_remove(tm_slices *slices, tm_block *block);

/* Adds to a stream, which is a rank's own, the block of that name with the rows of all
 * ranks; none where there is no such block. Not of lists. O(rows). */
tm_status tm_slices_share(const tm_slices *slices, const char *name, tm_stream *to,
                          tm_error *error);

/* Gives rank 0 all rows of all blocks, and the others none. */
tm_status tm_slices_gather(tm_slices *slices, tm_error *error);

TM_EXTERN_C_END

#endif
