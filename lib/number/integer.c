/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Integers to and from text. */
#include "digits.h"
#include "number.h"

#include <stdbool.h>
#include <stddef.h>

/* Every number of so many digits fits into 64 bits, with or without a sign. */
enum { SAFE_DIGITS = 18 };
enum { BLOCK = TM_WORD_NUMBERS };

const uint64_t tm_integer_powers[20] = {
    UINT64_C(1),
    UINT64_C(10),
    UINT64_C(100),
    UINT64_C(1000),
    UINT64_C(10000),
    UINT64_C(100000),
    UINT64_C(1000000),
    UINT64_C(10000000),
    UINT64_C(100000000),
    UINT64_C(1000000000),
    UINT64_C(10000000000),
    UINT64_C(100000000000),
    UINT64_C(1000000000000),
    UINT64_C(10000000000000),
    UINT64_C(100000000000000),
    UINT64_C(1000000000000000),
    UINT64_C(10000000000000000),
    UINT64_C(100000000000000000),
    UINT64_C(1000000000000000000),
    UINT64_C(10000000000000000000),
};

/* Whether the digits from text to end are at most limit; number is their value modulo
 * 2^64. Leading zeros do not count. */
static bool digits_fit(const char *text, const char *end, uint64_t number, uint64_t limit)
{
    while (text < end && *text == '0')
        text++;
    /* 19 digits are less than 2^64, so number is then not reduced. */
    return end - text <= SAFE_DIGITS + 1 && number <= limit;
}

/* The digits at text, however many. */
static const char *read_any(const char *text, const char *end, bool negative,
                            int64_t *value)
{
    uint64_t number = 0;
    const char *rest = tm_read_digits(text, end, &number);
    if (rest == text)
        return NULL;
    uint64_t limit = (uint64_t)INT64_MAX + negative;
    if (rest - text > SAFE_DIGITS && !digits_fit(text, rest, number, limit))
        return NULL;
    *value = (int64_t)(negative ? -number : number);
    return rest;
}

const char *tm_read_int64(const char *text, const char *end, int64_t *value)
{
    bool negative = false;
    if (text < end && (*text == '-' || *text == '+'))
        negative = *text++ == '-';
    if (end - text < TM_WORD_BYTES)
        return read_any(text, end, negative, value);
    uint64_t word = tm_word_load(text);
    int count = tm_word_digits(word);
    if (count == 0 || count == TM_WORD_BYTES)
        return read_any(text, end, negative, value);
    int64_t number = (int64_t)tm_word_value(word, count);
    *value = negative ? -number : number;
    return text + count;
}

/* Writes number < 10^8 with leading zeros. */
static char *write_block(char *text, uint32_t number)
{
    tm_word_store(text, tm_digits_word(number) + tm_word_of('0'));
    return text + TM_WORD_BYTES;
}

char *tm_write_int64(char *text, int64_t value)
{
    uint64_t number = (uint64_t)value;
    if (value < 0) {
        *text++ = '-';
        number = -number;
    }
    if (number < BLOCK)
        return tm_write_short(text, (uint32_t)number);
    uint64_t upper = number / BLOCK;
    if (upper < BLOCK) {
        text = tm_write_short(text, (uint32_t)upper);
    } else {
        text = tm_write_short(text, (uint32_t)(upper / BLOCK));
        text = write_block(text, (uint32_t)(upper % BLOCK));
    }
    return write_block(text, (uint32_t)(number % BLOCK));
}

char *tm_write_uint32(char *text, uint32_t value)
{
    if (value < BLOCK)
        return tm_write_short(text, value);
    text = tm_write_short(text, value / BLOCK);
    return write_block(text, value % BLOCK);
}
