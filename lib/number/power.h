/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Powers of ten in binary, for reading and for writing doubles. */
#ifndef TM_NUMBER_POWER_H
#define TM_NUMBER_POWER_H

#include <stdint.h>

/* The range of k below. */
enum { TM_POWER_MIN = -342, TM_POWER_MAX = 324 };

/* The 128 leading bits of a power of ten, cut off; the first bit is set:
 *     10^k = (high·2^64 + low + rest)·2^(tm_log2_power(k) - 127),   0 <= rest < 1,
 * where rest is 0 exactly for 0 <= k <= 55. */
typedef struct tm_power {
    uint64_t high;
    uint64_t low;
} tm_power;

/* 10^k is tm_powers[k - TM_POWER_MIN]. */
extern const tm_power tm_powers[TM_POWER_MAX - TM_POWER_MIN + 1];

/* floor(log2(10^k)) for TM_POWER_MIN <= k <= TM_POWER_MAX: 217706/2^16 is close enough
 * to log2(10) for |k| < 643, and >> rounds down, also for negative numbers. */
static inline int tm_log2_power(int k)
{
    return (k * 217706) >> 16;
}

#endif
