/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "text.h"

#include "../base/array.h"
#include "../number/number.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Room for `size` more bytes and a NUL; false where there is none. */
static bool reserve(tm_text *text, size_t size)
{
    if (text->failed)
        return false;
    char *moved = tm_grow(text->byte, &text->capacity, text->size + size + 1, 1);
    if (!moved) {
        text->failed = true;
        return false;
    }
    text->byte = moved;
    return true;
}

void tm_text_append(tm_text *text, const char *bytes, size_t size)
{
    if (!reserve(text, size))
        return;
    if (size > 0)
        memcpy(text->byte + text->size, bytes, size);
    text->size += size;
    text->byte[text->size] = '\0';
}

void tm_text_string(tm_text *text, const char *string)
{
    tm_text_append(text, string, strlen(string));
}

void tm_text_format(tm_text *text, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int size = vsnprintf(NULL, 0, format, arguments);
    if (size >= 0 && reserve(text, (size_t)size)) {
        vsnprintf(text->byte + text->size, (size_t)size + 1, format, again);
        text->size += (size_t)size;
    }
    va_end(again);
    va_end(arguments);
}

void tm_text_double(tm_text *text, double value)
{
    char digits[TM_DOUBLE_CHARS];
    const char *end = tm_write_double(digits, value);
    tm_text_append(text, digits, (size_t)(end - digits));
}

void tm_text_integer(tm_text *text, int64_t value)
{
    char digits[TM_INTEGER_CHARS];
    const char *end = tm_write_int64(digits, value);
    tm_text_append(text, digits, (size_t)(end - digits));
}

bool tm_text_room(tm_text *text, size_t size)
{
    if (text->capacity >= size)
        return true;
    free(text->byte);
    text->byte = malloc(size);
    text->capacity = text->byte ? size : 0;
    text->failed = !text->byte;
    return !text->failed;
}

void tm_text_free(tm_text *text)
{
    free(text->byte);
    *text = (tm_text){0};
}
