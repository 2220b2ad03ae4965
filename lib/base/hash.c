/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "hash.h"

#include "array.h"

#include <stdlib.h>
#include <string.h>

bool tm_hash_make(tm_hash_table *table, size_t count)
{
    const size_t slots = tm_hash_slots(count);
    *table = (tm_hash_table){slots - 1, tm_new(slots, sizeof *table->slot)};
    if (!table->slot)
        return false;
    memset(table->slot, UINT8_MAX, slots * sizeof *table->slot);
    return true;
}

void tm_hash_free(tm_hash_table *table)
{
    free(table->slot);
    *table = (tm_hash_table){0, NULL};
}
