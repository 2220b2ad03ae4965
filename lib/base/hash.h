/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Hash tables of indices by open addressing with linear probing. What an index stands
 * for, and which two are equal, the caller knows:
 *
 *     uint32_t *slot = tm_hash_slot(&table, tm_hash(0, key));
 *     while (*slot != TM_HASH_FREE && key_of(*slot) != key)
 *         slot = tm_hash_next(&table, slot);
 *
 * Then *slot is the index with that key, or where it is to be put. */
#ifndef TM_BASE_HASH_H
#define TM_BASE_HASH_H

#include "extern_c.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

#define TM_HASH_FREE UINT32_MAX

typedef struct tm_hash_table {
    size_t mask;    /* the number of slots is a power of 2, and one more */
    uint32_t *slot; /* [mask + 1]: an index, or TM_HASH_FREE */
} tm_hash_table;

/* Slots for `count` indices: at most half of them will be used. */
static inline size_t tm_hash_slots(size_t count)
{
    size_t slots = 2;
    while (slots < 2 * count)
        slots *= 2;
    return slots;
}

/* An empty table for `count` indices at most; false where memory is out. */
bool tm_hash_make(tm_hash_table *table, size_t count);
void tm_hash_free(tm_hash_table *table);

/* The hash h of what comes before, and 64 bits more; begin with h = 0. */
static inline uint64_t tm_hash(uint64_t h, uint64_t bits)
{
    const uint64_t golden = 0x9E3779B97F4A7C15u; /* 2^64 / golden ratio */
    enum { HALF = 32 };
    h = (h ^ bits) * golden;
    return h ^ h >> HALF;
}

/* Of a string, by tm_hash(). O(length). */
static inline uint64_t tm_hash_string(const char *string)
{
    uint64_t h = 0;
    for (; *string; string++)
        h = tm_hash(h, (unsigned char)*string);
    return h;
}

/* Where to look first, and then. */
static inline uint32_t *tm_hash_slot(const tm_hash_table *table, uint64_t hash)
{
    return &table->slot[hash & table->mask];
}

static inline uint32_t *tm_hash_next(const tm_hash_table *table, const uint32_t *slot)
{
    return &table->slot[(size_t)(slot - table->slot + 1) & table->mask];
}

TM_EXTERN_C_END

#endif
