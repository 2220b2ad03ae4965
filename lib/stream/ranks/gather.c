/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slices.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../block.h"

#include <stdlib.h>

/* Puts all rows of a flat array in its place, of which each has `width` numbers. */
static tm_status gather(void **array, size_t rows, size_t width, size_t size,
                        tm_error *error)
{
    void *all;
    if (width == 0)
        return TM_OK;
    const tm_status status =
        tm_ranks_gather(*array, rows, width * size, &all, NULL, error);
    free(*array);
    *array = all;
    return status;
}

/* The lists: how long they are, then what is in them. */
static tm_status gather_lists(tm_block *block, size_t total, tm_error *error)
{
    const size_t items = block->count > 0 ? block->start[block->count] : 0;
    for (size_t r = 0; r < block->count; r++)
        block->start[r] = block->start[r + 1] - block->start[r];
    tm_status status =
        gather((void **)&block->item, items, 1, sizeof *block->item, error);
    if (status == TM_OK)
        status =
            gather((void **)&block->start, block->count, 1, sizeof *block->start, error);
    if (status != TM_OK || tm_rank() > 0)
        return status;
    size_t *start = realloc(block->start, (total + 1) * sizeof *start), sum = 0;
    if (!start)
        return tm_fail_memory(error);
    block->start = start;
    for (size_t r = 0; r < total; r++) {
        const size_t length = start[r];
        start[r] = sum;
        sum += length;
    }
    start[total] = sum;
    return TM_OK;
}

static tm_status gather_block(tm_block *block, size_t total, tm_error *error)
{
    const tm_block_shape *shape = tm_block_shape_of(block->kind);
    const size_t rows = block->count;
    tm_status status =
        gather((void **)&block->real, rows, shape->reals, sizeof *block->real, error);
    if (status == TM_OK)
        status = gather((void **)&block->integer, rows, shape->integers,
                        sizeof *block->integer, error);
    if (status == TM_OK)
        status = gather((void **)&block->attribute, rows, block->attributes,
                        sizeof *block->attribute, error);
    if (status == TM_OK)
        status = gather((void **)&block->marker, rows, block->markers,
                        sizeof *block->marker, error);
    if (status == TM_OK && shape->list)
        status = tm_ranks_agree(gather_lists(block, total, error), error);
    block->count = tm_rank() == 0 ? total : 0;
    return status;
}

tm_status tm_slices_gather(tm_slices *slices, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t b = 0; b < slices->stream.blocks && status == TM_OK; b++) {
        tm_block *block = &slices->stream.block[b];
        if (block->kind != TM_UNKNOWN && block->kind != TM_GROUP)
            status = gather_block(block, slices->slice[b].total, error);
    }
    return status;
}
