/* SPDX-License-Identifier: GPL-3.0-or-later */
/* In the place of ../../unit/random.h, to be included before it: numbers are what a
 * fuzzer says, byte by byte, and 0 where it says no more. So the meshes and surfaces that
 * the tests make at random are made of its bytes. What a target draws it draws one by
 * one, not twice in a list or in a call: C leaves the order there open, and an input
 * would be another case with another compiler. */
#ifndef TESTS_FUZZ_BYTES_H
#define TESTS_FUZZ_BYTES_H
#define TESTS_UNIT_RANDOM_H

#include <inttypes.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static const uint8_t *bytes_left;
static size_t bytes_count;

static inline void bytes_start(const uint8_t *bytes, size_t size)
{
    bytes_left = bytes;
    bytes_count = size;
}

static inline unsigned next_byte(void)
{
    if (bytes_count == 0)
        return 0;
    bytes_count--;
    return *bytes_left++;
}

/* In 0 … count-1, of one byte where that is enough. */
static inline unsigned random_below(unsigned count)
{
    unsigned value = next_byte();
    for (unsigned most = 256; most < count && most < 1u << 24; most <<= 8)
        value = value << 8 | next_byte();
    return value % count;
}

/* In [0, 1), of two bytes: with few digits, so that nodes come in one plane. */
static inline double random_unit(void)
{
    const unsigned high = next_byte();
    return (high << 8 | next_byte()) * 0x1p-16;
}

static inline uint64_t random_bits(void)
{
    uint64_t bits = 0;
    for (int i = 0; i < 8; i++)
        bits = bits << 8 | next_byte();
    return bits;
}

#endif
