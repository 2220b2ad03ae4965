/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "node_rows.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../stream/stream.h"

#include <stdlib.h>

/* Bits of a word; and as many parts for each thread, so that none waits long. */
enum { PARTS_MOST = 64, PARTS_PER_THREAD = 4 };

static void find_met(void *context, size_t first, size_t past)
{
    const tm_node_rows *r = context;
    uint64_t met = 0;
    for (size_t i = r->mesh->start[first]; i < r->mesh->start[past]; i++) {
        const uint32_t row = r->row[r->mesh->item[i]];
        if (row != TM_NONE)
            met |= (uint64_t)1 << (row >> r->shift);
    }
    r->met[first / TM_CHUNK] = met;
}

tm_status tm_node_rows_find(tm_node_rows *rows, const tm_mixed_mesh *mesh,
                            const uint32_t *row, size_t count, tm_error *error)
{
    const unsigned threads = mesh->threads;
    size_t parts = threads > 1 ? (size_t)threads * PARTS_PER_THREAD : 1;
    parts = parts < PARTS_MOST ? parts : PARTS_MOST;
    *rows = (tm_node_rows){.mesh = mesh, .row = row, .rows = count};
    while (count > 0 && (count - 1) >> rows->shift >= parts)
        rows->shift++;
    rows->met = tm_new(tm_parallel_chunks(mesh->elements, TM_CHUNK), sizeof *rows->met);
    if (!rows->met)
        return tm_fail_memory(error);
    tm_parallel_runs(threads, mesh->elements, TM_CHUNK, find_met, rows);
    return TM_OK;
}

void tm_node_rows_free(tm_node_rows *rows)
{
    free(rows->met);
    *rows = (tm_node_rows){0};
}

typedef struct visiting {
    const tm_node_rows *rows;
    void (*visit)(void *context, size_t e, tm_row_range range);
    void *context;
} visiting;

static bool has_row_in(const tm_node_rows *r, size_t e, tm_row_range range)
{
    for (size_t i = r->mesh->start[e]; i < r->mesh->start[e + 1]; i++)
        if (tm_row_is_in(range, r->row[r->mesh->item[i]]))
            return true;
    return false;
}

static void visit_part(void *context, size_t first, size_t past)
{
    const visiting *v = context;
    const tm_node_rows *r = v->rows;
    const tm_row_range range = {(uint32_t)first, (uint32_t)past};
    const size_t chunks = tm_parallel_chunks(r->mesh->elements, TM_CHUNK);
    for (size_t c = 0; c < chunks; c++) {
        if (!(r->met[c] >> (first >> r->shift) & 1))
            continue;
        const size_t end = (c + 1) * TM_CHUNK;
        for (size_t e = c * TM_CHUNK; e < end && e < r->mesh->elements; e++)
            if (has_row_in(r, e, range))
                v->visit(v->context, e, range);
    }
}

void tm_node_rows_visit(const tm_node_rows *rows,
                        void (*visit)(void *context, size_t e, tm_row_range range),
                        void *context)
{
    visiting v = {rows, visit, context};
    tm_parallel_runs(rows->mesh->threads, rows->rows, (size_t)1 << rows->shift,
                     visit_part, &v);
}
