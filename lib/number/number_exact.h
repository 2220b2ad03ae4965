/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The last resort of tm_read_double: comparison of big integers. */
#ifndef TM_NUMBER_NUMBER_EXACT_H
#define TM_NUMBER_NUMBER_EXACT_H

#include <stdint.h>

/* Rounds the decimal number digits·10^exponent, where the digits are the text from first
 * to last (a '.' among them is passed over; the first one is not 0; there are as many as
 * you like). below is the bit pattern of a finite double >= 0 that is at most the number,
 * which in turn is less than 1.5 units in the last place above it; where below is 0, the
 * number is at least a quarter of the smallest double. Returns below or
 * below + 1, the bit pattern of the double nearest to the number, ties to even.
 * O(length); no memory is allocated. */
uint64_t tm_round_exactly(const char *first, const char *last, int64_t exponent,
                          uint64_t below);

#endif
