/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "row_chunks.h"

#include "../base/array.h"
#include "../base/parallel.h"

#include <stdlib.h>
#include <string.h>

typedef struct chunk {
    const char *at, *end;   /* whole lines; `at` goes on to what is not read */
    size_t lines;           /* that it has */
    size_t first, past;     /* its rows */
    tm_row_context context; /* of its own, and so is its block: */
    tm_block block;         /* the arrays of all but for `item` */
    size_t items;           /* of the chunks before it */
} chunk;

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

static void count_lines(void *context, size_t i)
{
    chunk *c = &((chunks *)context)->chunk[i];
    size_t lines = 0;
    for (const char *at = c->at; at < c->end; lines++)
        at = (const char *)memchr(at, '\n', (size_t)(c->end - at)) + 1;
    c->lines = lines;
}

/* Gives each chunk the rows that its lines are. */
static bool place(chunks *all, tm_row_context *context)
{
    size_t lines = 0, first = context->block->count;
    for (size_t i = 0; i < all->count; i++)
        lines += all->chunk[i].lines;
    if (!tm_row_reserve(context, lines))
        return false;
    for (size_t i = 0; i < all->count; i++) {
        chunk *c = &all->chunk[i];
        c->block = *context->block;
        c->block.count = c->first = first;
        c->block.item = NULL;
        c->context = *context;
        c->context.block = &c->block;
        c->context.items = c->context.item_room = 0;
        first = c->lines < context->rows - first ? first + c->lines : context->rows;
        c->past = first;
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
        whole = c->block.count == c->past && c->at == c->end;
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
    tm_parallel(threads, all.count, count_lines, &all);
    bool done = place(&all, context);
    if (done) {
        tm_parallel(threads, 1 + all.count, read_or_meanwhile, &all);
        *next = keep(&all, context);
        done = join(&all, context, threads);
    }
    free(all.chunk);
    return done;
}
