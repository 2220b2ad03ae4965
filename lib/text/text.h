/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A growing string. Appending never fails at once: a text that ran out of memory has
 * `failed` set, ignores what follows, and is asked about once at the end. */
#ifndef TM_TEXT_TEXT_H
#define TM_TEXT_TEXT_H

#include "../base/extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef struct tm_text {
    char *byte; /* size bytes, then a NUL; NULL while nothing was appended */
    size_t size;
    size_t capacity;
    bool failed;
} tm_text;

/* Append bytes, a string, what printf() would print, or a number. O(length) on average.
 */
void tm_text_append(tm_text *text, const char *bytes, size_t size);
void tm_text_string(tm_text *text, const char *string);
void tm_text_format(tm_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void tm_text_double(tm_text *text, double value); /* shortest form; see number.h */
void tm_text_integer(tm_text *text, int64_t value);

/* Room for `size` bytes in the place of what the text holds: false where there is none,
 * and the text has failed. Its size is then set by whoever fills it. */
bool tm_text_room(tm_text *text, size_t size);

void tm_text_free(tm_text *text);

TM_EXTERN_C_END

#endif
