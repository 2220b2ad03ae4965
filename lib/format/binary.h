/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of either byte order, as bytes of any alignment. */
#ifndef TM_FORMAT_BINARY_H
#define TM_FORMAT_BINARY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Whether this machine has the highest byte first. */
static inline bool tm_binary_is_big(void)
{
    static const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 0;
}

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

/* Writes a number as `size` bytes. */
static inline void tm_binary_put_unsigned(char *bytes, uint64_t value, size_t size,
                                          bool big)
{
    for (size_t i = 0; i < size; i++)
        bytes[big ? size - 1 - i : i] = (char)(value >> (8 * i) & UINT8_MAX);
}

static inline void tm_binary_put_float(char *bytes, float value, bool big)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    tm_binary_put_unsigned(bytes, bits, sizeof bits, big);
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
