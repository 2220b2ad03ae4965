/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stream's writer. Rows are formatted by the chunk, by as many threads as there may
 * be, and written in order. */
#include "writer.h"

#include "../number/digits.h"
#include "../text/file.h"
#include "../number/number.h"
#include "../base/ids.h"
#include "../base/parallel.h"
#include "block.h"
#include "group_names.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK_ROWS = 4096 };

/* One batch of chunks of a block: chunk c of it goes to text[c]. */
typedef struct {
    const tm_block *block;
    uint32_t base;
    size_t before; /* rows that others have before the block's first */
    size_t first;  /* row with which the batch begins */
    tm_text *text;
} batch;

/* Those of a row; the array may be NULL where rows have none. */
static char *put_reals(char *to, const double *real, size_t row, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        *to++ = ' ';
        to = tm_write_double(to, real[row * count + i]);
    }
    return to;
}

/* The number of a row as text. Counting on is cheaper than converting each. */
typedef struct {
    char text[TM_INTEGER_CHARS];
    size_t size;
} row_number;

static row_number row_number_from(size_t number)
{
    row_number n;
    n.size = (size_t)(tm_write_int64(n.text, (int64_t)number) - n.text);
    return n;
}

static inline void count_on(row_number *n)
{
    size_t i = n->size;
    while (i > 0 && n->text[i - 1] == '9')
        n->text[--i] = '0';
    if (i > 0) {
        n->text[i - 1]++;
        return;
    }
    n->text[n->size++] = '0'; /* 99 becomes 100 */
    n->text[0] = '1';
}

static inline char *put_row_number(char *to, const row_number *n)
{
    memcpy(to, n->text, sizeof n->text);
    return to + n->size;
}

/* Nearly all indices are below TM_WORD_NUMBERS. */
static inline char *put_index(char *to, uint32_t index, uint32_t base)
{
    if (index < TM_WORD_NUMBERS - 1)
        return tm_write_short(to, index + base);
    if (index != TM_NONE)
        return tm_write_int64(to, (int64_t)index + base);
    memcpy(to, "-1", 2);
    return to + 2;
}

/* index[from…past - 1]; the array may be NULL where there are none. */
static inline char *put_indices(char *to, const uint32_t *index, size_t from, size_t past,
                                uint32_t base)
{
    for (size_t i = from; i < past; i++) {
        *to++ = ' ';
        to = put_index(to, index[i], base);
    }
    return to;
}

/* The fixed integers of a row: level x y z of an octant and the level of a root are
 * counts, all others are indices. */
static char *put_integers(char *to, const tm_block *block, size_t width, size_t row,
                          uint32_t base)
{
    const size_t from = row * width;
    size_t plain = 0;
    if (block->kind == TM_OCTANT)
        plain = TM_OCTANT_PLAIN;
    else if (block->kind == TM_ROOT)
        plain = 1;
    to = put_indices(to, block->integer, from, from + plain, 0);
    return put_indices(to, block->integer, from + plain, from + width, base);
}

/* What follows the number of a row. */
static char *put_row(char *to, const tm_block *block, const tm_block_shape *shape,
                     size_t row, uint32_t base)
{
    to = put_reals(to, block->real, row, shape->reals);
    to = put_integers(to, block, shape->integers, row, base);
    if (block->start) {
        size_t begin = block->start[row], count = block->start[row + 1] - begin;
        *to++ = ' ';
        to = tm_write_int64(to, (int64_t)count);
        to = put_indices(to, block->item, begin, begin + count, base);
    }
    to = put_reals(to, block->attribute, row, block->attributes);
    if (block->markers) {
        *to++ = ' ';
        to = tm_write_int64(to, block->marker[row]);
    }
    *to++ = '\n';
    return to;
}

/* Most bytes that put_row() needs for the rows from…to. */
static size_t room(const tm_block *block, size_t from, size_t to)
{
    size_t reals = tm_block_reals(block->kind) + block->attributes;
    size_t integers = tm_block_integers(block->kind) + 3;
    size_t items = block->start ? block->start[to] - block->start[from] : 0;
    return (to - from) *
               (reals * (TM_DOUBLE_CHARS + 1) + integers * (TM_INTEGER_CHARS + 1) + 1) +
           items * (TM_INTEGER_CHARS + 1);
}

static void format_chunk(void *context, size_t chunk)
{
    const batch *b = context;
    tm_text *text = &b->text[chunk];
    size_t from = b->first + chunk * CHUNK_ROWS, to = from + CHUNK_ROWS;
    if (to > b->block->count)
        to = b->block->count;
    if (!tm_text_room(text, room(b->block, from, to)))
        return;
    const tm_block_shape *shape = tm_block_shape_of(b->block->kind);
    row_number number = row_number_from(from + b->before + b->base);
    char *end = text->byte;
    for (size_t row = from; row < to; row++) {
        end = put_row(put_row_number(end, &number), b->block, shape, row, b->base);
        count_on(&number);
    }
    text->size = (size_t)(end - text->byte);
}

tm_status tm_sink_put_fd(void *to, const char *bytes, size_t size, tm_error *error)
{
    return tm_write_all(*(const int *)to, bytes, size, error);
}

static tm_status put_bytes(const tm_sink *sink, const char *bytes, size_t size,
                           tm_error *error)
{
    return sink->put(sink->to, bytes, size, error);
}

static tm_status put_text(const tm_sink *sink, const tm_text *text, tm_error *error)
{
    return text->failed ? tm_fail_memory(error)
                        : put_bytes(sink, text->byte, text->size, error);
}

tm_status tm_put_begin(const tm_stream *stream, const tm_sink *sink, tm_error *error)
{
    static const char magic[] = "termesh 1\n";
    const tm_status status = stream->history.failed
                                 ? tm_fail_memory(error)
                                 : put_bytes(sink, magic, sizeof magic - 1, error);
    return status == TM_OK ? put_text(sink, &stream->history, error) : status;
}

tm_status tm_put_end(const tm_sink *sink, tm_error *error)
{
    static const char end[] = ".end\n";
    return put_bytes(sink, end, sizeof end - 1, error);
}

tm_status tm_put_name(const tm_block *block, const tm_sink *sink, tm_error *error)
{
    const tm_status status = put_bytes(sink, block->name, strlen(block->name), error);
    return status == TM_OK ? put_bytes(sink, "\n", 1, error) : status;
}

tm_status tm_put_header(const tm_block *block, size_t rows, const tm_sink *sink,
                        tm_error *error)
{
    const tm_block_shape *shape = tm_block_shape_of(block->kind);
    tm_text text = {0};
    if (block->kind == TM_UNKNOWN)
        return TM_OK;
    tm_text_format(&text, "%zu", rows);
    for (size_t i = 0; i < shape->headers; i++) {
        if (shape->header[i] == TM_HEADER_ATTRIBUTES)
            tm_text_format(&text, " %zu", block->attributes);
        else if (shape->header[i] == TM_HEADER_MARKERS)
            tm_text_format(&text, " %d", block->markers);
        else if (shape->header[i] == TM_HEADER_ZERO)
            tm_text_string(&text, " 0");
        else
            tm_text_format(&text, " %d", shape->header[i]);
    }
    tm_text_string(&text, "\n");
    const tm_status status = put_text(sink, &text, error);
    tm_text_free(&text);
    return status;
}

/* Batch after batch; text[threads] is room for its chunks. */
static tm_status put_batches(batch *b, unsigned threads, const tm_sink *sink,
                             tm_writing *writing, tm_error *error)
{
    tm_status status = TM_OK;
    const size_t before = writing->at.done, count = b->block->count;
    while (b->first < count && status == TM_OK) {
        writing->at.done = before + b->first;
        tm_progress_tell(writing->progress, &writing->at);
        size_t left = (count - b->first + CHUNK_ROWS - 1) / CHUNK_ROWS;
        size_t chunks = left < threads ? left : threads;
        tm_parallel(threads, chunks, format_chunk, b);
        for (size_t c = 0; c < chunks && status == TM_OK; c++)
            status = put_text(sink, &b->text[c], error);
        b->first += chunks * CHUNK_ROWS;
    }
    writing->at.done = before + count;
    return status;
}

static tm_status put_groups(const tm_block *block, unsigned base, const tm_sink *sink,
                            tm_error *error)
{
    tm_text text = {0};
    tm_group_write(&text, block, base);
    const tm_status status = put_text(sink, &text, error);
    tm_text_free(&text);
    return status;
}

tm_status tm_put_rows(const tm_block *block, size_t before, unsigned base,
                      unsigned threads, const tm_sink *sink, tm_writing *writing,
                      tm_error *error)
{
    if (block->kind == TM_UNKNOWN)
        return put_text(sink, &block->text, error);
    if (block->kind == TM_GROUP)
        return put_groups(block, base, sink, error);
    if (before + block->count >= TM_IDS)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, block->name,
                          "%zu rows, more than 32 bits can number",
                          before + block->count);
    batch b = {.block = block,
               .base = base,
               .before = before,
               .text = calloc(threads, sizeof *b.text)};
    if (!b.text)
        return tm_fail_memory(error);
    const tm_status status = put_batches(&b, threads, sink, writing, error);
    for (unsigned t = 0; t < threads; t++)
        free(b.text[t].byte);
    free(b.text);
    return status;
}

tm_status tm_block_write(const tm_block *block, unsigned base, int fd, unsigned threads,
                         tm_error *error)
{
    tm_writing nobody = {0};
    const tm_sink sink = {tm_sink_put_fd, &fd};
    const tm_status status = tm_put_header(block, block->count, &sink, error);
    return status == TM_OK ? tm_put_rows(block, 0, base, threads, &sink, &nobody, error)
                           : status;
}

static tm_status put_block(const tm_block *block, unsigned base, unsigned threads,
                           const tm_sink *sink, tm_writing *writing, tm_error *error)
{
    tm_status status = tm_put_name(block, sink, error);
    if (status == TM_OK)
        status = tm_put_header(block, block->count, sink, error);
    return status == TM_OK ? tm_put_rows(block, 0, base, threads, sink, writing, error)
                           : status;
}

tm_status tm_stream_write(const tm_stream *stream, int fd, unsigned threads,
                          tm_error *error)
{
    const tm_sink sink = {tm_sink_put_fd, &fd};
    tm_writing writing = {stream->progress, {.what = "writing"}};
    for (size_t b = 0; b < stream->blocks; b++)
        writing.at.of += stream->block[b].count;
    tm_progress_tell(writing.progress, &writing.at);
    tm_status status = tm_put_begin(stream, &sink, error);
    for (size_t b = 0; b < stream->blocks && status == TM_OK; b++)
        status =
            put_block(&stream->block[b], stream->base, threads, &sink, &writing, error);
    return status == TM_OK ? tm_put_end(&sink, error) : status;
}
