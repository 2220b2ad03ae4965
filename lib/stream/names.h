/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of a stream by name, while there may be many of them. */
#ifndef TM_STREAM_NAMES_H
#define TM_STREAM_NAMES_H

#include "../base/hash.h"
#include "slice.h"
#include "stream.h"

/* Of a stream whose blocks keep their names and their places; {0} is empty. */
typedef struct tm_block_names {
    const tm_stream *stream;
    tm_hash_table table;
    size_t room;           /* for so many names */
    const tm_slice *slice; /* [blocks]; NULL: each has all of its rows */
} tm_block_names;

/* The block of that name, or NULL. Expected O(1). */
tm_block *tm_block_names_find(const tm_block_names *names, const char *name);

/* All rows of a block of the stream. */
static inline size_t tm_block_names_rows(const tm_block_names *names,
                                         const tm_block *block)
{
    return names->slice ? names->slice[block - names->stream->block].total : block->count;
}

/* The number of its row r, in the text. */
static inline size_t tm_block_names_number(const tm_block_names *names,
                                           const tm_block *block, size_t r)
{
    const size_t before =
        names->slice ? names->slice[block - names->stream->block].before : 0;
    return r + before + names->stream->base;
}

/* Takes in the last block of names->stream, whose name is not there yet; false where
 * memory is out. Expected O(1) on average. */
bool tm_block_names_add(tm_block_names *names);

void tm_block_names_free(tm_block_names *names);

/* references.c: what is between blocks, elements of octants, facets of cells, cells of
 * facets; and between the rows of .group. `file` is for the error. O(rows) expected. Of a
 * stream of which a rank has a slice, those of its own rows (stream/ranks). */
tm_status tm_stream_check_references(const tm_block_names *names, const char *file,
                                     tm_error *error);

#endif
