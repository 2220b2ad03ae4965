/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An array of numbers of any type as a file has it: its bytes, of either byte order, or
 * text. */
#ifndef TM_FORMAT_NUMBERS_H
#define TM_FORMAT_NUMBERS_H

#include "../text/text.h"
#include "scan.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum tm_number_type {
    TM_INT8,
    TM_UINT8,
    TM_INT16,
    TM_UINT16,
    TM_INT32,
    TM_UINT32,
    TM_INT64,
    TM_UINT64,
    TM_FLOAT32,
    TM_FLOAT64,
    TM_NUMBER_TYPES
} tm_number_type;

/* {0} has none. The bytes are somebody else's, or those of `own`. */
typedef struct tm_numbers {
    const char *bytes;
    size_t count;
    tm_number_type type;
    bool big;
    tm_text own;
} tm_numbers;

/* Bytes of a number. */
size_t tm_number_size(tm_number_type type);

static inline bool tm_number_is_whole(tm_number_type type)
{
    return type < TM_FLOAT32;
}

/* Number i, rounded where that is a whole number beyond 2^53. */
double tm_numbers_real(const tm_numbers *numbers, size_t i);

/* Number i where it is a whole one in lo … hi, else false. */
bool tm_numbers_whole(const tm_numbers *numbers, size_t i, int64_t lo, int64_t hi,
                      int64_t *value);

/* Makes *numbers of bits, of which a byte has eight, the first one the highest: each is a
 * byte of `own` then. Whatever `own` had is gone behind it. TM_ERROR_SYSTEM where memory
 * is out. O(count). */
tm_status tm_numbers_of_bits(tm_numbers *numbers, const char *bits, size_t count,
                             tm_error *error);

/* Makes room for `count` numbers in `own`, each int64_t where the type is whole, else
 * double: whoever calls this writes them there. TM_ERROR_SYSTEM where memory is out. */
enum { TM_TAKEN_SIZE = 8 };
tm_status tm_numbers_room(tm_numbers *numbers, tm_number_type type, size_t count,
                          tm_error *error);

/* Reads `count` numbers from a text, from word to word across lines; of reals also "nan"
 * and "inf" as printf() writes them, and what is too large is infinite. *numbers, which
 * is {0}, then has them as TM_INT64 or TM_FLOAT64. `what` is for messages: "a
 * coordinate". TM_ERROR_INPUT with the line; before memory is taken where the rest of the
 * text is too short. O(size of what is read). */
tm_status tm_numbers_scan(tm_numbers *numbers, tm_scan *scan, tm_number_type type,
                          size_t count, const char *what, tm_error *error);

void tm_numbers_free(tm_numbers *numbers);

#endif
