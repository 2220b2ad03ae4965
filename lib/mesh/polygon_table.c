/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_table.h"

#include "../base/array.h"
#include "../base/hash.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS_MIN = 1024 };

/* The sum does not depend on where the polygon begins, nor on how it turns. */
static size_t hash(const uint32_t *node, size_t k)
{
    uint64_t sum = k;
    for (size_t i = 0; i < k; i++)
        sum += tm_hash(0, node[i] + UINT64_C(1));
    return (size_t)tm_hash(0, sum);
}

int tm_polygon_compare(const uint32_t *a, const uint32_t *b, size_t k)
{
    size_t first = 0;
    while (first < k && b[first] != a[0])
        first++;
    if (first == k)
        return 0;
    size_t forward = first, backward = first, alike = 1, opposite = 1;
    for (size_t i = 1; i < k; i++) {
        forward = forward + 1 == k ? 0 : forward + 1;
        backward = backward == 0 ? k - 1 : backward - 1;
        alike += a[i] == b[forward];
        opposite += a[i] == b[backward];
    }
    if (alike == k)
        return 1;
    return opposite == k ? -1 : 0;
}

/* The slot of the polygon that is the same, or the free one where it belongs. */
static size_t find(const tm_polygon_table *table, const size_t *start,
                   const uint32_t *node, const uint32_t *polygon, size_t k)
{
    size_t mask = table->slots - 1, s = hash(polygon, k) & mask;
    for (;; s = (s + 1) & mask) {
        uint32_t p = table->slot[s];
        if (p == UINT32_MAX)
            return s;
        if (start[p + 1] - start[p] == k &&
            tm_polygon_compare(node + start[p], polygon, k) != 0)
            return s;
    }
}

/* At most half of the slots are taken. */
static bool make_room(tm_polygon_table *table, const size_t *start, const uint32_t *node)
{
    if (table->polygons + 1 <= table->slots / 2)
        return true;
    tm_polygon_table wider = {.slots = table->slots ? table->slots * 2 : SLOTS_MIN,
                              .polygons = table->polygons};
    wider.slot = tm_new(wider.slots, sizeof *wider.slot);
    if (!wider.slot)
        return false;
    memset(wider.slot, UINT8_MAX, wider.slots * sizeof *wider.slot);
    size_t mask = wider.slots - 1;
    for (size_t old = 0; old < table->slots; old++) {
        uint32_t p = table->slot[old];
        if (p == UINT32_MAX)
            continue;
        size_t s = hash(node + start[p], start[p + 1] - start[p]) & mask;
        while (wider.slot[s] != UINT32_MAX)
            s = (s + 1) & mask;
        wider.slot[s] = p;
    }
    free(table->slot);
    *table = wider;
    return true;
}

bool tm_polygon_table_join(tm_polygon_table *table, const size_t *start,
                           const uint32_t *node, uint32_t id, uint32_t *first)
{
    if (!make_room(table, start, node))
        return false;
    size_t s = find(table, start, node, node + start[id], start[id + 1] - start[id]);
    if (table->slot[s] == UINT32_MAX) {
        table->slot[s] = id;
        table->polygons++;
    }
    *first = table->slot[s];
    return true;
}

uint32_t tm_polygon_table_find(const tm_polygon_table *table, const size_t *start,
                               const uint32_t *node, const uint32_t *polygon, size_t k)
{
    if (table->slots == 0)
        return UINT32_MAX;
    return table->slot[find(table, start, node, polygon, k)];
}

void tm_polygon_table_free(tm_polygon_table *table)
{
    free(table->slot);
    *table = (tm_polygon_table){0};
}
