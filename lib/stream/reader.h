/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader with what it knows on its way; for lib/stream/ only. */
#ifndef TM_STREAM_READER_H
#define TM_STREAM_READER_H

#include "lines.h"
#include "names.h"

typedef struct tm_reader {
    tm_lines lines;
    tm_stream *stream;
    tm_block_names names;
    bool base_known;
    bool one_by_one; /* rows, to the end of the window */
    unsigned threads;
    size_t step; /* bytes that all of them read at a time */
    tm_error *error;
    /* Reads what follows a block's header, or of one of unknown kind its name, which is
       in the stream already: tm_reader_read_block(), or who has that done by others. */
    tm_status (*read_block)(struct tm_reader *reader, tm_block *block, size_t rows,
                            size_t limit);
    void *with; /* what read_block() has beside */
} tm_reader;

/* Of a stream, which is empty, or one of which something is read already. Reads a file
 * that is open as reader->lines from its first line to its end. */
void tm_reader_init(tm_reader *reader, tm_stream *stream, unsigned threads,
                    tm_error *error);
tm_status tm_reader_read(tm_reader *reader);
void tm_reader_free(tm_reader *reader);

tm_status tm_reader_read_block(tm_reader *reader, tm_block *block, size_t rows,
                               size_t limit);

/* Goes to the next line that is no comment and not blank; at == end where there is none.
 */
tm_status tm_reader_next_row(tm_reader *reader);

/* Makes row `row` of `rows` begin at lines.at, and knows the stream's index base then. */
tm_status tm_reader_find_row(tm_reader *reader, const tm_block *block, size_t row,
                             size_t rows);

/* Reads the first `some` of the rows. */
tm_status tm_reader_read_some(tm_reader *reader, tm_block *block, size_t some,
                              size_t rows, size_t limit);

/* Reads rows to the end of the lines, `most` at most, behind those that the block has
 * elsewhere, `before`: their indices name nodes below limit. The base is known. What is
 * no row is an error, as it is of a whole file. */
tm_status tm_reader_read_part(tm_reader *reader, tm_block *block, size_t before,
                              size_t most, size_t limit);

#endif
