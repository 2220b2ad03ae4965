/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "edge_map.h"

#include <stdlib.h>

void tm_edge_map_free(tm_edge_map *map)
{
    free(map->slot);
    *map = (tm_edge_map){0};
}

bool tm_edge_map_reserve(tm_edge_map *map, size_t more)
{
    enum { FIRST = 64 };
    size_t needed = 2 * (map->count + more), room = map->room ? map->room : FIRST;
    while (room < needed)
        room *= 2;
    if (room == map->room)
        return true;
    tm_edge_map wide = {.count = map->count, .room = room};
    wide.slot = calloc(room, sizeof *wide.slot);
    if (!wide.slot)
        return false;
    for (size_t s = 0; s < map->room; s++)
        if (map->slot[s].key != 0)
            *tm_edge_map_slot(&wide, map->slot[s].key) = map->slot[s];
    free(map->slot);
    *map = wide;
    return true;
}

void tm_edge_map_put(tm_edge_map *map, uint32_t a, uint32_t b, uint32_t value)
{
    uint64_t key = tm_edge_key(a, b);
    tm_edge_slot *slot = tm_edge_map_slot(map, key);
    map->count += slot->key == 0;
    *slot = (tm_edge_slot){key, value};
}

void tm_edge_map_remove(tm_edge_map *map, uint32_t a, uint32_t b)
{
    if (map->count == 0)
        return;
    tm_edge_slot *hole = tm_edge_map_slot(map, tm_edge_key(a, b));
    if (hole->key == 0)
        return;
    hole->key = 0;
    map->count--;
    /* What was pushed behind the hole moves up, until the next empty slot. */
    size_t mask = map->room - 1;
    for (size_t s = ((size_t)(hole - map->slot) + 1) & mask; map->slot[s].key != 0;
         s = (s + 1) & mask) {
        tm_edge_slot moved = map->slot[s];
        map->slot[s].key = 0;
        *tm_edge_map_slot(map, moved.key) = moved;
    }
}
