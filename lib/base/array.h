/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growing flat arrays. */
#ifndef TM_BASE_ARRAY_H
#define TM_BASE_ARRAY_H

#include "extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Makes room for `needed` items of `size` bytes in `array`, which has room for
 * *capacity. Returns the array, moved if it had to grow (by half at least, so that
 * appending costs O(1) on average), with *capacity as it is then; NULL where memory is
 * out or the size overflows: array and *capacity are then as before.
 * The new room is not initialised. */
void *tm_grow(void *array, size_t *capacity, size_t needed, size_t size);

/* Appends a number to a list; false where memory is out. */
static inline bool tm_append(uint32_t **list, size_t *count, size_t *room, uint32_t item)
{
    uint32_t *moved = (uint32_t *)tm_grow(*list, room, *count + 1, sizeof **list);
    if (!moved)
        return false;
    *list = moved;
    moved[(*count)++] = item;
    return true;
}

/* The place of the first item of an ascending list that is not below `item`, or `count`.
 * O(log count). */
static inline size_t tm_first_not_below(const uint32_t *list, size_t count, uint32_t item)
{
    size_t begin = 0, end = count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (list[middle] < item)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

/* Compares two uint32_t, for qsort() and bsearch(). */
int tm_compare_numbers(const void *a, const void *b);

/* The same of two double. */
int tm_compare_reals(const void *a, const void *b);

/* malloc(count * size) with the product checked; never NULL for count 0. */
void *tm_new(size_t count, size_t size);

TM_EXTERN_C_END

#endif
