/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Doubles from text. A decimal number is digits·10^exponent with integer digits. Nearly
 * all that occur are settled by one of two short computations:
 *
 * - Clinger: with at most 15 digits and |exponent| <= 22, digits and 10^|exponent| are
 *   doubles without rounding, so one multiplication or division rounds once: correctly.
 *
 * - Eisel and Lemire: digits times the 128 leading bits of 10^exponent. What is cut off
 *   makes the product a lower bound by less than one part in 2^63, mostly far less. Of
 *   its leading bits a double keeps 53, and the next says how to round. That is the right
 *   answer unless the error bound reaches over a middle of two doubles. This is seen
 *   from the bits after: a long run of ones, or of zeros only (perhaps a tie).
 *
 * What remains (hardly any number but middles made on purpose) goes to tm_round_exactly,
 * as does a number of more than 19 digits whose first 19 leave the rounding open. */
#include "number.h"

#include "digits.h"
#include "number_exact.h"
#include "power.h"

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* So many digits are always less than 2^64. */
enum { MAX_DIGITS = 19 };
/* A text's exponent beyond this is cut off; no text is long enough to make up for it. */
#define MAX_EXPONENT INT64_C(100000000000000000)
/* 10^309 is above the largest double; 10^19·10^-343 below half the smallest. */
enum { MAX_POWER = 308, MIN_POWER = TM_POWER_MIN };

/* IEEE 754 binary64. */
enum { SIGNIFICAND_BITS = 52, BIAS = 1023, MIN_NORMAL_EXPONENT = -1022 };
enum { SIGN_SHIFT = 63 };
#define INFINITY_BITS (UINT64_C(0x7ff) << SIGNIFICAND_BITS)

/* 10^15 < 2^53, and 10^22 = 5^22·2^22 with 5^22 < 2^53. */
enum { EXACT_DIGITS = 15, MAX_EXACT_POWER = 22, WORD_BITS = 64 };
static const double exact_power[MAX_EXACT_POWER + 1] = {
    1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
};

__extension__ typedef unsigned __int128 uint128;

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static uint64_t digit_value(char c)
{
    return (uint64_t)(c - '0');
}

/* A double as the bits of its absolute value. Where it is not decided, the number is at
 * least bits and less than 1.5 units in the last place above. */
typedef struct rounded {
    uint64_t bits;
    bool decided;
} rounded;

/* The low bits of a product's upper half that no double keeps. If they are not all ones,
 * an error less than 2^64 does not carry into those that one keeps. */
enum { CARRY_MASK = 0x1ff };

/* Rounds the number (high·2^64 + middle + error)·2^(exponent - 127), 0 <= error, whose
 * first bit is the highest of `high` or the next. The error is less than 2^64, and less
 * than 2 where the low bits of high (CARRY_MASK) are all ones. */
static rounded round_product(uint64_t high, uint64_t middle, int exponent)
{
    int first = (int)(high >> (WORD_BITS - 1));
    exponent += first - 1;
    if (exponent > BIAS)
        return (rounded){INFINITY_BITS, true};
    /* kept: the significand and, as its lowest bit, the one that decides on rounding.
     * Below MIN_NORMAL_EXPONENT there are fewer bits for each step, down to none. */
    int cut = WORD_BITS - SIGNIFICAND_BITS - 3 + first;
    if (exponent < MIN_NORMAL_EXPONENT)
        cut += MIN_NORMAL_EXPONENT - exponent;
    if (cut >= WORD_BITS)
        return (rounded){0, true};
    uint64_t kept = high >> cut;
    uint64_t mask = (UINT64_C(1) << cut) - 1;
    uint64_t rest = high & mask;
    uint64_t bits = 0;
    if (exponent >= MIN_NORMAL_EXPONENT) /* the hidden bit adds the 1 that is missing */
        bits = (uint64_t)(exponent + BIAS - 1) << SIGNIFICAND_BITS;
    bool tie = (kept & 3) == 1 && rest == 0 && middle == 0;
    bool carry = (kept & 1) == 0 && rest == mask && middle >= UINT64_MAX - 1;
    if (tie || carry)
        return (rounded){bits + (kept >> 1), false};
    return (rounded){bits + (kept >> 1) + (kept & 1), true};
}

/* The double nearest to digits·10^power, digits > 0. */
static rounded eisel_lemire(uint64_t digits, int64_t power)
{
    if (power < MIN_POWER)
        return (rounded){0, true};
    if (power > MAX_POWER)
        return (rounded){INFINITY_BITS, true};
    const tm_power *ten = &tm_powers[power - TM_POWER_MIN];
    int shift = __builtin_clzll(digits);
    digits <<= shift;
    uint128 product = (uint128)digits * ten->high;
    /* ten->low would add less than digits, which matters only if it can carry. */
    if ((product >> WORD_BITS & CARRY_MASK) == CARRY_MASK)
        product += (uint128)digits * ten->low >> WORD_BITS;
    return round_product((uint64_t)(product >> WORD_BITS), (uint64_t)product,
                         tm_log2_power((int)power) + WORD_BITS - shift);
}

/* The bits of the double nearest to the digits from first to last, of any number and with
 * a '.' perhaps among them; power is that of the last digit. */
static uint64_t round_long(const char *first, const char *last, int64_t power)
{
    while (first < last && (*first == '0' || *first == '.'))
        first++;
    uint64_t digits = 0;
    int count = 0;
    int64_t left = 0;
    for (const char *p = first; p < last; p++) {
        if (*p == '.')
            continue;
        if (count < MAX_DIGITS) {
            digits = digits * 10 + digit_value(*p);
            count++;
        } else {
            left++;
        }
    }
    if (digits == 0)
        return 0;
    rounded lower = eisel_lemire(digits, power + left);
    if (lower.decided) {
        rounded upper = left == 0 ? lower : eisel_lemire(digits + 1, power + left);
        if (upper.decided && upper.bits == lower.bits)
            return lower.bits;
    }
    return tm_round_exactly(first, last, power, lower.bits);
}

/* Reads the exponent "e-12" at text; returns text where there is none. */
static const char *read_exponent(const char *text, const char *end, int64_t *exponent)
{
    if (text == end || (*text != 'e' && *text != 'E'))
        return text;
    const char *p = text + 1;
    bool negative = false;
    if (p < end && (*p == '-' || *p == '+'))
        negative = *p++ == '-';
    if (p == end || !is_digit(*p))
        return text;
    int64_t value = 0;
    for (; p < end && is_digit(*p); p++) {
        if (value < MAX_EXPONENT)
            value = value * 10 + (int64_t)digit_value(*p);
    }
    *exponent += negative ? -value : value;
    return p;
}

static double from_bits(uint64_t bits, bool negative)
{
    bits |= (uint64_t)negative << SIGN_SHIFT;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The digits before the point: mostly one to three, so one at a time. */
static const char *read_whole_part(const char *text, const char *end, uint64_t *digits)
{
    uint64_t n = 0;
    for (; text < end && is_digit(*text); text++)
        n = n * 10 + digit_value(*text);
    *digits = n;
    return text;
}

/* The digits after the point, appended to *digits: mostly the 14 to 17 of a double that
 * is not round. Just how many they are cannot be predicted, so they are read without a
 * branch that depends on it: a word that is full, a word, perhaps one more. */
static const char *read_fraction(const char *text, const char *end, uint64_t *digits)
{
    if (end - text <= 2 * TM_WORD_BYTES)
        return tm_read_digits(text, end, digits);
    uint64_t word = tm_word_load(text);
    if (tm_word_digits(word) < TM_WORD_BYTES)
        return tm_read_digits(text, end, digits);
    uint64_t n = *digits * tm_integer_powers[TM_WORD_BYTES] + tm_word_all(word);
    text += TM_WORD_BYTES;
    word = tm_word_load(text);
    int count = tm_word_digits(word);
    n = n * tm_integer_powers[count] + tm_word_value(word, count);
    text += count;
    bool one_more = is_digit(*text);
    *digits = one_more ? n * 10 + digit_value(*text) : n;
    text += one_more;
    if (text < end && is_digit(*text))
        return tm_read_digits(text, end, digits);
    return text;
}

const char *tm_read_double(const char *text, const char *end, double *value)
{
    if (text == end)
        return NULL;
    bool negative = *text == '-'; /* a coin toss in most meshes, so not a branch */
    text += negative;
    if (!negative && *text == '+')
        text++;

    uint64_t digits;
    const char *last = read_whole_part(text, end, &digits);
    ptrdiff_t count = last - text;
    int64_t power = 0;
    if (last < end && *last == '.') {
        const char *point = last;
        last = read_fraction(point + 1, end, &digits);
        power = point + 1 - last;
        count = last - text - 1;
    }
    if (count == 0)
        return NULL;
    const char *rest = read_exponent(last, end, &power);

    if (count > MAX_DIGITS) {
        *value = from_bits(round_long(text, last, power), negative);
    } else if (count <= EXACT_DIGITS && power >= -MAX_EXACT_POWER &&
               power <= MAX_EXACT_POWER && FLT_EVAL_METHOD == 0) {
        double size = (double)(int64_t)digits;
        size = power < 0 ? size / exact_power[-power] : size * exact_power[power];
        *value = negative ? -size : size;
    } else if (digits == 0) {
        *value = from_bits(0, negative);
    } else {
        rounded nearest = eisel_lemire(digits, power);
        if (!nearest.decided)
            nearest.bits = round_long(text, last, power);
        *value = from_bits(nearest.bits, negative);
    }
    return rest;
}
