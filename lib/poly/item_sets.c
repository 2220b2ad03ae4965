/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "item_sets.h"

#include "../base/array.h"
#include "../stream/stream.h"

#include <stdlib.h>

bool tm_item_lists_make(tm_item_lists *lists, const uint32_t *set, size_t items,
                        size_t sets, const uint32_t *order)
{
    *lists = (tm_item_lists){.sets = sets};
    lists->start = calloc(sets + 2, sizeof *lists->start);
    lists->item = tm_new(items, sizeof *lists->item);
    if (!lists->start || !lists->item)
        return false;
    uint32_t *end = lists->start + 1; /* while they are filled, start[s + 1] */
    for (size_t i = 0; i < items; i++)
        end[set[i] + 1]++;
    for (size_t s = 0; s < sets; s++)
        end[s + 1] += end[s];
    for (uint32_t k = 0; k < items; k++) {
        const uint32_t i = order ? order[k] : k;
        lists->item[end[set[i]]++] = i;
    }
    return true;
}

void tm_item_lists_free(tm_item_lists *lists)
{
    free(lists->start);
    free(lists->item);
    *lists = (tm_item_lists){0};
}

tm_status tm_number_sets(uint32_t *set, size_t items, size_t *sets, tm_error *error)
{
    uint32_t *name = tm_new(*sets, sizeof *name);
    if (!name)
        return tm_fail_memory(error);
    for (size_t s = 0; s < *sets; s++)
        name[s] = TM_NONE;
    *sets = 0;
    for (size_t i = 0; i < items; i++) {
        if (name[set[i]] == TM_NONE)
            name[set[i]] = (uint32_t)(*sets)++;
        set[i] = name[set[i]];
    }
    free(name);
    return TM_OK;
}
