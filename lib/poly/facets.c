/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "facets.h"

#include "../base/parallel.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>
#include <string.h>

/* So many tetrahedra are a thread's work at a time. */
enum { CORNERS = 3, CHUNK = 8192 };

/* The facets of a chunk of tetrahedra, in the order of their cells. */
typedef struct {
    size_t first, count, lost;
} chunk_facets;

typedef struct {
    const tm_partition *partition;
    const tm_tet_mesh *mesh;
    tm_block *facet;
    chunk_facets *of; /* [chunks] */
} maker;

/* Whether face i of t is a facet that its cell is the first of; *other is the second, or
 * TM_NONE. Counts kept faces inside of a cell. */
static bool is_facet(const maker *m, uint32_t t, uint32_t i, uint32_t *other,
                     size_t *lost)
{
    const uint32_t *cell = m->partition->cell;
    uint32_t n = m->mesh->neighbour[t][i];
    uint32_t across = n & TM_FACE_BIT ? tm_tet_across(m->mesh, t, i) : n;
    *other = across == TM_NONE ? TM_NONE : cell[across / 4];
    *lost += n & TM_FACE_BIT && *other == cell[t] && across / 4 > t;
    return *other == TM_NONE || cell[t] < *other;
}

static int32_t marker_of(const tm_tet_mesh *mesh, uint32_t t, uint32_t i)
{
    uint32_t n = mesh->neighbour[t][i];
    return n & TM_FACE_BIT ? mesh->face[n & ~TM_FACE_BIT].marker : 0;
}

static void count_facets(void *context, size_t from, size_t to)
{
    const maker *m = context;
    size_t count = 0, lost = 0;
    uint32_t other;
    for (size_t k = from; k < to; k++)
        for (uint32_t i = 0; i < 4; i++)
            count += is_facet(m, m->partition->order[k], i, &other, &lost);
    m->of[from / CHUNK] = (chunk_facets){.count = count, .lost = lost};
}

static void write_facet(const maker *m, size_t f, uint32_t t, uint32_t i, uint32_t other)
{
    tm_block *facet = m->facet;
    uint32_t below[CORNERS];
    tm_tet_face_below(m->mesh, t, i, below);
    facet->integer[2 * f] = m->partition->cell[t];
    facet->integer[2 * f + 1] = other;
    for (int c = 0; c < CORNERS; c++) /* seen from outside */
        facet->item[CORNERS * f + (size_t)c] = below[CORNERS - 1 - c];
    if (facet->markers)
        facet->marker[f] = marker_of(m->mesh, t, i);
    facet->start[f + 1] = CORNERS * (f + 1);
}

static void write_facets(void *context, size_t from, size_t to)
{
    const maker *m = context;
    size_t f = m->of[from / CHUNK].first, ignored = 0;
    uint32_t other;
    for (size_t k = from; k < to; k++)
        for (uint32_t i = 0; i < 4; i++)
            if (is_facet(m, m->partition->order[k], i, &other, &ignored))
                write_facet(m, f++, m->partition->order[k], i, other);
}

static tm_status make_facets(maker *m, size_t *lost, unsigned threads, tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(m->mesh->slots, CHUNK);
    size_t count = 0;
    m->of = calloc(chunks + 1, sizeof *m->of);
    if (!m->of)
        return tm_fail_memory(error);
    tm_parallel_runs(threads, m->mesh->slots, CHUNK, count_facets, m);
    for (size_t c = 0; c < chunks; c++) {
        m->of[c].first = count;
        count += m->of[c].count;
        *lost += m->of[c].lost;
    }
    tm_status status = tm_block_allocate(m->facet, count, CORNERS * count, error);
    if (status == TM_OK)
        tm_parallel_runs(threads, m->mesh->slots, CHUNK, write_facets, m);
    free(m->of);
    return status;
}

tm_status tm_cells_from_facets(const tm_block *facet, tm_block *cell, size_t cells,
                               tm_error *error)
{
    size_t items = 0;
    for (size_t f = 0; f < 2 * facet->count; f++)
        items += facet->integer[f] != TM_NONE;
    tm_status status = tm_block_allocate(cell, cells, items, error);
    if (status != TM_OK)
        return status;
    size_t *start = cell->start; /* of the cell before, until it is filled */
    for (size_t f = 0; f < 2 * facet->count; f++)
        if (facet->integer[f] != TM_NONE && facet->integer[f] + 2 <= cells)
            start[facet->integer[f] + 2]++;
    for (size_t c = 0; c + 2 <= cells; c++)
        start[c + 2] += start[c + 1];
    for (size_t f = 0; f < 2 * facet->count; f++)
        if (facet->integer[f] != TM_NONE)
            cell->item[start[facet->integer[f] + 1]++] = (uint32_t)(f / 2);
    return TM_OK;
}

void tm_cells_count_elements(tm_block *cell, const uint32_t *cell_of, size_t elements,
                             const double *attribute, size_t width)
{
    for (size_t e = 0; e < elements; e++) {
        double *row = cell->attribute + cell_of[e] * cell->attributes;
        if (row[0]++ == 0 && width > 0)
            memcpy(row + 1, attribute + e * width, width * sizeof *row);
    }
}

tm_status tm_partition_facets(const tm_partition *partition, const tm_tet_mesh *mesh,
                              tm_block *facet, tm_block *cell, size_t *lost,
                              unsigned threads, tm_error *error)
{
    maker m = {.partition = partition, .mesh = mesh, .facet = facet};
    *lost = 0;
    cell->attributes = 1 + mesh->regions;
    tm_status status = make_facets(&m, lost, threads, error);
    if (status == TM_OK)
        status = tm_cells_from_facets(facet, cell, partition->cells, error);
    if (status == TM_OK)
        tm_cells_count_elements(cell, partition->cell, mesh->slots, mesh->region,
                                mesh->regions);
    return status;
}
