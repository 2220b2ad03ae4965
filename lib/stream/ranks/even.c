/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slices.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../block.h"

#include <stdlib.h>
#include <string.h>

/* How many rows go to each rank. */
typedef struct {
    size_t *rows;
    size_t got; /* rows of the slice */
} plan;

static tm_status make_plan(plan *p, size_t before, size_t count, size_t total,
                           tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    p->rows = tm_new(ranks, sizeof *p->rows);
    const tm_status status = tm_ranks_enough(p->rows, error);
    if (status == TM_OK)
        tm_slice_shares(total, ranks, before, count, p->rows);
    return status;
}

static size_t sum_of(const size_t *count, unsigned first, unsigned past)
{
    size_t sum = 0;
    for (unsigned r = first; r < past; r++)
        sum += count[r];
    return sum;
}

/* As memcpy(), also of nothing to or from nowhere. */
static void copy(void *to, const void *from, size_t size)
{
    if (size > 0)
        memcpy(to, from, size);
}

/* Makes room for what is more than this rank has, or gives it back. */
static tm_status resize(void **array, size_t items, size_t size, tm_error *error)
{
    void *other = realloc(*array, items * size + 1);
    if (other)
        *array = other;
    return tm_ranks_enough(other, error);
}

/* Of an array with items of `size` bytes for each rank, count[ranks] of them, this rank
 * keeps its own, where they are, and gets what others have for it. */
static tm_status keep_own(void **array, const size_t *count, size_t size, tm_error *error)
{
    const unsigned ranks = tm_ranks_count(), rank = tm_rank();
    const size_t own = count[rank], before = sum_of(count, 0, rank),
                 behind = sum_of(count, rank + 1, ranks);
    size_t *to = tm_new(ranks, sizeof *to);
    char *send = tm_new(before + behind, size);
    void *got = NULL;
    tm_status status = tm_ranks_enough(to && send, error);
    if (status == TM_OK) {
        for (unsigned r = 0; r < ranks; r++)
            to[r] = r == rank ? 0 : count[r];
        copy(send, *array, before * size);
        if (behind > 0)
            memcpy(send + before * size, (char *)*array + (before + own) * size,
                   behind * size);
        status = tm_ranks_exchange(send, to, size, &got, to, error);
    }
    free(send);
    const size_t first = status == TM_OK ? sum_of(to, 0, rank) : 0,
                 last = status == TM_OK ? sum_of(to, rank + 1, ranks) : 0;
    const size_t now = first + own + last, then = before + own + behind;
    if (status == TM_OK)
        status = resize(array, now > then ? now : then, size, error);
    if (status == TM_OK) {
        char *to_here = *array;
        memmove(to_here + first * size, to_here + before * size, own * size);
        copy(to_here, got, first * size);
        copy(to_here + (first + own) * size, (char *)got + first * size, last * size);
        status = resize(array, now, size, error);
    }
    free(to);
    free(got);
    return status;
}

/* *array has `width` numbers of `size` bytes for each row; NULL of width 0. */
static tm_status move(const plan *p, void **array, size_t width, size_t size,
                      tm_error *error)
{
    return width == 0 ? TM_OK : keep_own(array, p->rows, width * size, error);
}

/* The lists: how long they are, then what is in them. */
static tm_status move_lists(const plan *p, tm_block *block, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    size_t row = 0;
    size_t *length = tm_new(block->count, sizeof *length);
    size_t *items = tm_new(ranks, sizeof *items);
    tm_status status = tm_ranks_any(!length || !items) ? tm_fail_memory(error) : TM_OK;
    for (unsigned r = 0; r < ranks && status == TM_OK; r++) {
        const size_t begin = block->start[row];
        row += p->rows[r];
        items[r] = block->start[row] - begin;
    }
    for (row = 0; status == TM_OK && row < block->count; row++)
        length[row] = block->start[row + 1] - block->start[row];
    if (status == TM_OK)
        status = move(p, (void **)&length, 1, sizeof *length, error);
    if (status == TM_OK) {
        void *item = block->item;
        status = keep_own(&item, items, sizeof *block->item, error);
        block->item = item;
    }
    size_t *start = status == TM_OK ? tm_new(p->got + 1, sizeof *start) : NULL;
    if (status == TM_OK && tm_ranks_any(!start)) {
        free(start);
        start = NULL;
        status = tm_fail_memory(error);
    }
    if (start) {
        start[0] = 0;
        for (row = 0; row < p->got; row++)
            start[row + 1] = start[row] + length[row];
        free(block->start);
        block->start = start;
    }
    free(length);
    free(items);
    return status;
}

static tm_status move_rows(const plan *p, tm_block *block, tm_error *error)
{
    void *real = block->real, *integer = block->integer, *attribute = block->attribute;
    void *marker = block->marker;
    tm_status status = move(p, &real, tm_block_reals(block->kind), sizeof(double), error);
    if (status == TM_OK)
        status =
            move(p, &integer, tm_block_integers(block->kind), sizeof(uint32_t), error);
    if (status == TM_OK)
        status = move(p, &attribute, block->attributes, sizeof(double), error);
    if (status == TM_OK)
        status = move(p, &marker, block->markers, sizeof(int32_t), error);
    block->real = real;
    block->integer = integer;
    block->attribute = attribute;
    block->marker = marker;
    if (status == TM_OK && tm_block_shape_of(block->kind)->list)
        status = move_lists(p, block, error);
    if (status == TM_OK)
        block->count = p->got;
    return status;
}

tm_status tm_slices_even(tm_slices *slices, size_t b, tm_error *error)
{
    tm_block *block = &slices->stream.block[b];
    tm_slice *slice = &slices->slice[b];
    const unsigned ranks = tm_ranks_count();
    const size_t first = tm_slice_first(slice->total, ranks, tm_rank());
    const size_t past = tm_slice_first(slice->total, ranks, tm_rank() + 1);
    /* nothing before a rank without rows is said */
    if (block->count == 0)
        slice->before = first;
    const bool even = slice->before == first && block->count == past - first;
    if (!tm_ranks_any(!even))
        return TM_OK;
    plan p = {.got = past - first};
    tm_status status = make_plan(&p, slice->before, block->count, slice->total, error);
    if (status == TM_OK)
        status = move_rows(&p, block, error);
    slice->before = first;
    free(p.rows);
    return status;
}
