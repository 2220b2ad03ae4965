/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "point_table.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS_MIN = 64 };

/* Equal coordinates hash alike: adding 0 makes -0 into 0. The mixing is that of
 * MurmurHash3's 64-bit finaliser (A. Appleby, 2011). */
static size_t hash(const double xyz[3])
{
    uint64_t h = 0;
    for (int i = 0; i < 3; i++) {
        double value = xyz[i] + 0.0;
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        h ^= bits;
        h ^= h >> 33;
        h *= UINT64_C(0xff51afd7ed558ccd);
        h ^= h >> 33;
        h *= UINT64_C(0xc4ceb9fe1a85ec53);
        h ^= h >> 33;
    }
    return (size_t)h;
}

static bool same(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* The slot of the point with those coordinates, or the free one where it belongs. */
static size_t find(const tm_point_table *table, double (*xyz)[3], const double point[3])
{
    size_t mask = table->slots - 1, s = hash(point) & mask;
    while (table->slot[s] != UINT32_MAX && !same(xyz[table->slot[s]], point))
        s = (s + 1) & mask;
    return s;
}

/* At most half of the slots are taken. */
static bool make_room(tm_point_table *table, double (*xyz)[3])
{
    if (table->points + 1 <= table->slots / 2)
        return true;
    tm_point_table wider = {.slots = table->slots ? table->slots * 2 : SLOTS_MIN,
                            .points = table->points};
    wider.slot = tm_new(wider.slots, sizeof *wider.slot);
    if (!wider.slot)
        return false;
    memset(wider.slot, UINT8_MAX, wider.slots * sizeof *wider.slot);
    for (size_t s = 0; s < table->slots; s++)
        if (table->slot[s] != UINT32_MAX)
            wider.slot[find(&wider, xyz, xyz[table->slot[s]])] = table->slot[s];
    free(table->slot);
    *table = wider;
    return true;
}

bool tm_point_table_join(tm_point_table *table, double (*xyz)[3], uint32_t id,
                         uint32_t *first)
{
    if (!make_room(table, xyz))
        return false;
    size_t s = find(table, xyz, xyz[id]);
    if (table->slot[s] == UINT32_MAX) {
        table->slot[s] = id;
        table->points++;
    }
    *first = table->slot[s];
    return true;
}

uint32_t tm_point_table_find(const tm_point_table *table, double (*xyz)[3],
                             const double point[3])
{
    return table->slots > 0 ? table->slot[find(table, xyz, point)] : UINT32_MAX;
}

void tm_point_table_free(tm_point_table *table)
{
    free(table->slot);
    *table = (tm_point_table){0};
}

bool tm_point_table_fill(tm_point_table *table, double (*xyz)[3], size_t count)
{
    uint32_t first;
    bool done = true;
    for (size_t v = 0; v < count && done; v++)
        done = tm_point_table_join(table, xyz, (uint32_t)v, &first);
    return done;
}

bool tm_points_weld(double (*xyz)[3], size_t count, uint32_t *unique, size_t *joined)
{
    tm_point_table table = {0};
    bool done = true;
    for (size_t v = 0; v < count && done; v++)
        done = tm_point_table_join(&table, xyz, (uint32_t)v, &unique[v]);
    *joined = count - table.points;
    tm_point_table_free(&table);
    return done;
}
