/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "soup.h"

#include "../../base/array.h"
#include "../../base/hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint64_t slot_of(const tm_near *near, const double place[3], const int offset[3])
{
    uint64_t h = 0, bits;
    for (int x = 0; x < 3; x++) {
        const double cell = floor(place[x] / near->cell) + offset[x] + 0.0;
        memcpy(&bits, &cell, sizeof bits);
        h = tm_hash(h, bits);
    }
    return h & (near->slots - 1);
}

bool tm_near_make(tm_near *near, const double (*xyz)[3], size_t nodes,
                  const uint32_t *list, size_t count, double cell)
{
    static const int here[3] = {0};
    *near = (tm_near){.xyz = xyz, .cell = cell, .slots = tm_hash_slots(count)};
    near->first = tm_new(near->slots, sizeof *near->first);
    near->next = tm_new(nodes, sizeof *near->next);
    if (!near->first || !near->next)
        return false;
    memset(near->first, UINT8_MAX, near->slots * sizeof *near->first);
    for (size_t i = count; i-- > 0;) {
        uint32_t *first = &near->first[slot_of(near, xyz[list[i]], here)];
        near->next[list[i]] = *first;
        *first = list[i];
    }
    return true;
}

void tm_near_free(tm_near *near)
{
    free(near->first);
    free(near->next);
    *near = (tm_near){0};
}

uint32_t tm_near_first(const tm_near *near, const double place[3], const int offset[3])
{
    return near->first[slot_of(near, place, offset)];
}
