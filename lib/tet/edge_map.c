/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "edge_map.h"

#include <stdlib.h>
#include <string.h>

void tm_edge_map_free(tm_edge_map *map)
{
    free(map->key);
    free(map->value);
    *map = (tm_edge_map){.with_values = map->with_values};
}

void tm_edge_map_clear(tm_edge_map *map)
{
    if (map->count > 0)
        memset(map->key, 0, map->room * sizeof *map->key);
    map->count = 0;
}

bool tm_edge_map_reserve(tm_edge_map *map, size_t more)
{
    enum { FIRST = 64 };
    size_t needed = 2 * (map->count + more), room = map->room ? map->room : FIRST;
    while (room < needed)
        room *= 2;
    if (room == map->room)
        return true;
    tm_edge_map wide = {.room = room, .with_values = map->with_values};
    wide.key = calloc(room, sizeof *wide.key);
    wide.value = map->with_values ? malloc(room * sizeof *wide.value) : NULL;
    if (!wide.key || (map->with_values && !wide.value)) {
        free(wide.key);
        free(wide.value);
        return false;
    }
    for (size_t s = 0; s < map->room; s++) {
        if (map->key[s] == 0)
            continue;
        size_t slot = tm_edge_map_slot(&wide, map->key[s]);
        wide.key[slot] = map->key[s];
        if (wide.value)
            wide.value[slot] = map->value[s];
    }
    wide.count = map->count;
    free(map->key);
    free(map->value);
    *map = wide;
    return true;
}

void tm_edge_map_put(tm_edge_map *map, uint32_t a, uint32_t b, uint32_t value)
{
    uint64_t key = tm_edge_key(a, b);
    size_t slot = tm_edge_map_slot(map, key);
    map->count += map->key[slot] == 0;
    map->key[slot] = key;
    if (map->value)
        map->value[slot] = value;
}

void tm_edge_map_remove(tm_edge_map *map, uint32_t a, uint32_t b)
{
    if (map->count == 0)
        return;
    size_t hole = tm_edge_map_slot(map, tm_edge_key(a, b)), mask = map->room - 1;
    if (map->key[hole] == 0)
        return;
    map->key[hole] = 0;
    map->count--;
    /* What was pushed behind the hole moves up, until the next empty slot. */
    for (size_t s = (hole + 1) & mask; map->key[s] != 0; s = (s + 1) & mask) {
        uint64_t key = map->key[s];
        uint32_t value = map->value ? map->value[s] : 0;
        map->key[s] = 0;
        size_t slot = tm_edge_map_slot(map, key);
        map->key[slot] = key;
        if (map->value)
            map->value[slot] = value;
    }
}
