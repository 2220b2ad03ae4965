/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decimal digits, eight at a time in a 64-bit word. */
#ifndef TM_NUMBER_DIGITS_H
#define TM_NUMBER_DIGITS_H

#include <stdint.h>
#include <string.h>

/* A word of text bytes holds the first of them in its low byte. */
enum { TM_WORD_BYTES = 8 };

/* The numbers that eight digits can stand for. */
enum { TM_WORD_NUMBERS = 100000000 };

/* 10^n for 0 <= n < 20. */
extern const uint64_t tm_integer_powers[20];

/* c repeated in every byte. */
static inline uint64_t tm_word_of(unsigned char c)
{
    return c * UINT64_C(0x0101010101010101);
}

static inline void tm_word_store(char *text, uint64_t word)
{
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    memcpy(text, &word, sizeof word);
}

static inline uint64_t tm_word_load(const char *text)
{
    uint64_t word;
    memcpy(&word, text, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = __builtin_bswap64(word);
#endif
    return word;
}

/* How many of the eight bytes come before the first that is not a digit. Adding 0x46
 * sets the high bit of what is above '9', subtracting '0' that of what is below '0' and
 * of bytes from 0xb0 on; neither carries out of a digit, so the lowest mark is right. */
static inline int tm_word_digits(uint64_t word)
{
    uint64_t above = word + tm_word_of(0x7f - '9');
    uint64_t below = word - tm_word_of('0');
    uint64_t marks = (above | below) & tm_word_of(0x80);
    return marks == 0 ? TM_WORD_BYTES : __builtin_ctzll(marks) / 8;
}

/* The number that eight digits (values, not characters) stand for, the first in the low
 * byte. Neighbours are joined: digits to pairs, pairs to fours, fours to the eight. Each
 * step multiplies so that base·first + second comes to stand where the second was. */
static inline uint64_t tm_word_join(uint64_t word)
{
    word = (word * ((10 << 8) + 1)) >> 8 & UINT64_C(0x00ff00ff00ff00ff);
    word = (word * ((100 << 16) + 1)) >> 16 & UINT64_C(0x0000ffff0000ffff);
    return (word * ((UINT64_C(10000) << 32) + 1)) >> 32;
}

/* The number whose digits are the first count characters of word, 0 <= count <= 8; no
 * characters are 0. The shift drops the others and puts zeros before the digits; it has
 * two halves because a shift by 64 is not defined. */
static inline uint64_t tm_word_value(uint64_t word, int count)
{
    int half = 4 * (TM_WORD_BYTES - count);
    return tm_word_join((word - tm_word_of('0')) << half << half);
}

/* The number whose digits are all eight characters of word. */
static inline uint64_t tm_word_all(uint64_t word)
{
    return tm_word_join(word - tm_word_of('0'));
}

/* Appends to *number the digits at text: *number = *number·10^count + digits, modulo
 * 2^64. Returns the first byte that is not a digit, or end. How many digits there are at
 * the end of a number cannot be predicted, so no branch depends on it. */
static inline const char *tm_read_digits(const char *text, const char *end,
                                         uint64_t *number)
{
    uint64_t n = *number;
    while (end - text >= TM_WORD_BYTES) {
        uint64_t word = tm_word_load(text);
        int count = tm_word_digits(word);
        if (count < TM_WORD_BYTES) {
            *number = n * tm_integer_powers[count] + tm_word_value(word, count);
            return text + count;
        }
        n = n * tm_integer_powers[TM_WORD_BYTES] + tm_word_all(word);
        text += TM_WORD_BYTES;
    }
    while (text < end && *text >= '0' && *text <= '9')
        n = n * 10 + (uint64_t)(*text++ - '0');
    *number = n;
    return text;
}

/* The eight digits of number < 10^8, each the value of one byte (not yet a character),
 * the first in the low byte: the steps of tm_word_join backwards. Where x = 10·t + u
 * stands in one part of the word, t + (u << 8) = (x << 8) - t·((10 << 8) - 1). Division
 * is multiplication by 10486/2^20 (right below 43699) and by 103/2^10 (below 179). */
static inline uint64_t tm_digits_word(uint32_t number)
{
    uint64_t fours = number / 10000 | (uint64_t)(number % 10000) << 32;
    uint64_t hundreds = (fours * 10486) >> 20 & UINT64_C(0x0000007f0000007f);
    uint64_t pairs = (fours << 16) - hundreds * ((100 << 16) - 1);
    uint64_t tens = (pairs * 103) >> 10 & UINT64_C(0x000f000f000f000f);
    return (pairs << 8) - tens * ((10 << 8) - 1);
}

/* Writes number < TM_WORD_NUMBERS without leading zeros, and up to 7 bytes more. */
static inline char *tm_write_short(char *text, uint32_t number)
{
    uint64_t word = tm_digits_word(number);
    /* Zeros before the last digit; that one is written also if it is 0. */
    int zeros = __builtin_ctzll(word | UINT64_C(1) << 56) / 8;
    tm_word_store(text, (word + tm_word_of('0')) >> (8 * zeros));
    return text + TM_WORD_BYTES - zeros;
}

/* The number of decimal digits of number; 1 for 0. 1233/2^12 is log10(2) from above, so
 * that the estimate from the bits is right or one too small. */
static inline int tm_count_digits(uint64_t number)
{
    int bits = 64 - __builtin_clzll(number | 1);
    int estimate = bits * 1233 >> 12;
    return estimate + (number >= tm_integer_powers[estimate] || number == 0);
}

#endif
