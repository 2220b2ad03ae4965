/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stream.h"

#include "block.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void tm_stream_init(tm_stream *stream)
{
    *stream = (tm_stream){.base = 1};
}

void tm_stream_free(tm_stream *stream)
{
    for (size_t b = 0; b < stream->blocks; b++)
        tm_block_clear(&stream->block[b]);
    free(stream->block);
    tm_text_free(&stream->history);
    tm_stream_init(stream);
}

tm_block *tm_stream_find(const tm_stream *stream, const char *name)
{
    for (size_t b = 0; b < stream->blocks; b++)
        if (strcmp(stream->block[b].name, name) == 0)
            return &stream->block[b];
    return NULL;
}

tm_block *tm_stream_add(tm_stream *stream, const char *name)
{
    const size_t blocks = stream->blocks;
    if ((blocks & (blocks - 1)) == 0) { /* 0 or a power of 2: there may be no more room */
        tm_block *moved =
            realloc(stream->block, (blocks ? 2 * blocks : 1) * sizeof *stream->block);
        if (!moved)
            return NULL;
        stream->block = moved;
    }
    tm_block *block = &stream->block[stream->blocks++];
    *block = (tm_block){.kind = tm_block_kind_of(name)};
    block->markers = block->kind == TM_GROUP; /* its values */
    snprintf(block->name, sizeof block->name, "%s", name);
    return block;
}

tm_status tm_stream_put(tm_stream *stream, tm_block *made, tm_error *error)
{
    tm_block *to = tm_stream_find(stream, made->name);
    if (!to && !(to = tm_stream_add(stream, made->name)))
        return tm_fail_memory(error);
    const tm_block old = *to;
    *to = *made;
    *made = old;
    return TM_OK;
}

void tm_stream_remove(tm_stream *stream, tm_block *block)
{
    tm_block_clear(block);
    tm_block *end = stream->block + stream->blocks;
    memmove(block, block + 1, (size_t)(end - (block + 1)) * sizeof *block);
    stream->blocks--;
}

void tm_stream_remove_if(tm_stream *stream, tm_block_test *gone, const void *context)
{
    size_t stay = 0;
    for (size_t b = 0; b < stream->blocks; b++)
        if (gone(&stream->block[b], context))
            tm_block_clear(&stream->block[b]);
        else
            stream->block[stay++] = stream->block[b];
    stream->blocks = stay;
}

tm_status tm_stream_add_history(tm_stream *stream, const char *line, tm_error *error)
{
    tm_text *history = &stream->history;
    const size_t from = history->size;
    tm_text_format(history, "# %s\n", line);
    if (history->failed) {
        history->failed = false;
        return tm_fail_memory(error);
    }
    for (size_t i = from; i + 1 < history->size; i++)
        if (history->byte[i] == '\n' || history->byte[i] == '\r')
            history->byte[i] = ' ';
    return TM_OK;
}
