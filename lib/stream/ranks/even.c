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
    size_t *items; /* of lists; room for as many numbers */
    size_t got;    /* rows of the slice */
} plan;

static tm_status make_plan(plan *p, size_t before, size_t count, size_t total,
                           tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    p->rows = tm_new(2 * (size_t)ranks, sizeof *p->rows);
    if (tm_ranks_any(!p->rows))
        return tm_fail_memory(error);
    p->items = p->rows + ranks;
    tm_slice_shares(total, ranks, before, count, p->rows);
    return TM_OK;
}

/* *array has `width` numbers of `size` bytes for each row; NULL of width 0. */
static tm_status move(const plan *p, void **array, size_t width, size_t size,
                      tm_error *error)
{
    void *got;
    if (width == 0)
        return TM_OK;
    const tm_status status =
        tm_ranks_exchange(*array, p->rows, width * size, &got, p->items, error);
    if (status != TM_OK)
        return status;
    free(*array);
    *array = got;
    return TM_OK;
}

/* The lists: how long they are, then what is in them. */
static tm_status move_lists(const plan *p, tm_block *block, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    size_t row = 0;
    void *got;
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
        status = tm_ranks_exchange(block->item, items, sizeof *block->item, &got, items,
                                   error);
        if (status == TM_OK) {
            free(block->item);
            block->item = got;
        }
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
