/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "text_rows.h"

#include "../base/parallel.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK_ROWS = 4096, COORDINATES = 3 };

/* Chunk c of a batch goes to text[c]. */
typedef struct batch {
    const tm_text_rows *rows;
    size_t first; /* row with which the batch begins */
    tm_text *text;
} batch;

static void format_chunk(void *context, size_t chunk)
{
    const batch *b = context;
    const tm_text_rows *rows = b->rows;
    tm_text *text = &b->text[chunk];
    size_t first = b->first + chunk * CHUNK_ROWS, past = first + CHUNK_ROWS;
    if (past > rows->count)
        past = rows->count;
    if (!tm_text_room(text, rows->room(rows->context, first, past) + TM_NUMBER_ROOM))
        return;
    char *end = text->byte;
    for (size_t row = first; row < past; row++)
        end = rows->put(rows->context, row, end);
    text->size = (size_t)(end - text->byte);
}

void tm_text_append_rows(tm_text *text, const tm_text_rows *rows, unsigned threads)
{
    batch b = {.rows = rows, .text = calloc(threads, sizeof *b.text)};
    text->failed |= !b.text;
    while (b.first < rows->count && !text->failed) {
        size_t left = (rows->count - b.first + CHUNK_ROWS - 1) / CHUNK_ROWS;
        size_t chunks = left < threads ? left : threads;
        tm_parallel(threads, chunks, format_chunk, &b);
        for (size_t c = 0; c < chunks; c++) {
            text->failed |= b.text[c].failed;
            if (!text->failed)
                tm_text_append(text, b.text[c].byte, b.text[c].size);
        }
        b.first += chunks * CHUNK_ROWS;
    }
    for (unsigned t = 0; b.text && t < threads; t++)
        free(b.text[t].byte);
    free(b.text);
}

typedef struct points {
    const double *xyz;
    const char *before;
    size_t length;
} points;

static size_t point_room(const void *context, size_t first, size_t past)
{
    const points *p = context;
    return (past - first) * (p->length + COORDINATES * TM_NUMBER_ROOM);
}

static char *put_point(const void *context, size_t row, char *to)
{
    const points *p = context;
    memcpy(to, p->before, p->length);
    to += p->length;
    for (size_t i = 0; i < COORDINATES; i++) {
        to = tm_write_double(to, p->xyz[COORDINATES * row + i]);
        *to++ = i + 1 < COORDINATES ? ' ' : '\n';
    }
    return to;
}

void tm_text_append_points(tm_text *text, const double *xyz, size_t count,
                           const char *before, unsigned threads)
{
    points p = {xyz, before, strlen(before)};
    const tm_text_rows rows = {&p, count, point_room, put_point};
    tm_text_append_rows(text, &rows, threads);
}
