/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Characters of UTF-8 (RFC 3629). */
#ifndef TM_TEXT_UTF8_H
#define TM_TEXT_UTF8_H

#include "../base/extern_c.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* The bytes of the well-formed character at `at`, which is before end: 1 … 4; 0 where
 * there is none. */
static inline size_t tm_utf8_size(const char *at, const char *end)
{
    enum { TAIL = 0x80, LEAD2 = 0xC2, LEAD3 = 0xE0, LEAD4 = 0xF0, LAST = 0xF4 };
    const unsigned char *u = (const unsigned char *)at;
    if (u[0] < TAIL)
        return 1;
    if (u[0] < LEAD2 || u[0] > LAST)
        return 0;
    const size_t size = u[0] < LEAD3 ? 2 : u[0] < LEAD4 ? 3 : 4;
    if ((size_t)(end - at) < size)
        return 0;
    for (size_t i = 1; i < size; i++)
        if ((u[i] & 0xC0) != TAIL)
            return 0;
    /* no overlong forms, no surrogates, nothing above U+10FFFF */
    if ((u[0] == LEAD3 && u[1] < 0xA0) || (u[0] == 0xED && u[1] > 0x9F) ||
        (u[0] == LEAD4 && u[1] < 0x90) || (u[0] == LAST && u[1] > 0x8F))
        return 0;
    return size;
}

/* Whether that character, of `size` bytes, is a control character: below U+0020, or
 * U+007F … U+009F. */
static inline bool tm_utf8_is_control(const char *at, size_t size)
{
    enum { DELETE = 0x7F, C1_LEAD = 0xC2, C1_PAST = 0xA0 };
    const unsigned char *u = (const unsigned char *)at;
    return size == 1 ? u[0] < ' ' || u[0] == DELETE
                     : size == 2 && u[0] == C1_LEAD && u[1] < C1_PAST;
}

TM_EXTERN_C_END

#endif
