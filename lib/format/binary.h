/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of either byte order from bytes of any alignment. */
#ifndef TM_FORMAT_BINARY_H
#define TM_FORMAT_BINARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* The unsigned number in `size` (1…8) bytes. */
static inline uint64_t tm_binary_unsigned(const char *bytes, size_t size, bool big)
{
    uint64_t value = 0;
    for (size_t i = 0; i < size; i++) {
        uint64_t byte = (unsigned char)bytes[big ? size - 1 - i : i];
        value |= byte << (8 * i);
    }
    return value;
}

static inline float tm_binary_float(const char *bytes, bool big)
{
    uint32_t bits = (uint32_t)tm_binary_unsigned(bytes, sizeof bits, big);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double tm_binary_double(const char *bytes, bool big)
{
    uint64_t bits = tm_binary_unsigned(bytes, sizeof bits, big);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
