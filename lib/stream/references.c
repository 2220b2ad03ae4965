/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Indices from one block to another that may come later in the stream. */
#include "names.h"

#include "group_names.h"

#include <stdio.h>
#include <string.h>

/* The block of the same part with another suffix. */
static const tm_block *sibling(const tm_block_names *names, const tm_block *block,
                               const char *suffix)
{
    char name[TM_BLOCK_NAME + 8];
    int part = (int)(strrchr(block->name, '.') - block->name);
    snprintf(name, sizeof name, "%.*s%s", part, block->name, suffix);
    return tm_block_names_find(names, name);
}

static tm_status check_octants(const tm_block_names *names, const tm_block *block,
                               const char *file, tm_error *error)
{
    const tm_block *mix = sibling(names, block, ".mix");
    size_t limit = mix ? tm_block_names_rows(names, mix) : 0;
    const size_t width = tm_block_integers(block->kind);
    for (size_t o = 0; o < block->count; o++) {
        const uint32_t *octant = block->integer + o * width;
        uint32_t first = octant[width - 2], past = octant[width - 1];
        if (first > past || past > limit)
            return tm_fail_at(error, TM_ERROR_INPUT, file, 0, block->name,
                              "row %zu: elements %u…%u (of %zu in .mix)",
                              tm_block_names_number(names, block, o),
                              first + names->stream->base, past + names->stream->base,
                              limit);
    }
    return TM_OK;
}

/* The sides of facets are cells, or without .cell elements of .mix. */
static tm_status check_facets(const tm_block_names *names, const tm_block *block,
                              const char *file, tm_error *error)
{
    const tm_block *cell = sibling(names, block, ".cell");
    const char *what = cell ? "cell" : "element";
    if (!cell)
        cell = sibling(names, block, ".mix");
    const size_t cells = cell ? tm_block_names_rows(names, cell) : 0;
    for (size_t f = 0; cell && f < block->count; f++)
        for (size_t side = 0; side < 2; side++) {
            uint32_t c = block->integer[2 * f + side];
            if (c != TM_NONE && c >= cells)
                return tm_fail_at(error, TM_ERROR_INPUT, file, 0, block->name,
                                  "row %zu: %s %u is out of range (there are %zu)",
                                  tm_block_names_number(names, block, f), what,
                                  c + names->stream->base, cells);
        }
    return TM_OK;
}

static tm_status check_cells(const tm_block_names *names, const tm_block *block,
                             const char *file, tm_error *error)
{
    const tm_block *facet = sibling(names, block, ".facet");
    size_t limit = facet ? tm_block_names_rows(names, facet) : 0;
    for (size_t c = 0; c < block->count; c++)
        for (size_t i = block->start[c]; i < block->start[c + 1]; i++)
            if (block->item[i] >= limit)
                return tm_fail_at(error, TM_ERROR_INPUT, file, 0, block->name,
                                  "row %zu: facet %u is out of range (there are %zu)",
                                  tm_block_names_number(names, block, c),
                                  block->item[i] + names->stream->base, limit);
    return TM_OK;
}

tm_status tm_stream_check_references(const tm_block_names *names, const char *file,
                                     tm_error *error)
{
    const tm_stream *stream = names->stream;
    tm_status status = TM_OK;
    for (size_t b = 0; b < stream->blocks && status == TM_OK; b++) {
        const tm_block *block = &stream->block[b];
        if (block->kind == TM_OCTANT)
            status = check_octants(names, block, file, error);
        else if (block->kind == TM_FACET)
            status = check_facets(names, block, file, error);
        else if (block->kind == TM_CELL)
            status = check_cells(names, block, file, error);
        else if (block->kind == TM_GROUP)
            status = tm_group_check(block, stream->base, file, error);
    }
    return status;
}
