/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "place_order.h"

#include "../base/array.h"
#include "../base/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Points in one bucket, if x is even; buckets that a thread sorts at a time. */
enum { FILLING = 16, CHUNK = 256 };

static int compare(const void *a, const void *b)
{
    const tm_placed *p = a, *q = b;
    for (int x = 0; x < 3; x++)
        if (p->xyz[x] != q->xyz[x])
            return p->xyz[x] < q->xyz[x] ? -1 : 1;
    return (p->item > q->item) - (p->item < q->item);
}

void tm_place_sort(tm_placed *placed, size_t count)
{
    if (count > 0)
        qsort(placed, count, sizeof *placed, compare);
}

/* Buckets by x: those of bucket b are placed[start[b]] … placed[start[b + 1] - 1]. */
typedef struct {
    size_t buckets;
    double low, per_length;
    size_t *start; /* [buckets + 1] */
    tm_placed *placed;
    uint32_t *rank;
} bucket_sort;

/* Grows with x. */
static size_t bucket_of(const bucket_sort *s, double x)
{
    const double b = (x - s->low) * s->per_length;
    return b > 0 ? (size_t)fmin(b, (double)(s->buckets - 1)) : 0;
}

static void fill_buckets(bucket_sort *s, const double (*xyz)[3], size_t count)
{
    double high = -HUGE_VAL;
    s->low = HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        s->low = fmin(s->low, xyz[i][0]);
        high = fmax(high, xyz[i][0]);
    }
    s->per_length = high > s->low ? (double)s->buckets / (high - s->low) : 0;
    size_t *end = s->start + 1; /* while they are filled, start[b + 1] */
    for (size_t i = 0; i < count; i++)
        end[bucket_of(s, xyz[i][0]) + 1]++;
    for (size_t b = 0; b < s->buckets; b++)
        end[b + 1] += end[b];
    for (size_t i = 0; i < count; i++) {
        tm_placed *to = &s->placed[end[bucket_of(s, xyz[i][0])]++];
        memcpy(to->xyz, xyz[i], sizeof to->xyz);
        to->item = (uint32_t)i;
    }
}

static void sort_buckets(void *context, size_t from, size_t to)
{
    const bucket_sort *s = context;
    for (size_t b = from; b < to; b++)
        tm_place_sort(s->placed + s->start[b], s->start[b + 1] - s->start[b]);
    for (size_t k = s->start[from]; k < s->start[to]; k++)
        s->rank[s->placed[k].item] = (uint32_t)k;
}

bool tm_place_rank(const double (*xyz)[3], size_t count, unsigned threads, uint32_t *rank)
{
    bucket_sort s = {.buckets = count / FILLING + 1, .rank = rank};
    s.start = calloc(s.buckets + 2, sizeof *s.start);
    s.placed = tm_new(count, sizeof *s.placed);
    const bool done = s.start && s.placed;
    if (done) {
        fill_buckets(&s, xyz, count);
        tm_parallel_runs(threads, s.buckets, CHUNK, sort_buckets, &s);
    }
    free(s.start);
    free(s.placed);
    return done;
}
