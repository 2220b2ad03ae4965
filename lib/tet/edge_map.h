/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A hash table of edges, with or without a 32-bit value for each: open addressing,
 * linear probing, removal by shifting back, at most half full. */
#ifndef TM_TET_EDGE_MAP_H
#define TM_TET_EDGE_MAP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tm_edge_map {
    size_t count;
    size_t room;     /* a power of two, or 0 */
    uint64_t *key;   /* 0: empty */
    uint32_t *value; /* NULL in a set */
    bool with_values;
} tm_edge_map;

/* {0} is an empty set; {.with_values = true} an empty map. */
void tm_edge_map_free(tm_edge_map *map);

/* Removes all edges; the room stays. */
void tm_edge_map_clear(tm_edge_map *map);

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

static inline size_t tm_edge_map_slot(const tm_edge_map *map, uint64_t key)
{
    const uint64_t golden =
        0x9E3779B97F4A7C15u; /* 2^64 / golden ratio: Fibonacci hashing */
    size_t slot = (size_t)((key * golden) >> 32) & (map->room - 1);
    while (map->key[slot] != 0 && map->key[slot] != key)
        slot = (slot + 1) & (map->room - 1);
    return slot;
}

static inline bool tm_edge_map_has(const tm_edge_map *map, uint32_t a, uint32_t b)
{
    if (map->count == 0)
        return false;
    return map->key[tm_edge_map_slot(map, tm_edge_key(a, b))] != 0;
}

/* Whether the edge is there; its value, where there are values. */
static inline bool tm_edge_map_get(const tm_edge_map *map, uint32_t a, uint32_t b,
                                   uint32_t *value)
{
    if (map->count == 0)
        return false;
    size_t slot = tm_edge_map_slot(map, tm_edge_key(a, b));
    if (map->key[slot] == 0)
        return false;
    *value = map->value[slot];
    return true;
}

#endif
