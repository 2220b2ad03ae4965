/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "space_order.h"

#include "../base/array.h"
#include "../base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cells of a side; so many points are a thread's work at a time. */
enum { CELLS = 1024, CHUNK = 32768 };

void tm_box_extend(double low[3], double high[3], const double p[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(low[k], p[k]);
        high[k] = fmax(high[k], p[k]);
    }
}

tm_space tm_space_of_box(const double low[3], const double high[3])
{
    tm_space space = {{low[0], low[1], low[2]}, 0};
    double side = 0;
    for (int k = 0; k < 3; k++)
        side = fmax(side, high[k] - low[k]);
    space.cells = side > 0 ? CELLS / side : 0;
    return space;
}

tm_space tm_space_around(const double (*xyz)[3], size_t count)
{
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    double high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t v = 0; v < count; v++)
        tm_box_extend(low, high, xyz[v]);
    return tm_space_of_box(low, high);
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

/* One pass of the sort, by ten bits of the position from bit `from` on; equal ones stay
 * in their order. */
typedef struct {
    const tm_curve_point *point;
    tm_curve_point *to;
    size_t count;
    int from;
    size_t (*begin)[CELLS]; /* [chunks]: where the next one of each digit goes */
} digit_pass;

static size_t digit_of(const digit_pass *s, size_t i)
{
    return s->point[i].position >> s->from & (CELLS - 1);
}

static void count_digits(void *context, size_t from, size_t to)
{
    const digit_pass *s = context;
    memset(s->begin[from / CHUNK], 0, sizeof s->begin[from / CHUNK]);
    for (size_t i = from; i < to; i++)
        s->begin[from / CHUNK][digit_of(s, i)]++;
}

static void place_points(void *context, size_t from, size_t to)
{
    const digit_pass *s = context;
    for (size_t i = from; i < to; i++)
        s->to[s->begin[from / CHUNK][digit_of(s, i)]++] = s->point[i];
}

static void sort_by_digit(digit_pass *s, unsigned threads)
{
    const size_t chunks = tm_parallel_chunks(s->count, CHUNK);
    size_t next = 0;
    tm_parallel_runs(threads, s->count, CHUNK, count_digits, s);
    for (size_t d = 0; d < CELLS; d++)
        for (size_t c = 0; c < chunks; c++) {
            const size_t digits = s->begin[c][d];
            s->begin[c][d] = next;
            next += digits;
        }
    tm_parallel_runs(threads, s->count, CHUNK, place_points, s);
}

bool tm_space_sort(tm_curve_point *point, size_t count, unsigned threads)
{
    enum { DIGIT = 10, DIGITS = 3 };
    tm_curve_point *other = tm_new(count, sizeof *other);
    digit_pass s = {.count = count};
    s.begin = tm_new(tm_parallel_chunks(count, CHUNK), sizeof *s.begin);
    const bool done = other && s.begin;
    for (int d = 0; d < DIGITS && done; d++) {
        s.point = d % 2 ? other : point;
        s.to = d % 2 ? point : other;
        s.from = d * DIGIT;
        sort_by_digit(&s, threads);
    }
    if (done)
        memcpy(point, other, count * sizeof *point);
    free(other);
    free(s.begin);
    return done;
}
