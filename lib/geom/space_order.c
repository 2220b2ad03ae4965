/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "space_order.h"

#include <math.h>
#include <stdlib.h>

enum { CELLS = 1024 };

tm_space tm_space_around(const double (*xyz)[3], size_t count)
{
    tm_space space = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, 0};
    double side = 0;
    for (size_t v = 0; v < count; v++)
        for (int k = 0; k < 3; k++)
            space.low[k] = fmin(space.low[k], xyz[v][k]);
    for (size_t v = 0; v < count; v++)
        for (int k = 0; k < 3; k++)
            side = fmax(side, xyz[v][k] - space.low[k]);
    space.cells = side > 0 ? CELLS / side : 0;
    return space;
}

/* Bit i of ten goes to bit 3i. */
static uint32_t spread(uint32_t bits)
{
    bits = (bits | bits << 16) & 0x030000FF;
    bits = (bits | bits << 8) & 0x0300F00F;
    bits = (bits | bits << 4) & 0x030C30C3;
    return (bits | bits << 2) & 0x09249249;
}

uint32_t tm_space_place(const tm_space *space, const double p[3])
{
    uint32_t place = 0;
    for (int k = 0; k < 3; k++) {
        double cell = (p[k] - space->low[k]) * space->cells;
        /* What is no number, as 0 times infinity, goes to the first cell. */
        uint32_t c = cell > 0 ? (uint32_t)fmin(cell, CELLS - 1) : 0;
        place |= spread(c) << k;
    }
    return place;
}

static int compare(const void *a, const void *b)
{
    const tm_placed *p = a, *q = b;
    if (p->place != q->place)
        return p->place < q->place ? -1 : 1;
    return (p->item > q->item) - (p->item < q->item);
}

void tm_space_sort(tm_placed *placed, size_t count)
{
    qsort(placed, count, sizeof *placed, compare);
}
