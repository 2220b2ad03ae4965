/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One row of a block from text; for lib/stream/ only. */
#ifndef TM_STREAM_ROW_H
#define TM_STREAM_ROW_H

#include "block.h"
#include "lines.h"

typedef struct tm_row_context {
    tm_block *block; /* row block->count is read; it has room for it */
    size_t before;   /* rows that the block's first one has before it elsewhere */
    const tm_block_shape *shape;
    size_t rows;      /* that may be read: mostly what the header says */
    size_t room;      /* rows that the block has room for */
    unsigned base;    /* of the stream's indices */
    size_t limit;     /* nodes that an index may name */
    size_t items;     /* of block->item: those of the rows before */
    size_t item_room; /* of block->item; grows */
    tm_error problem; /* what is wrong, without the place */
} tm_row_context;

/* Makes room for `more` rows behind those that are read, and for as many again, but for
 * no more than the header says. False where memory is out. */
bool tm_row_reserve(tm_row_context *context, size_t more);

/* Whether a line may be a row: it begins with a number. Blanks are skipped. */
bool tm_row_begins(const char *at);

/* Reads the line at `at` as row block->count; the line feed is before end, and
 * TM_LINES_SLACK bytes after end may be read. Returns the begin of the next line, or
 * NULL with the cause in context->problem. */
const char *tm_row_read(tm_row_context *context, const char *at, const char *end);

/* Reads rows of .ele, .face and .edge, up to row `most`, as long as they are in the form
 * in which the writer writes them and before end. Counts them in block->count. Returns
 * the begin of the first line that was not read, which may be `at`. */
const char *tm_row_read_plain(tm_row_context *context, const char *at, const char *end,
                              size_t most);

#endif
