/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sets of items, as polyhedra are of tetrahedra or of other polyhedra: set[i] is that of
 * item i. */
#ifndef TM_POLY_ITEM_SETS_H
#define TM_POLY_ITEM_SETS_H

#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The items of set s are item[start[s]] … item[start[s + 1] - 1]. */
typedef struct tm_item_lists {
    size_t sets;
    uint32_t *start; /* [sets + 1] */
    uint32_t *item;
} tm_item_lists;

/* Lists the items of each set, in the order of order[items], or of their numbers where
 * that is NULL. False where memory is out; *lists is to be freed then, too. O(items). */
bool tm_item_lists_make(tm_item_lists *lists, const uint32_t *set, size_t items,
                        size_t sets, const uint32_t *order);
void tm_item_lists_free(tm_item_lists *lists);

/* Numbers the sets that have items from 0, in the order of their first ones; *sets
 * becomes how many there are. TM_ERROR_SYSTEM where memory is out. O(items). */
tm_status tm_number_sets(uint32_t *set, size_t items, size_t *sets, tm_error *error);

#endif
