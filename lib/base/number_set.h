/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of numbers, as a bit for each of a range, that knows how many are below each:
 * which one in the set a number is, in ascending order, without a search. What has
 * numbers in a whole gets smaller ones in a part by this, in the same order. */
#ifndef TM_BASE_NUMBER_SET_H
#define TM_BASE_NUMBER_SET_H

#include "extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* {0} is empty, and without room. */
typedef struct tm_number_set {
    uint32_t first;   /* numbers from here */
    size_t words;     /* for 64 of them each */
    uint64_t *bit;    /* [words] */
    uint32_t *before; /* [words]: how many are below */
    size_t count;
} tm_number_set;

/* An empty set with room for the numbers first … last; none where last < first. False
 * where memory is out. */
bool tm_number_set_make(tm_number_set *set, uint32_t first, uint32_t last);
void tm_number_set_free(tm_number_set *set);

static inline void tm_number_set_add(tm_number_set *set, uint32_t number)
{
    const uint32_t at = number - set->first;
    set->bit[at / 64] |= (uint64_t)1 << at % 64;
}

/* Counts, after all were added. */
void tm_number_set_count(tm_number_set *set);

/* The set of all in a list but `none`; false where memory is out. O(count + range / 64).
 */
bool tm_number_set_of(tm_number_set *set, const uint32_t *list, size_t count,
                      uint32_t none);

/* How many numbers in the set are below a number, which may be any; of one in it: which
 * one it is. */
static inline uint32_t tm_number_set_below(const tm_number_set *set, uint32_t number)
{
    const uint32_t at = number < set->first ? 0 : number - set->first;
    if (at / 64 >= set->words)
        return (uint32_t)set->count;
    const uint64_t below = set->bit[at / 64] & (((uint64_t)1 << at % 64) - 1);
    return set->before[at / 64] + (uint32_t)__builtin_popcountll(below);
}

static inline bool tm_number_set_has(const tm_number_set *set, uint32_t number)
{
    const uint32_t at = number - set->first;
    return number >= set->first && at / 64 < set->words &&
           (set->bit[at / 64] >> at % 64 & 1) != 0;
}

/* Writes all of them, in ascending order: list[count]. */
void tm_number_set_list(const tm_number_set *set, uint32_t *list);

TM_EXTERN_C_END

#endif
