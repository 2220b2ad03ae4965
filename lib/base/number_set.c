/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "number_set.h"

#include "array.h"

#include <stdlib.h>

enum { BITS = 64 };

bool tm_number_set_make(tm_number_set *set, uint32_t first, uint32_t last)
{
    *set = (tm_number_set){.first = first,
                           .words = last < first ? 0 : (last - first) / BITS + 1};
    set->bit = calloc(set->words + 1, sizeof *set->bit);
    set->before = tm_new(set->words, sizeof *set->before);
    return set->bit && set->before;
}

void tm_number_set_free(tm_number_set *set)
{
    free(set->bit);
    free(set->before);
    *set = (tm_number_set){0};
}

void tm_number_set_count(tm_number_set *set)
{
    set->count = 0;
    for (size_t w = 0; w < set->words; w++) {
        set->before[w] = (uint32_t)set->count;
        set->count += (size_t)__builtin_popcountll(set->bit[w]);
    }
}

bool tm_number_set_of(tm_number_set *set, const uint32_t *list, size_t count,
                      uint32_t none)
{
    uint32_t first = UINT32_MAX, last = 0;
    for (size_t i = 0; i < count; i++)
        if (list[i] != none) {
            first = list[i] < first ? list[i] : first;
            last = list[i] > last ? list[i] : last;
        }
    if (!tm_number_set_make(set, first, last))
        return false;
    for (size_t i = 0; i < count; i++)
        if (list[i] != none)
            tm_number_set_add(set, list[i]);
    tm_number_set_count(set);
    return true;
}

void tm_number_set_list(const tm_number_set *set, uint32_t *list)
{
    size_t count = 0;
    for (size_t w = 0; w < set->words; w++)
        for (uint64_t left = set->bit[w]; left != 0; left &= left - 1)
            list[count++] =
                set->first + (uint32_t)(w * BITS) + (uint32_t)__builtin_ctzll(left);
}
