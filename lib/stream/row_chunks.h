/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of a block from text, by several threads; for lib/stream/ only. */
#ifndef TM_STREAM_ROW_CHUNKS_H
#define TM_STREAM_ROW_CHUNKS_H

#include "row.h"

/* Of one chunk: many, as starting a thread takes as long as reading some 50 kB. */
enum { TM_CHUNK_BYTES = 1 << 19 };

/* Something else to do in the meantime, on one of the threads. */
typedef void tm_meanwhile(void *context);

/* Reads the lines from `at` to `end`, whole ones, as rows of context->block, chunks of
 * them at a time, each where the number of its first row says, so that no row waits for
 * another. Stops behind the last line that, with all before it, is a row: one
 * that is none is for tm_row_read() to say. With TM_LINES_SLACK bytes after end. *next is
 * where it stopped; block->count and context->items say what was read, which does not
 * depend on `threads`. False where memory is out. O(bytes / threads). */
bool tm_row_chunks_read(tm_row_context *context, const char *at, const char *end,
                        unsigned threads, tm_meanwhile *meanwhile, void *with,
                        const char **next);

#endif
