/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The writer, piece by piece, to where bytes are taken; for lib/stream/ only. */
#ifndef TM_STREAM_WRITER_H
#define TM_STREAM_WRITER_H

#include "stream.h"

/* Takes the bytes in the order in which they come. */
typedef struct tm_sink {
    tm_status (*put)(void *to, const char *bytes, size_t size, tm_error *error);
    void *to;
} tm_sink;

/* That of a file that is open: &fd. */
tm_status tm_sink_put_fd(void *to, const char *bytes, size_t size, tm_error *error);

/* The first line and the history; the name of a block; its header, with the rows that all
 * ranks have; the last line. */
tm_status tm_put_begin(const tm_stream *stream, const tm_sink *sink, tm_error *error);
tm_status tm_put_name(const tm_block *block, const tm_sink *sink, tm_error *error);
tm_status tm_put_header(const tm_block *block, size_t rows, const tm_sink *sink,
                        tm_error *error);
tm_status tm_put_end(const tm_sink *sink, tm_error *error);

/* How far writing is; at.done counts rows. */
typedef struct tm_writing {
    const tm_progress *progress;
    tm_progress_at at;
} tm_writing;

/* The rows of a block, that have so many before them on other ranks; of one of unknown
 * kind its lines. */
tm_status tm_put_rows(const tm_block *block, size_t before, unsigned base,
                      unsigned threads, const tm_sink *sink, tm_writing *writing,
                      tm_error *error);

#endif
