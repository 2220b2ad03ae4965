/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Doubles to text: Schubfach ("pigeonhole") finds the digits, then they are laid out.
 *
 * All reals that read back as the double v = c·2^q form an interval, from the middle
 * between v and the double below to that between v and the one above. Let 10^k be the
 * largest power of ten that is not wider than the interval: then at least one multiple of
 * 10^k lies in it (the pigeonhole), but at most one of 10^(k+1). That one, if there is
 * one, is the shortest; else it is a multiple of 10^k, the one nearest to v. So four
 * candidates are enough: the multiples of 10^k and of 10^(k+1) just below and above v.
 *
 * They are compared with the interval's ends after scaling by 10^-k, as integers of four
 * times the size (which makes the ends integers before scaling). A scaled number is
 * rounded to odd: cut off, with the lowest bit set where the cut changed it. That keeps
 * it on the right side of every even integer, and all it is compared with is even. */
#include "number.h"

#include "digits.h"
#include "power.h"

#include <stdbool.h>

enum { SIGNIFICAND_BITS = 52, EXPONENT_MASK = 0x7ff, MIN_EXPONENT = -1074 };
enum { WORD_BITS = 64 };
/* As many digits as a double may need: one, and two words of eight. */
enum { MAX_DIGITS = 17, BLOCK = 100000000 };
#define HIDDEN_BIT (UINT64_C(1) << SIGNIFICAND_BITS)

__extension__ typedef unsigned __int128 uint128;

/* digits·10^exponent */
typedef struct decimal {
    uint64_t digits;
    int exponent;
} decimal;

/* floor(log10(2^q)), and floor(log10(3/4·2^q)), for every exponent q of a double:
 * log10(2) and log10(4/3) in units of 2^-22; >> rounds down. */
static int log10_power_of_two(int q)
{
    return (q * 1262611) >> 22;
}

static int log10_three_quarters(int q)
{
    return (q * 1262611 - 524031) >> 22;
}

/* significand·ten/2^128 rounded to odd, where ten is above the true power by at most 1,
 * and so the product by less than 2^-64: if the true one is an integer, the second word
 * is 0. It is not 0 just above an even integer, because no product of a double is
 * nearer to one than 2^-63 (Giulietti, section 9); above an odd one it is no matter. */
static uint64_t scale_to_odd(tm_power ten, uint64_t significand)
{
    uint64_t carry = (uint64_t)((uint128)ten.low * significand >> WORD_BITS);
    uint128 product = (uint128)ten.high * significand + carry;
    return (uint64_t)(product >> WORD_BITS) | ((uint64_t)product != 0);
}

/* The shortest decimal that rounds to c·2^q, the one nearest to it of those; it has at
 * most MAX_DIGITS digits, which may end in zeros. */
static decimal schubfach(uint64_t c, int q)
{
    /* Below a power of two doubles are half as far apart. */
    bool irregular = c == HIDDEN_BIT && q > MIN_EXPONENT;
    int k = irregular ? log10_three_quarters(q) : log10_power_of_two(q);
    int shift = q + tm_log2_power(-k) + 1;
    tm_power ten = tm_powers[-k - TM_POWER_MIN];
    ten.low++; /* no low part is all ones */
    uint64_t value = scale_to_odd(ten, (4 * c) << shift);
    uint64_t lower = scale_to_odd(ten, (4 * c - 2 + irregular) << shift);
    uint64_t upper = scale_to_odd(ten, (4 * c + 2) << shift);
    /* Ties read as the even neighbour: only then are the ends in the interval. */
    lower += c & 1;
    upper -= c & 1;

    /* Chosen without branches: what the digits are like cannot be predicted. */
    uint64_t below = value / 4;
    uint64_t tens = below / 10;
    uint64_t tens_below = lower <= 40 * tens; /* not 0: lower > 0 */
    uint64_t tens_above = 40 * tens + 40 <= upper;
    uint64_t middle = 4 * below + 2;
    uint64_t up = (value > middle) | ((value == middle) & below) | (lower > 4 * below);
    uint64_t nearest = below + (up & 1), rounder = 10 * (tens + tens_above);
    uint64_t choose_rounder = -(tens_below ^ tens_above);
    return (decimal){(rounder & choose_rounder) | (nearest & ~choose_rounder), k};
}

/* The shortest decimal of the double > 0 with these bits. */
static decimal shortest(uint64_t bits)
{
    uint64_t c = bits & (HIDDEN_BIT - 1);
    int biased = (int)(bits >> SIGNIFICAND_BITS) & EXPONENT_MASK;
    if (biased == 0)
        return schubfach(c, MIN_EXPONENT);
    c |= HIDDEN_BIT;
    int q = MIN_EXPONENT - 1 + biased;
    /* An integer is its own shortest decimal where doubles are at most 1 apart. */
    if (q <= 0 && q >= -SIGNIFICAND_BITS && (c & ((UINT64_C(1) << -q) - 1)) == 0)
        return (decimal){c >> -q, 0};
    return schubfach(c, q);
}

/* A decimal number's digits as text, filled up with '0' behind. */
typedef struct digit_text {
    char first;
    uint64_t second, tenth; /* the eight digits from the second, from the tenth */
    int count;              /* without the zeros at the end */
    int exponent;           /* the power of ten of the first digit */
} digit_text;

/* The digits of number > 0. */
static digit_text spell(decimal number)
{
    int length = tm_count_digits(number.digits);
    uint64_t digits = number.digits * tm_integer_powers[MAX_DIGITS - length];
    uint32_t nine = (uint32_t)(digits / BLOCK);
    uint64_t tenth = tm_digits_word((uint32_t)(digits % BLOCK));
    uint64_t second = tm_digits_word(nine % BLOCK);
    int count = 1;
    if (tenth != 0)
        count = MAX_DIGITS - __builtin_clzll(tenth) / 8;
    else if (second != 0)
        count = MAX_DIGITS - TM_WORD_BYTES - __builtin_clzll(second) / 8;
    return (digit_text){.first = (char)('0' + nine / BLOCK),
                        .second = second + tm_word_of('0'),
                        .tenth = tenth + tm_word_of('0'),
                        .count = count,
                        .exponent = number.exponent + length - 1};
}

/* The layouts store whole words: what comes after the end is written over or left, in the
 * TM_DOUBLE_CHARS bytes that there are. */

/* 0.0625: at most two zeros after the point, else scientific is shorter. */
static char *write_fraction(char *text, const digit_text *digits)
{
    tm_word_store(text, tm_word_of('0'));
    text[1] = '.';
    text += 1 - digits->exponent;
    text[0] = digits->first;
    tm_word_store(text + 1, digits->second);
    tm_word_store(text + 1 + TM_WORD_BYTES, digits->tenth);
    return text + digits->count;
}

/* 1200: at most four zeros, which may lie behind the 17 digits. */
static char *write_integer(char *text, const digit_text *digits)
{
    text[0] = digits->first;
    tm_word_store(text + 1, digits->second);
    tm_word_store(text + 1 + TM_WORD_BYTES, digits->tenth);
    tm_word_store(text + MAX_DIGITS, tm_word_of('0'));
    return text + digits->exponent + 1;
}

/* 12.5, with `before` digits before the point, 1 <= before < count: the word that the
 * point falls into is stored twice, the second time from the digit after the point. */
static char *write_mixed(char *text, const digit_text *digits, int before)
{
    text[0] = digits->first;
    tm_word_store(text + 1, digits->second);
    if (before <= TM_WORD_BYTES) {
        tm_word_store(text + before + 1, digits->second >> (8 * (before - 1)));
        tm_word_store(text + 2 + TM_WORD_BYTES, digits->tenth);
    } else {
        int left = before - 1 - TM_WORD_BYTES;
        tm_word_store(text + 1 + TM_WORD_BYTES, digits->tenth);
        tm_word_store(text + before + 1, digits->tenth >> (8 * left));
    }
    text[before] = '.';
    return text + digits->count + 1;
}

/* 1e-9, 1.25e-9 */
static char *write_scientific(char *text, const digit_text *digits)
{
    if (digits->count == 1)
        *text++ = digits->first;
    else
        text = write_mixed(text, digits, 1);
    *text++ = 'e';
    int exponent = digits->exponent;
    if (exponent < 0) {
        *text++ = '-';
        exponent = -exponent;
    }
    return tm_write_uint32(text, (uint32_t)exponent);
}

static int plain_length(int count, int exponent)
{
    if (exponent < 0)
        return count - exponent + 1;
    return exponent + 1 >= count ? exponent + 1 : count + 1;
}

static int scientific_length(int count, int exponent)
{
    int size = exponent < 0 ? -exponent : exponent;
    int exponent_length = (exponent < 0) + 1 + (size >= 10) + (size >= 100);
    return count + (count > 1) + 1 + exponent_length;
}

/* The decimal with at most so many digits that is nearest to number, ties to even. */
static decimal round_decimal(decimal number, int digits)
{
    int excess = tm_count_digits(number.digits) - digits;
    if (excess <= 0)
        return number;
    uint64_t unit = tm_integer_powers[excess];
    uint64_t kept = number.digits / unit, twice_rest = number.digits % unit * 2;
    kept += twice_rest > unit || (twice_rest == unit && kept % 2 == 1);
    return (decimal){kept, number.exponent + excess};
}

static inline char *lay_out(char *text, const digit_text *digits)
{
    int count = digits->count, exponent = digits->exponent;
    if (plain_length(count, exponent) > scientific_length(count, exponent))
        return write_scientific(text, digits);
    if (exponent < 0)
        return write_fraction(text, digits);
    if (exponent + 1 >= count)
        return write_integer(text, digits);
    return write_mixed(text, digits, exponent + 1);
}

/* Writes the sign, and the digit of 0. Where the sign is not negative, what comes next is
 * written over it. */
static inline char *write_sign(char *text, double value, uint64_t *bits)
{
    memcpy(bits, &value, sizeof *bits);
    *text = '-';
    text += *bits >> (WORD_BITS - 1);
    if (value == 0)
        *text++ = '0';
    return text;
}

char *tm_write_double(char *text, double value)
{
    uint64_t bits;
    text = write_sign(text, value, &bits);
    if (value == 0)
        return text;
    digit_text digits = spell(shortest(bits));
    return lay_out(text, &digits);
}

char *tm_write_rounded(char *text, double value, int most)
{
    uint64_t bits;
    text = write_sign(text, value, &bits);
    if (value == 0)
        return text;
    digit_text digits = spell(round_decimal(shortest(bits), most));
    return lay_out(text, &digits);
}
