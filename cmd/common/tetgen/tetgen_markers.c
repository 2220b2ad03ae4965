/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_markers.h"

#include "../../../lib/base/array.h"
#include "../input/mesh_input.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

static const char *const marked[] = {".face", ".node", ".edge"};
enum { MARKED = sizeof marked / sizeof *marked };

/* The markers of a stream, ascending, each once. */
static int32_t *collect(const filter *f, const tm_stream *stream, size_t *count)
{
    size_t rows = 0, found = 0;
    for (size_t b = 0; b < MARKED; b++)
        rows += mesh_rows(stream, marked[b]);
    int32_t *all = tm_new(rows, sizeof *all);
    if (!all)
        filter_fail_memory(f);
    for (size_t b = 0; b < MARKED; b++) {
        const tm_block *block = tm_stream_find(stream, marked[b]);
        for (size_t r = 0; block && block->markers && r < block->count; r++)
            all[found++] = block->marker[r];
    }
    if (found > 0)
        qsort(all, found, sizeof *all, compare);
    *count = 0;
    for (size_t k = 0; k < found; k++)
        if (*count == 0 || all[k] != all[*count - 1])
            all[(*count)++] = all[k];
    return all;
}

/* Each marker of the block that is in `from` becomes that in `to` at the same place. */
static void replace(tm_block *block, const int32_t *from, const int32_t *to, size_t count)
{
    for (size_t r = 0; block && block->markers && count > 0 && r < block->count; r++) {
        const int32_t *at =
            bsearch(&block->marker[r], from, count, sizeof *from, compare);
        if (at)
            block->marker[r] = to[at - from];
    }
}

void tetgen_hide_markers(const filter *f, tm_stream *tets, tetgen_aliases *aliases)
{
    size_t count, past = 0;
    int32_t *all = collect(f, tets, &count);
    while (past < count && all[past] < 0)
        past++;
    *aliases = (tetgen_aliases){past, all, tm_new(past, sizeof *all)};
    if (!aliases->alias)
        filter_fail_memory(f);
    int32_t alias = 1; /* which TetGen gives to edges */
    for (size_t k = 0, next = past; k < past; k++) {
        do {
            alias++;
            while (next < count && all[next] < alias)
                next++;
        } while (next < count && all[next] == alias);
        aliases->alias[k] = alias;
    }
    replace(tm_stream_find(tets, ".face"), aliases->marker, aliases->alias, past);
}

void tetgen_restore_markers(tm_stream *mesh, tetgen_aliases *aliases)
{
    for (size_t b = 0; b < MARKED; b++)
        replace(tm_stream_find(mesh, marked[b]), aliases->alias, aliases->marker,
                aliases->count);
    free(aliases->marker);
    free(aliases->alias);
    *aliases = (tetgen_aliases){0};
}
