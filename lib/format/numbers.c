/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "numbers.h"

#include "../number/number.h"
#include "binary.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { BITS = 8 };

size_t tm_number_size(tm_number_type type)
{
    static const uint8_t size[TM_NUMBER_TYPES] = {
        [TM_INT8] = 1,    [TM_UINT8] = 1,  [TM_INT16] = 2, [TM_UINT16] = 2,
        [TM_INT32] = 4,   [TM_UINT32] = 4, [TM_INT64] = 8, [TM_UINT64] = 8,
        [TM_FLOAT32] = 4, [TM_FLOAT64] = 8};
    return size[type];
}

/* The whole number with that sign bit in that many bytes. */
static int64_t signed_of(uint64_t bits, size_t size)
{
    const uint64_t sign = (uint64_t)1 << (BITS * size - 1);
    return (int64_t)((bits ^ sign) - sign);
}

static uint64_t bits_of(const tm_numbers *n, size_t i)
{
    const size_t size = tm_number_size(n->type);
    const char *at = n->bytes + i * size;
    if (n->big != tm_binary_is_big() ||
        (size != sizeof(uint32_t) && size != sizeof(uint64_t)))
        return tm_binary_unsigned(at, size, n->big);
    uint32_t half;
    uint64_t whole;
    if (size == sizeof half) {
        memcpy(&half, at, sizeof half);
        return half;
    }
    memcpy(&whole, at, sizeof whole);
    return whole;
}

double tm_numbers_real(const tm_numbers *n, size_t i)
{
    const uint64_t bits = bits_of(n, i);
    const uint32_t half = (uint32_t)bits;
    double real;
    float single;
    switch (n->type) {
    case TM_FLOAT64:
        memcpy(&real, &bits, sizeof real);
        return real;
    case TM_FLOAT32:
        memcpy(&single, &half, sizeof single);
        return (double)single;
    case TM_INT8:
    case TM_INT16:
    case TM_INT32:
    case TM_INT64:
        return (double)signed_of(bits, tm_number_size(n->type));
    default:
        return (double)bits;
    }
}

bool tm_numbers_whole(const tm_numbers *n, size_t i, int64_t lo, int64_t hi,
                      int64_t *value)
{
    if (!tm_number_is_whole(n->type)) {
        static const double most = 9007199254740992; /* 2^53 */
        const double real = tm_numbers_real(n, i);
        if (!(real >= -most && real <= most) || real != floor(real))
            return false;
        *value = (int64_t)real;
        return *value >= lo && *value <= hi;
    }
    const uint64_t bits = bits_of(n, i);
    const bool is_signed = n->type % 2 == TM_INT8;
    if (!is_signed && bits > INT64_MAX)
        return false;
    *value = is_signed ? signed_of(bits, tm_number_size(n->type)) : (int64_t)bits;
    return *value >= lo && *value <= hi;
}

/* Text ----------------------------------------------------------------------------- */

tm_status tm_numbers_of_bits(tm_numbers *numbers, const char *bits, size_t count,
                             tm_error *error)
{
    tm_text own = {0};
    if (!tm_text_room(&own, count + 1))
        return tm_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        own.byte[i] = bits[i / BITS] >> (BITS - 1 - i % BITS) & 1;
    tm_text_free(&numbers->own);
    *numbers = (tm_numbers){own.byte, count, TM_UINT8, false, own};
    return TM_OK;
}

tm_status tm_numbers_room(tm_numbers *numbers, tm_number_type type, size_t count,
                          tm_error *error)
{
    if (!tm_text_room(&numbers->own, count * TM_TAKEN_SIZE))
        return tm_fail_memory(error);
    numbers->own.size = count * TM_TAKEN_SIZE;
    numbers->bytes = numbers->own.byte;
    numbers->count = count;
    numbers->type = tm_number_is_whole(type) ? TM_INT64 : TM_FLOAT64;
    numbers->big = tm_binary_is_big();
    return TM_OK;
}

/* What printf() writes for a real that is no number or infinite. */
static bool is_not_finite(tm_word word)
{
    const bool sign = word.size > 0 && (*word.begin == '-' || *word.begin == '+');
    const tm_word rest = {word.begin + sign, word.size - sign};
    return tm_word_is_like(rest, "nan") || tm_word_is_like(rest, "inf") ||
           tm_word_is_like(rest, "infinity");
}

static tm_status scan_real(tm_scan *scan, const char *what, char *to, tm_error *error)
{
    double value = INFINITY;
    tm_scan_seek(scan);
    tm_scan here = *scan;
    tm_word word = tm_scan_word(&here);
    const char *end = word.begin + word.size;
    if (word.size > 0 &&
        (tm_read_double(word.begin, end, &value) == end || is_not_finite(word)))
        *scan = here;
    else if (tm_scan_double(scan, what, &value, error) != TM_OK)
        return TM_ERROR_INPUT;
    memcpy(to, &value, sizeof value);
    return TM_OK;
}

static tm_status scan_whole(tm_scan *scan, const char *what, char *to, tm_error *error)
{
    int64_t value;
    const tm_status status =
        tm_scan_next_integer(scan, what, INT64_MIN, INT64_MAX, &value, error);
    if (status == TM_OK)
        memcpy(to, &value, sizeof value);
    return status;
}

tm_status tm_numbers_scan(tm_numbers *numbers, tm_scan *scan, tm_number_type type,
                          size_t count, const char *what, tm_error *error)
{
    const bool whole = tm_number_is_whole(type);
    if (count > ((size_t)(scan->end - scan->at) + 1) / 2)
        return tm_scan_fail(
            scan, error, "there are not %zu numbers in the rest of it (%s)", count, what);
    tm_status status = tm_numbers_room(numbers, type, count, error);
    for (size_t i = 0; i < count && status == TM_OK; i++) {
        char *to = numbers->own.byte + i * TM_TAKEN_SIZE;
        status =
            whole ? scan_whole(scan, what, to, error) : scan_real(scan, what, to, error);
    }
    return status;
}

void tm_numbers_free(tm_numbers *numbers)
{
    tm_text_free(&numbers->own);
    *numbers = (tm_numbers){0};
}
