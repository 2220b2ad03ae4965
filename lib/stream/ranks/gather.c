/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slices.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../block.h"

#include <stdlib.h>

/* Of all ranks' arrays of `width` numbers for each row, all for rank 0; none of width 0.
 */
static tm_status gather(void **array, size_t rows, size_t width, size_t size,
                        tm_error *error)
{
    void *all;
    if (width == 0)
        return TM_OK;
    const tm_status status =
        tm_ranks_gather(*array, rows, width * size, &all, NULL, error);
    if (status != TM_OK)
        return status;
    free(*array);
    *array = all;
    return TM_OK;
}

/* How long the lists are, instead of where they begin; and back. */
static void take_differences(size_t *start, size_t rows)
{
    for (size_t r = 0; r < rows; r++)
        start[r] = start[r + 1] - start[r];
}

static size_t *add_up(size_t *length, size_t rows)
{
    size_t *start = realloc(length, (rows + 1) * sizeof *start);
    size_t sum = 0;
    for (size_t r = 0; r < rows && start; r++) {
        const size_t next = sum + start[r];
        start[r] = sum;
        sum = next;
    }
    if (start)
        start[rows] = sum;
    return start;
}

static tm_status gather_lists(tm_block *block, size_t total, tm_error *error)
{
    const size_t items = block->start[block->count];
    void *item = block->item, *length = block->start;
    tm_status status = gather(&item, items, 1, sizeof(uint32_t), error);
    block->item = item;
    take_differences(block->start, block->count);
    if (status == TM_OK)
        status = gather(&length, block->count, 1, sizeof(size_t), error);
    block->start = length;
    if (status == TM_OK && length) {
        size_t *start = add_up(length, total);
        if (!start)
            status = tm_fail_memory(error);
        else
            block->start = start;
    }
    return tm_ranks_agree(status, error);
}

static tm_status gather_rows(tm_block *block, size_t total, tm_error *error)
{
    void *real = block->real, *integer = block->integer, *attribute = block->attribute;
    void *marker = block->marker;
    const size_t rows = block->count;
    tm_status status =
        gather(&real, rows, tm_block_reals(block->kind), sizeof(double), error);
    if (status == TM_OK)
        status = gather(&integer, rows, tm_block_integers(block->kind), sizeof(uint32_t),
                        error);
    if (status == TM_OK)
        status = gather(&attribute, rows, block->attributes, sizeof(double), error);
    if (status == TM_OK)
        status = gather(&marker, rows, block->markers, sizeof(int32_t), error);
    block->real = real;
    block->integer = integer;
    block->attribute = attribute;
    block->marker = marker;
    if (status == TM_OK && tm_block_shape_of(block->kind)->list)
        status = gather_lists(block, total, error);
    return status;
}

tm_status tm_slices_gather(tm_slices *slices, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t b = 0; b < slices->stream.blocks && status == TM_OK; b++) {
        tm_block *block = &slices->stream.block[b];
        tm_slice *slice = &slices->slice[b];
        if (block->kind == TM_GROUP || block->kind == TM_UNKNOWN)
            continue;
        status = gather_rows(block, slice->total, error);
        block->count = tm_rank() == 0 ? slice->total : 0;
        *slice = (tm_slice){tm_rank() == 0 ? 0 : slice->total, slice->total};
    }
    return status;
}

/* All ranks' arrays, on all; NULL of width 0. */
static tm_status share(const void *own, size_t rows, size_t width, size_t size,
                       void **all, tm_error *error)
{
    return width > 0 ? tm_ranks_share(own, rows, width * size, all, NULL, error) : TM_OK;
}

tm_status tm_slices_share(const tm_slices *slices, const char *name, tm_stream *to,
                          tm_error *error)
{
    tm_slice slice;
    const tm_block *own = tm_slices_find(slices, name, &slice);
    if (!own)
        return TM_OK;
    tm_block *block = tm_stream_add(to, name);
    void *real = NULL, *integer = NULL, *attribute = NULL, *marker = NULL;
    tm_status status = tm_ranks_enough(block, error);
    if (status == TM_OK)
        status = share(own->real, own->count, tm_block_reals(own->kind), sizeof(double),
                       &real, error);
    if (status == TM_OK)
        status = share(own->integer, own->count, tm_block_integers(own->kind),
                       sizeof(uint32_t), &integer, error);
    if (status == TM_OK)
        status = share(own->attribute, own->count, own->attributes, sizeof(double),
                       &attribute, error);
    if (status == TM_OK)
        status =
            share(own->marker, own->count, own->markers, sizeof(int32_t), &marker, error);
    if (block) {
        block->count = status == TM_OK ? slice.total : 0;
        block->attributes = own->attributes;
        block->markers = own->markers;
        block->real = real;
        block->integer = integer;
        block->attribute = attribute;
        block->marker = marker;
    }
    return status;
}
