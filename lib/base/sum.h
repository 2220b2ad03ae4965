/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sum that carries what rounding loses of each addition (the error-free sum of two
 * numbers, Knuth 1969, section 4.2.2): the relative error is about one ulp whatever the
 * count, where all terms have the same sign. */
#ifndef TM_BASE_SUM_H
#define TM_BASE_SUM_H

#include <math.h>
#include <stddef.h>

/* {0} is an empty sum. */
typedef struct tm_sum {
    double high;
    double low; /* what `high` has lost */
} tm_sum;

static inline void tm_sum_add(tm_sum *sum, double term)
{
    const double high = sum->high + term;
    const double added = high - sum->high;
    sum->low += (sum->high - (high - added)) + (term - added);
    sum->high = high;
}

/* Infinite or NaN where the terms lead to that. */
static inline double tm_sum_value(tm_sum sum)
{
    return isfinite(sum.high) ? sum.high + sum.low : sum.high;
}

/* That of all, in their order. */
static inline double tm_sum_all(const tm_sum *sum, size_t count)
{
    tm_sum all = {0, 0};
    for (size_t i = 0; i < count; i++) {
        tm_sum_add(&all, sum[i].high);
        tm_sum_add(&all, sum[i].low);
    }
    return tm_sum_value(all);
}

#endif
