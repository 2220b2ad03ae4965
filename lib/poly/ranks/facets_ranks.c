/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../ranks/post.h"
#include "../../tet/operation/ball.h"

#include <stdlib.h>
#include <string.h>

/* A facet as it is sent: its cells, nodes and marker. */
enum { CELL, OTHER, NODES, MARKER = NODES + 3, WORDS };

typedef struct making {
    const tm_sorted_tets *sorted;
    const tm_poly_tets *share;
    const uint32_t *cell; /* [share->mesh.slots] */
    tm_rows cells;
    size_t lost;
} making;

/* Sends the facets that a tetrahedron gives its cell, if that is the first one. */
static void send_facets_of(making *m, tm_post *post, uint32_t t)
{
    const tm_tet_mesh *mesh = &m->share->mesh;
    for (uint32_t i = 0; i < 4; i++) {
        const uint32_t n = mesh->neighbour[t][i], across = tm_tet_across(mesh, t, i);
        const uint32_t other = across == TM_NONE ? TM_NONE : m->cell[across / 4];
        const bool kept = n & TM_FACE_BIT;
        m->lost += kept && other == m->cell[t] && across / 4 > t;
        if (other != TM_NONE && m->cell[t] >= other)
            continue;
        uint32_t letter[WORDS] = {m->cell[t], other}, below[3];
        tm_tet_face_below(mesh, t, i, below);
        for (size_t c = 0; c < 3; c++) /* seen from outside */
            letter[NODES + c] = m->share->node[below[2 - c]];
        if (kept)
            letter[MARKER] = (uint32_t)mesh->face[n & ~TM_FACE_BIT].marker;
        tm_post_put(post, tm_rows_owner(&m->cells, m->cell[t]), letter, WORDS);
    }
}

/* The places of items in the order of their cells, which are this rank's, and otherwise
 * as they came: start[rows->count + 1] is where those of a cell begin. */
static bool order_by_cell(const tm_rows *rows, const uint32_t *item, size_t words,
                          size_t items, size_t **start, uint32_t **order)
{
    *start = calloc(rows->count + 2, sizeof **start);
    *order = tm_new(items, sizeof **order);
    if (!*start || !*order)
        return false;
    size_t *next = *start + 1;
    for (size_t i = 0; i < items; i++)
        next[item[i * words] - rows->first + 1]++;
    for (size_t c = 0; c < rows->count; c++)
        next[c + 1] += next[c];
    for (size_t i = 0; i < items; i++)
        (*order)[next[item[i * words] - rows->first]++] = (uint32_t)i;
    return true;
}

/* Fills .facet by the facets of this rank's cells. */
static tm_status fill_facets(const tm_rows *cells, const uint32_t *item, size_t items,
                             tm_block *facet, tm_error *error)
{
    size_t *start;
    uint32_t *order;
    const bool enough = order_by_cell(cells, item, WORDS, items, &start, &order);
    tm_status status = tm_ranks_enough(enough, error);
    if (status == TM_OK)
        status = tm_ranks_agree(tm_block_allocate(facet, items, 3 * items, error), error);
    for (size_t f = 0; status == TM_OK && f < items; f++) {
        const uint32_t *from = item + order[f] * WORDS;
        memcpy(facet->integer + 2 * f, from, 2 * sizeof *from);
        memcpy(facet->item + 3 * f, from + NODES, 3 * sizeof *from);
        facet->start[f + 1] = 3 * (f + 1);
        if (facet->markers)
            facet->marker[f] = (int32_t)from[MARKER];
    }
    free(start);
    free(order);
    return status;
}

/* Tells cells their facets; those of a cell come in ascending order. */
static tm_status fill_cells(const tm_rows *cells, const tm_block *facet, size_t before,
                            tm_block *cell, tm_error *error)
{
    tm_post post = {0};
    uint32_t *got = NULL, *order = NULL;
    size_t *start = NULL, count = 0;
    for (size_t f = 0; f < facet->count; f++)
        for (size_t s = 0; s < 2; s++) {
            const uint32_t c = facet->integer[2 * f + s];
            if (c != TM_NONE)
                tm_post_put(&post, tm_rows_owner(cells, c),
                            (const uint32_t[]){c, (uint32_t)(before + f)}, 2);
        }
    tm_status status = tm_post_deliver(&post, &got, &count, error);
    count /= 2;
    if (status == TM_OK)
        status =
            tm_ranks_enough(order_by_cell(cells, got, 2, count, &start, &order), error);
    if (status == TM_OK)
        status =
            tm_ranks_agree(tm_block_allocate(cell, cells->count, count, error), error);
    if (status == TM_OK)
        memcpy(cell->start, start, (cells->count + 1) * sizeof *start);
    for (size_t i = 0; status == TM_OK && i < count; i++)
        cell->item[i] = got[2 * (size_t)order[i] + 1];
    free(got);
    free(start);
    free(order);
    return status;
}

/* Tells cells how many tetrahedra they have, and the first one's attributes. */
static tm_status count_tets(const tm_rank_cells *cells, const tm_sorted_tets *s,
                            const tm_rows *rows, tm_block *cell, tm_error *error)
{
    enum { HEAD = 2 };
    const size_t width = s->words - 4, words = HEAD + width;
    uint32_t *letter = calloc(words, sizeof *letter), *got = NULL;
    size_t count = 0;
    tm_post post = {.failed = !letter};
    for (size_t t = 0; letter && t < s->rows.count; t++) {
        letter[0] = cells->cell[t];
        letter[1] = cells->first[t];
        memcpy(letter + HEAD, s->record + t * s->words + 4, width * sizeof *letter);
        tm_post_put(&post, tm_rows_owner(rows, letter[0]), letter, words);
    }
    const tm_status status = tm_post_deliver(&post, &got, &count, error);
    for (size_t i = 0; status == TM_OK && i < count; i += words) {
        double *row = cell->attribute + (got[i] - rows->first) * cell->attributes;
        row[0]++;
        if (got[i + 1])
            memcpy(row + 1, got + i + HEAD, width * sizeof *got);
    }
    free(letter);
    free(got);
    return status;
}

tm_status tm_rank_facets(const tm_rank_cells *cells, const tm_sorted_tets *sorted,
                         const tm_tet_slices *slices, const tm_poly_tets *share,
                         tm_block *facet, tm_block *cell, size_t *before, size_t *facets,
                         size_t *lost, tm_error *error)
{
    uint32_t *cell_of = NULL, *got = NULL;
    size_t count = 0;
    tm_post post = {0};
    making m = {.sorted = sorted, .share = share, .cells = tm_rows_of(cells->cells)};
    tm_status status = tm_ranks_fetch(&sorted->rows, cells->cell, sizeof *cells->cell,
                                      &share->tet, (void **)&cell_of, error);
    m.cell = cell_of;
    const uint32_t own = tm_number_set_below(&share->tet, (uint32_t)sorted->rows.first);
    for (uint32_t t = 0; status == TM_OK && t < sorted->rows.count; t++)
        send_facets_of(&m, &post, own + t);
    free(cell_of);
    if (status == TM_OK)
        status = tm_post_deliver(&post, &got, &count, error);
    if (status == TM_OK)
        status = fill_facets(&m.cells, got, count / WORDS, facet, error);
    free(got);
    *lost = m.lost;
    tm_ranks_sum(lost, 1);
    if (status != TM_OK)
        return status;
    *before = tm_ranks_before(facet->count, facets);
    cell->attributes = 1 + slices->width;
    status = fill_cells(&m.cells, facet, *before, cell, error);
    return status == TM_OK ? count_tets(cells, sorted, &m.cells, cell, error) : status;
}
