/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of blocks and the memory of one. */
#include "block.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

static const tm_block_shape shapes[] = {
    [TM_NODE] = {".node", {3, TM_HEADER_ATTRIBUTES, TM_HEADER_MARKERS}, 3, 3, 0, false},
    [TM_ELE] = {".ele", {4, TM_HEADER_ATTRIBUTES}, 2, 0, 4, false},
    [TM_FACE] = {".face", {TM_HEADER_MARKERS}, 1, 0, 3, false},
    [TM_EDGE] = {".edge", {TM_HEADER_MARKERS}, 1, 0, 2, false},
    [TM_MIX] = {".mix", {TM_HEADER_ATTRIBUTES}, 1, 0, 0, true},
    [TM_OCTANT] = {".octant", {TM_HEADER_ATTRIBUTES}, 1, 0, 6, false},
    [TM_ROOT] = {".root", {TM_HEADER_ATTRIBUTES}, 1, 4, 1, false},
    [TM_FACET] = {".facet", {TM_HEADER_MARKERS}, 1, 0, 2, true},
    [TM_CELL] = {".cell", {TM_HEADER_ATTRIBUTES}, 1, 0, 0, true},
    [TM_GROUP] = {".group", {TM_HEADER_ZERO}, 1, 0, 2, false},
    [TM_UNKNOWN] = {"", {0}, 0, 0, 0, false},
};

const tm_block_shape *tm_block_shape_of(tm_block_kind kind)
{
    return &shapes[kind];
}

size_t tm_block_reals(tm_block_kind kind)
{
    return shapes[kind].reals;
}

size_t tm_block_integers(tm_block_kind kind)
{
    return shapes[kind].integers;
}

tm_block_kind tm_block_kind_of(const char *name)
{
    const char *suffix = strrchr(name, '.');
    if (!suffix)
        return TM_UNKNOWN;
    for (int kind = TM_NODE; kind < TM_UNKNOWN; kind++)
        if (strcmp(suffix, shapes[kind].suffix) == 0)
            return (tm_block_kind)kind;
    return TM_UNKNOWN;
}

void tm_block_clear(tm_block *block)
{
    free(block->real);
    free(block->integer);
    free(block->start);
    free(block->item);
    free(block->attribute);
    free(block->marker);
    tm_text_free(&block->text);
    block->real = NULL;
    block->integer = NULL;
    block->start = NULL;
    block->item = NULL;
    block->attribute = NULL;
    block->marker = NULL;
    block->count = 0;
}

/* realloc() for count × width items; false, and *array as it was, where memory is out. */
static bool resize(void **array, size_t count, size_t width, size_t size)
{
    if (width == 0)
        return true;
    if (count > PTRDIFF_MAX / size / width)
        return false;
    void *moved = realloc(*array, count * width * size + (count == 0));
    if (moved)
        *array = moved;
    return moved != NULL;
}

bool tm_block_resize(tm_block *block, size_t rows)
{
    const tm_block_shape *shape = &shapes[block->kind];
    void *real = block->real, *integer = block->integer, *start = block->start;
    void *attribute = block->attribute, *marker = block->marker;
    bool done = resize(&real, rows, shape->reals, sizeof *block->real) &&
                resize(&integer, rows, shape->integers, sizeof *block->integer) &&
                resize(&start, rows + 1, shape->list, sizeof *block->start) &&
                resize(&attribute, rows, block->attributes, sizeof *block->attribute) &&
                resize(&marker, rows, block->markers, sizeof *block->marker);
    block->real = real;
    block->integer = integer;
    block->start = start;
    block->attribute = attribute;
    block->marker = marker;
    return done;
}

/* Zeros for count × width items; NULL for width 0. */
static void *zeros(size_t count, size_t width, size_t size, bool *done)
{
    if (width == 0)
        return NULL;
    void *made = count <= PTRDIFF_MAX / size / width
                     ? calloc(count + (count == 0), width * size)
                     : NULL;
    *done &= made != NULL;
    return made;
}

tm_status tm_block_allocate(tm_block *block, size_t count, size_t items, tm_error *error)
{
    const tm_block_shape *shape = &shapes[block->kind];
    bool done = true;
    tm_block_clear(block);
    block->real = zeros(count, shape->reals, sizeof *block->real, &done);
    block->integer = zeros(count, shape->integers, sizeof *block->integer, &done);
    block->start = zeros(count + 1, shape->list, sizeof *block->start, &done);
    block->item = zeros(items, shape->list, sizeof *block->item, &done);
    block->attribute = zeros(count, block->attributes, sizeof *block->attribute, &done);
    block->marker = zeros(count, block->markers, sizeof *block->marker, &done);
    if (!done)
        return tm_fail_memory(error);
    block->count = count;
    return TM_OK;
}

tm_status tm_block_add_attribute(tm_block *block, const double *value, tm_error *error)
{
    const size_t width = block->attributes, wider = width + 1;
    double *attribute = tm_new(wider * block->count, sizeof *attribute);
    if (!attribute)
        return tm_fail_memory(error);
    for (size_t r = 0; r < block->count; r++) {
        for (size_t a = 0; a < width; a++)
            attribute[wider * r + a] = block->attribute[width * r + a];
        attribute[wider * r + width] = value[r];
    }
    free(block->attribute);
    block->attribute = attribute;
    block->attributes = wider;
    return TM_OK;
}

void tm_block_drop_attribute(tm_block *block, size_t which)
{
    const size_t width = block->attributes;
    double *to = block->attribute;
    for (size_t k = 0; k < block->count * width; k++)
        if (k % width != which)
            *to++ = block->attribute[k];
    block->attributes--;
    if (block->attributes == 0) {
        free(block->attribute);
        block->attribute = NULL;
    }
}
