/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hash table of edges with a 32-bit value for each: open addressing, linear probing,
 * removal by shifting back, at most half full. */
#ifndef TM_MESH_EDGE_MAP_H
#define TM_MESH_EDGE_MAP_H

#include "../base/extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef struct tm_edge_slot {
    uint64_t key; /* 0: empty */
    uint32_t value;
} tm_edge_slot;

/* {0} is an empty map. */
typedef struct tm_edge_map {
    size_t count;
    size_t room; /* a power of two, or 0 */
    tm_edge_slot *slot;
} tm_edge_map;

void tm_edge_map_free(tm_edge_map *map);

/* Room for so many more edges; false where memory is out. */
bool tm_edge_map_reserve(tm_edge_map *map, size_t more);

/* Adds or overwrites an edge (a != b, in either order); there must be room. */
void tm_edge_map_put(tm_edge_map *map, uint32_t a, uint32_t b, uint32_t value);

/* Removes an edge, if it is there. */
void tm_edge_map_remove(tm_edge_map *map, uint32_t a, uint32_t b);

/* The key of an edge, and where it is in the table or would be put. */
static inline uint64_t tm_edge_key(uint32_t a, uint32_t b)
{
    return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static inline tm_edge_slot *tm_edge_map_slot(const tm_edge_map *map, uint64_t key)
{
    const uint64_t golden =
        0x9E3779B97F4A7C15u; /* 2^64 / golden ratio: Fibonacci hashing */
    size_t s = (size_t)((key * golden) >> 32) & (map->room - 1);
    while (map->slot[s].key != 0 && map->slot[s].key != key)
        s = (s + 1) & (map->room - 1);
    return &map->slot[s];
}

/* The value of an edge, or NULL where it is not there. */
static inline uint32_t *tm_edge_map_get(const tm_edge_map *map, uint32_t a, uint32_t b)
{
    if (map->count == 0)
        return NULL;
    tm_edge_slot *slot = tm_edge_map_slot(map, tm_edge_key(a, b));
    return slot->key != 0 ? &slot->value : NULL;
}

TM_EXTERN_C_END

#endif
