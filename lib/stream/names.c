/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "names.h"

#include <string.h>

/* The slot of a name, or the free one where it belongs. */
static uint32_t *slot_of(const tm_block_names *names, const char *name)
{
    uint32_t *slot = tm_hash_slot(&names->table, tm_hash_string(name));
    while (*slot != TM_HASH_FREE && strcmp(names->stream->block[*slot].name, name) != 0)
        slot = tm_hash_next(&names->table, slot);
    return slot;
}

tm_block *tm_block_names_find(const tm_block_names *names, const char *name)
{
    if (names->room == 0)
        return NULL;
    const uint32_t b = *slot_of(names, name);
    return b == TM_HASH_FREE ? NULL : &names->stream->block[b];
}

static void put(tm_block_names *names, size_t b)
{
    *slot_of(names, names->stream->block[b].name) = (uint32_t)b;
}

bool tm_block_names_add(tm_block_names *names)
{
    enum { FIRST = 16 };
    const size_t blocks = names->stream->blocks;
    if (blocks <= names->room) {
        put(names, blocks - 1);
        return true;
    }
    const size_t room = names->room ? 2 * names->room : FIRST;
    tm_hash_free(&names->table);
    names->room = 0;
    if (blocks >= TM_HASH_FREE || !tm_hash_make(&names->table, room))
        return false;
    names->room = room;
    for (size_t b = 0; b < blocks; b++)
        put(names, b);
    return true;
}

void tm_block_names_free(tm_block_names *names)
{
    tm_hash_free(&names->table);
    names->room = 0;
}
