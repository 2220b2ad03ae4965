/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "given.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    double value;
    uint32_t row;
} given;

static int by_value(const void *a, const void *b)
{
    const given *p = a, *q = b;
    if (p->value != q->value)
        return p->value < q->value ? -1 : 1;
    return (p->row > q->row) - (p->row < q->row);
}

tm_status tm_take_given(tm_block *block, size_t which, uint32_t **label, tm_error *error)
{
    *label = NULL;
    if (block->attributes == 0)
        return tm_fail(error, TM_ERROR_INPUT,
                       "%s has no attributes, of which the partition could be one",
                       block->name);
    if (which >= block->attributes)
        return tm_fail(error, TM_ERROR_INPUT,
                       "%s has %zu attributes, but the partition is to be attribute %zu",
                       block->name, block->attributes, which + 1);
    given *list = tm_new(block->count, sizeof *list);
    *label = tm_new(block->count, sizeof **label);
    const bool done = list && *label;
    for (uint32_t r = 0; r < block->count && done; r++)
        list[r] = (given){block->attribute[r * block->attributes + which], r};
    if (done) {
        qsort(list, block->count, sizeof *list, by_value);
        tm_block_drop_attribute(block, which);
    }
    uint32_t name = 0;
    for (size_t k = 0; k < block->count && done; k++) {
        name += k > 0 && list[k].value != list[k - 1].value;
        (*label)[list[k].row] = name;
    }
    free(list);
    return done ? TM_OK : tm_fail_memory(error);
}
