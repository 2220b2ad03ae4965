/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Base64 (RFC 4648), for the page and for what goes into it when termesh is built. */
#ifndef TM_VIEW_BASE64_H
#define TM_VIEW_BASE64_H

#include <stddef.h>

/* How many characters bytes become. */
static inline size_t tm_base64_size(size_t bytes)
{
    return (bytes + 2) / 3 * 4;
}

static inline void tm_base64_three(const unsigned char from[3], char to[4])
{
    static const char letter[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    to[0] = letter[from[0] >> 2];
    to[1] = letter[(from[0] & 3) << 4 | from[1] >> 4];
    to[2] = letter[(from[1] & 15) << 2 | from[2] >> 6];
    to[3] = letter[from[2] & 63];
}

/* Writes to[tm_base64_size(size)]. */
static inline void tm_base64(const unsigned char *from, size_t size, char *to)
{
    size_t i = 0;
    for (; i + 3 <= size; i += 3, to += 4)
        tm_base64_three(from + i, to);
    if (i == size)
        return;
    const unsigned char rest[3] = {from[i], i + 1 < size ? from[i + 1] : 0, 0};
    tm_base64_three(rest, to);
    to[3] = '=';
    if (i + 1 == size)
        to[2] = '=';
}

#endif
