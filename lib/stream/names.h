/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The blocks of a stream by name, while there may be many of them. */
#ifndef TM_STREAM_NAMES_H
#define TM_STREAM_NAMES_H

#include "../base/hash.h"
#include "stream.h"

/* Of a stream whose blocks keep their names and their places; {0} is empty. */
typedef struct tm_block_names {
    const tm_stream *stream;
    tm_hash_table table;
    size_t room; /* for so many names */
} tm_block_names;

/* The block of that name, or NULL. Expected O(1). */
tm_block *tm_block_names_find(const tm_block_names *names, const char *name);

/* Takes in the last block of names->stream, whose name is not there yet; false where
 * memory is out. Expected O(1) on average. */
bool tm_block_names_add(tm_block_names *names);

void tm_block_names_free(tm_block_names *names);

/* references.c: what is between blocks, elements of octants, facets of cells, cells of
 * facets; and between the rows of .group. `file` is for the error. O(rows) expected. */
tm_status tm_stream_check_references(const tm_block_names *names, const char *file,
                                     tm_error *error);

#endif
