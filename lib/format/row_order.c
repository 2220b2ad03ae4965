/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "row_order.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

/* From the first row on that is not the next one numbers are kept. */
static bool keep_numbers(tm_row_order *order, size_t row)
{
    order->room = 2 * row + 2;
    order->number = tm_new(order->room, sizeof *order->number);
    for (size_t r = 0; r < row && order->number; r++)
        order->number[r] = (uint32_t)((size_t)order->first + r);
    return order->number != NULL;
}

static bool grow(tm_row_order *order, size_t row)
{
    if (row < order->room)
        return true;
    const size_t room = 2 * row + 2;
    uint32_t *more = realloc(order->number, room * sizeof *more);
    if (!more)
        return false;
    order->number = more;
    order->room = room;
    return true;
}

tm_row_numbered tm_row_order_add(tm_row_order *order, size_t rows, size_t row,
                                 int64_t number)
{
    if (number < 0 || (uint64_t)number > rows || number >= UINT32_MAX)
        return TM_ROW_WRONG;
    if (row == 0 && number <= 1)
        order->first = number;
    if (!order->number && number == order->first + (int64_t)row)
        return TM_ROW_NUMBERED;
    if (!(order->number ? grow(order, row) : keep_numbers(order, row)))
        return TM_ROW_NO_MEMORY;
    order->number[row] = (uint32_t)number;
    return TM_ROW_NUMBERED;
}

bool tm_row_order_finish(tm_row_order *order, size_t rows, int64_t *number)
{
    if (!order->number)
        return true;
    bool *met = calloc(rows + 2, sizeof *met);
    *number = 1;
    if (!met)
        return false;
    for (size_t r = 0; r < rows; r++)
        met[order->number[r]] = true;
    order->first = met[0] ? 0 : 1;
    size_t n = 0;
    while (n < rows && met[(size_t)order->first + n])
        n++;
    *number = order->first + (int64_t)n;
    free(met);
    return n == rows;
}

/* Copies rows of `width` items to their places; the array that was there is freed. */
static bool move_rows(const tm_row_order *order, size_t rows, void **array, size_t width)
{
    if (width == 0 || !*array)
        return true;
    char *sorted = tm_new(rows, width);
    if (!sorted)
        return false;
    for (size_t r = 0; r < rows; r++)
        memcpy(sorted + width * (order->number[r] - (size_t)order->first),
               (const char *)*array + width * r, width);
    free(*array);
    *array = sorted;
    return true;
}

bool tm_row_order_apply(const tm_row_order *order, tm_block *block)
{
    const size_t rows = block->count;
    if (!order->number)
        return true;
    return move_rows(order, rows, (void **)&block->real,
                     tm_block_reals(block->kind) * sizeof *block->real) &&
           move_rows(order, rows, (void **)&block->integer,
                     tm_block_integers(block->kind) * sizeof *block->integer) &&
           move_rows(order, rows, (void **)&block->attribute,
                     block->attributes * sizeof *block->attribute) &&
           move_rows(order, rows, (void **)&block->marker,
                     block->markers ? sizeof *block->marker : 0);
}

void tm_row_order_free(tm_row_order *order)
{
    free(order->number);
    *order = (tm_row_order){0};
}
