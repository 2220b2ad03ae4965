/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of numbers as text, formatted by the chunk, by as many threads as there may be:
 * what the writers of foreign text formats do alike. */
#ifndef TM_FORMAT_TEXT_ROWS_H
#define TM_FORMAT_TEXT_ROWS_H

#include "../number/number.h"
#include "../text/text.h"
#include "../stream/stream.h"

typedef struct tm_text_rows {
    const void *context;
    size_t count;
    /* Most bytes that the rows first … past - 1 need, and what a number writer of
     * number/number.h stores behind its text. */
    size_t (*room)(const void *context, size_t first, size_t past);
    /* Writes a row and returns its end. */
    char *(*put)(const void *context, size_t row, char *to);
} tm_text_rows;

/* Appends all rows; the same bytes for any number of threads. What is put in must not
 * fail; *text has failed where memory is out. */
void tm_text_append_rows(tm_text *text, const tm_text_rows *rows, unsigned threads);

/* Appends x y z of each node: `before`, three numbers with a blank between, '\n'. */
void tm_text_append_points(tm_text *text, const double *xyz, size_t count,
                           const char *before, unsigned threads);

/* A blank, then a number; at most TM_NUMBER_ROOM bytes. */
enum { TM_NUMBER_ROOM = TM_DOUBLE_CHARS + 1 };

static inline char *tm_put_number(char *to, uint32_t number)
{
    *to++ = ' ';
    return tm_write_uint32(to, number);
}

#endif
