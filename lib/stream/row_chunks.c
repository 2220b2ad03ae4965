/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "row_chunks.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../number/number.h"

#include <stdlib.h>
#include <string.h>

typedef struct chunk {
    const char *at, *end;   /* whole lines; `at` goes on to what is not read */
    size_t first, past;     /* its rows */
    tm_row_context context; /* of its own, and so is its block: */
    tm_block block;         /* the arrays of all but for `item` */
    size_t items;           /* of the chunks before it */
} chunk;

/* A row has so many bytes at least: "1 2\n". */
enum { LEAST_ROW = 4 };

typedef struct chunks {
    chunk *chunk;
    size_t count;
    tm_meanwhile *meanwhile;
    void *with;
    uint32_t *item; /* of all, where the chunks' own are copied to */
} chunks;

/* Cuts the lines into chunks of about TM_CHUNK_BYTES. */
static void cut(chunks *all, const char *at, const char *end)
{
    while (at < end) {
        const char *past = end;
        if (end - at > TM_CHUNK_BYTES)
            past = (const char *)memchr(at + TM_CHUNK_BYTES - 1, '\n',
                                        (size_t)(end - at) - (TM_CHUNK_BYTES - 1)) +
                   1;
        all->chunk[all->count++] = (chunk){.at = at, .end = past};
        at = past;
    }
}

/* The row that the first line of a chunk says that it is, or one that there cannot be. */
static size_t row_said(const chunk *c, const tm_row_context *context)
{
    int64_t number;
    const size_t first = context->before + context->base;
    if (!tm_read_int64(c->at, c->end, &number) || number < (int64_t)first)
        return SIZE_MAX;
    return (size_t)number - first;
}

/* Gives each chunk the rows up to that which the next one begins with, the last one as
 * many as it can have. They do not overlap, and are no more than a chunk has bytes: what
 * says otherwise is left out with all behind it. */
static void place(chunks *all, const tm_row_context *context)
{
    all->chunk[0].first = context->block->count;
    for (size_t i = 1; i < all->count; i++) {
        chunk *before = &all->chunk[i - 1];
        const size_t row = row_said(&all->chunk[i], context);
        if (row >= context->rows || row <= before->first ||
            row - before->first > (size_t)(before->end - before->at)) {
            all->count = i;
            break;
        }
        all->chunk[i].first = before->past = row;
    }
    chunk *last = &all->chunk[all->count - 1];
    const size_t most = (size_t)(last->end - last->at) / LEAST_ROW;
    const size_t left = context->rows - last->first;
    last->past = last->first + (most < left ? most : left);
}

/* Room for all rows, and a block for each chunk. */
static bool begin_chunks(chunks *all, tm_row_context *context)
{
    const tm_block *block = context->block;
    if (!tm_row_reserve(context, all->chunk[all->count - 1].past - block->count))
        return false;
    for (size_t i = 0; i < all->count; i++) {
        chunk *c = &all->chunk[i];
        c->block = *block;
        c->block.count = c->first;
        c->block.item = NULL;
        c->context = *context;
        c->context.block = &c->block;
        c->context.items = c->context.item_room = 0;
    }
    return true;
}

static void read_rows(chunk *c)
{
    tm_block *block = &c->block;
    while (block->count < c->past && c->at < c->end) {
        const size_t before = block->count;
        c->at = tm_row_read_plain(&c->context, c->at, c->end, c->past);
        if (block->count > before)
            continue;
        const char *after = tm_row_read(&c->context, c->at, c->end);
        if (!after)
            return;
        c->at = after;
        block->count++;
    }
}

static void read_or_meanwhile(void *context, size_t i)
{
    chunks *all = context;
    if (i > 0)
        read_rows(&all->chunk[i - 1]);
    else
        all->meanwhile(all->with);
}

/* Keeps the chunks up to the first that was not read to its end: others are none. */
static const char *keep(chunks *all, tm_row_context *context)
{
    const char *next = all->chunk[0].at;
    bool whole = true;
    for (size_t i = 0; i < all->count; i++) {
        chunk *c = &all->chunk[i];
        if (!whole) {
            c->context.items = 0;
            continue;
        }
        c->items = context->items;
        context->items += c->context.items;
        context->block->count = c->block.count;
        next = c->at;
        whole = c->at == c->end && (c->block.count == c->past || i + 1 == all->count);
    }
    return next;
}

/* Puts a chunk's lists behind those of the chunks before it. */
static void join_lists(void *context, size_t i)
{
    const chunks *all = context;
    const chunk *c = &all->chunk[i];
    if (c->context.items == 0)
        return;
    memcpy(all->item + c->items, c->block.item, c->context.items * sizeof *all->item);
    for (size_t row = c->first; row < c->block.count; row++)
        c->block.start[row + 1] += c->items;
}

/* Joins the lists of the chunks that were kept; frees those of all. */
static bool join(chunks *all, tm_row_context *context, unsigned threads)
{
    tm_block *block = context->block;
    bool done = true;
    if (context->shape->list) {
        all->item = tm_grow(block->item, &context->item_room, context->items,
                            sizeof *block->item);
        done = all->item;
        block->item = done ? all->item : block->item;
    }
    if (done && context->shape->list)
        tm_parallel(threads, all->count, join_lists, all);
    for (size_t i = 0; i < all->count; i++)
        free(all->chunk[i].block.item);
    return done;
}

bool tm_row_chunks_read(tm_row_context *context, const char *at, const char *end,
                        unsigned threads, tm_meanwhile *meanwhile, void *with,
                        const char **next)
{
    chunks all = {.meanwhile = meanwhile, .with = with};
    const size_t room = (size_t)(end - at) / TM_CHUNK_BYTES + 1;
    all.chunk = tm_new(room, sizeof *all.chunk);
    if (!all.chunk)
        return false;
    cut(&all, at, end);
    place(&all, context);
    bool done = begin_chunks(&all, context);
    if (done) {
        tm_parallel(threads, 1 + all.count, read_or_meanwhile, &all);
        *next = keep(&all, context);
        done = join(&all, context, threads);
    }
    free(all.chunk);
    return done;
}
