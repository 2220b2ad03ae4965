/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A decimal number lies between two neighbouring doubles, m·2^p and (m+1)·2^p. Which is
 * nearer is told by the point in the middle, (2m+1)·2^(p-1): with the decimal number as
 * D·10^E, both sides are multiplied by the powers of 2 and 5 that make them integers,
 * and those are compared.
 *
 * How large can they become? A middle has at most 767 significant digits (the longest
 * are near the smallest normal doubles). So it is enough to take the first 768 digits of
 * the decimal number into D, and to remember whether any of those cut off is not 0: they
 * cannot lift a D below the middle above it, only a D that is equal. Then D < 10^768 <
 * 2^2552, and for E < 0 the other side is multiplied by at most 5^1092 < 2^2536. The
 * numbers are within a factor of two of each other (one unit in the last place), so after
 * the shift that remains both have less than 2700 bits. */
#include "number_exact.h"

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

enum { BIG_WORDS = 44, WORD_BITS = 64 }; /* 2816 bits */
enum { MAX_DIGITS = 768 };
enum { SIGNIFICAND_BITS = 52, SMALLEST_EXPONENT = -1074 }; /* of a double */
enum { FIVES = 27 };                                       /* 5^27 < 2^64 <= 5^28 */

__extension__ typedef unsigned __int128 uint128;

/* word[0] is the lowest; word[size - 1] is not 0; size is 0 for the number 0. */
typedef struct big {
    uint64_t word[BIG_WORDS];
    int size;
} big;

/* big = big·factor + term. */
static void multiply_add(big *number, uint64_t factor, uint64_t term)
{
    uint64_t carry = term;
    for (int i = 0; i < number->size; i++) {
        uint128 product = (uint128)number->word[i] * factor + carry;
        number->word[i] = (uint64_t)product;
        carry = (uint64_t)(product >> WORD_BITS);
    }
    if (carry != 0)
        number->word[number->size++] = carry;
}

static void multiply_power_of_five(big *number, int64_t exponent)
{
    static const uint64_t largest = UINT64_C(7450580596923828125); /* 5^FIVES */
    for (; exponent >= FIVES; exponent -= FIVES)
        multiply_add(number, largest, 0);
    uint64_t factor = 1;
    for (; exponent > 0; exponent--)
        factor *= 5;
    multiply_add(number, factor, 0);
}

static void shift_left(big *number, int64_t bits)
{
    multiply_add(number, UINT64_C(1) << (bits % WORD_BITS), 0);
    int words = (int)(bits / WORD_BITS);
    memmove(number->word + words, number->word,
            (size_t)number->size * sizeof *number->word);
    memset(number->word, 0, (size_t)words * sizeof *number->word);
    number->size += words;
}

/* -1, 0, 1 as a <, =, > b. */
static int compare(const big *a, const big *b)
{
    if (a->size != b->size)
        return a->size < b->size ? -1 : 1;
    for (int i = a->size - 1; i >= 0; i--) {
        if (a->word[i] != b->word[i])
            return a->word[i] < b->word[i] ? -1 : 1;
    }
    return 0;
}

/* Puts the first MAX_DIGITS digits into *number; *exponent grows by the number of those
 * that are left, and the result is whether any of them is not 0. */
static bool read_digits(const char *first, const char *last, big *number,
                        int64_t *exponent)
{
    bool rest = false;
    int count = 0;
    number->size = 0;
    for (const char *p = first; p < last; p++) {
        if (*p == '.')
            continue;
        if (count < MAX_DIGITS) {
            multiply_add(number, 10, (uint64_t)(*p - '0'));
            count++;
        } else {
            rest |= *p != '0';
            (*exponent)++;
        }
    }
    return rest;
}

uint64_t tm_round_exactly(const char *first, const char *last, int64_t exponent,
                          uint64_t below)
{
    big decimal;
    bool rest = read_digits(first, last, &decimal, &exponent);

    /* The middle is (2m + 1)·2^twos; subnormal numbers have no hidden bit. */
    uint64_t significand = below & ((UINT64_C(1) << SIGNIFICAND_BITS) - 1);
    int64_t biased = (int64_t)(below >> SIGNIFICAND_BITS);
    if (biased != 0)
        significand += UINT64_C(1) << SIGNIFICAND_BITS;
    int64_t twos = SMALLEST_EXPONENT - 1 + (biased > 0 ? biased - 1 : 0);
    big middle = {.word = {2 * significand + 1}, .size = 1};

    if (exponent >= 0)
        multiply_power_of_five(&decimal, exponent);
    else
        multiply_power_of_five(&middle, -exponent);
    if (exponent >= twos)
        shift_left(&decimal, exponent - twos);
    else
        shift_left(&middle, twos - exponent);

    int order = compare(&decimal, &middle);
    bool tie = order == 0 && !rest;
    bool up = tie ? (below & 1) != 0 : order >= 0;
    return below + up;
}
