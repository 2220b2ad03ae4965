/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers to and from text, without the locale, without a terminating NUL. */
#ifndef TM_NUMBER_NUMBER_H
#define TM_NUMBER_NUMBER_H

#include "../base/extern_c.h"

#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Bytes that the writers below may need at most. They store whole words, so there must be
 * so much room whatever the number, and what is behind their text in it is lost. */
enum { TM_DOUBLE_CHARS = 32, TM_INTEGER_CHARS = 24 };

/* Reads the decimal number that begins at text and ends before end:
 *     [+-] (digits [. [digits]] | . digits) [(e|E) [+-] digits]
 * No byte at or after end is read. The value is correctly rounded (to nearest, ties to
 * even) for every input of any length; too large gives infinity, too small 0 with the
 * sign. "inf", "nan" and hexadecimal are not numbers. Returns the first byte after the
 * number, or NULL where no number begins at text (*value is then untouched).
 * Clinger's fast path (PLDI 1990), then Eisel and Lemire (Number parsing at a gigabyte
 * per second, 2021), then exact comparison of big integers. O(length). */
const char *tm_read_double(const char *text, const char *end, double *value);

/* Reads [+-] digits in the same manner; NULL also where the value does not fit. */
const char *tm_read_int64(const char *text, const char *end, int64_t *value);

/* Writes the fewest digits that tm_read_double reads back as value, of those the ones
 * closest to it, in the shorter of two forms: plain (0.0625, 1200) or with an exponent
 * (1e-9, 1.5e22). -0 is written "-0"; value must be finite. Returns
 * the end of what was written, at most TM_DOUBLE_CHARS bytes; no NUL is added.
 * Giulietti, The Schubfach way to render doubles (2020). O(1). */
char *tm_write_double(char *text, double value);

/* The same of that decimal number rounded to `most` significant digits (1…17) where it
 * has more, ties to even. With 9, every float reads back as it was. */
char *tm_write_rounded(char *text, double value, int most);

/* Writes value in decimal; at most TM_INTEGER_CHARS bytes. */
char *tm_write_int64(char *text, int64_t value);
char *tm_write_uint32(char *text, uint32_t value);

TM_EXTERN_C_END

#endif
