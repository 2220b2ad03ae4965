/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a block in a regular file, of which each rank reads a part; for
 * lib/stream/ranks/ only. */
#ifndef TM_STREAM_RANKS_PART_H
#define TM_STREAM_RANKS_PART_H

#include "../reader.h"

/* Where lines that are names of blocks begin, ascending, and the size of the file: on
 * rank 0. */
typedef struct tm_block_places {
    size_t *place;
    size_t count;
    size_t size;
} tm_block_places;

/* All ranks look, each at its part of the file that all have open. */
tm_status tm_block_places_find(tm_block_places *places, int fd, size_t size,
                               const char *name, tm_error *error);
void tm_block_places_free(tm_block_places *places);

/* The first that is not before that byte, or the size. */
size_t tm_block_places_next(const tm_block_places *places, size_t from);

/* Reads the rows that are in bytes begin … past-1 of the file, each rank some, with as
 * many bytes. *before gets how many others have before this one's, *lines how many lines
 * all are; fewer than `rows` rows are no error here. The same status on all ranks. */
tm_status tm_part_read(tm_reader *reader, int fd, tm_block *block, size_t begin,
                       size_t past, size_t rows, size_t limit, size_t *before,
                       size_t *lines, tm_error *error);

#endif
