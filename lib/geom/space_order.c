/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "space_order.h"

#include "../base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

uint32_t tm_space_position(const tm_space *space, const double p[3])
{
    uint32_t position = 0;
    for (int k = 0; k < 3; k++) {
        double cell = (p[k] - space->low[k]) * space->cells;
        /* What is no number, as 0 times infinity, goes to the first cell. */
        uint32_t c = cell > 0 ? (uint32_t)fmin(cell, CELLS - 1) : 0;
        position |= spread(c) << k;
    }
    return position;
}

/* Sorts by ten bits of the position from bit `from` on; equal ones stay in their order.
 */
static void sort_by_digit(tm_curve_point *to, const tm_curve_point *point, size_t count,
                          int from)
{
    size_t begin[CELLS + 1] = {0};
    for (size_t i = 0; i < count; i++)
        begin[(point[i].position >> from & (CELLS - 1)) + 1]++;
    for (size_t d = 0; d < CELLS; d++)
        begin[d + 1] += begin[d];
    for (size_t i = 0; i < count; i++)
        to[begin[point[i].position >> from & (CELLS - 1)]++] = point[i];
}

bool tm_space_sort(tm_curve_point *point, size_t count)
{
    enum { DIGIT = 10 };
    tm_curve_point *other = tm_new(count, sizeof *other);
    if (!other)
        return false;
    sort_by_digit(other, point, count, 0);
    sort_by_digit(point, other, count, DIGIT);
    sort_by_digit(other, point, count, 2 * DIGIT);
    memcpy(point, other, count * sizeof *point);
    free(other);
    return true;
}
