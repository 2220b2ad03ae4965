/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "facets.h"

#include "../tet/operation/ball.h"

#include <string.h>

enum { CORNERS = 3 };

typedef struct {
    const tm_partition *partition;
    const tm_tet_mesh *mesh;
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

static tm_status make_facets(const maker *m, tm_block *facet, size_t *lost,
                             tm_error *error)
{
    uint32_t other;
    size_t count = 0, f = 0, ignored = 0;
    for (size_t k = 0; k < m->mesh->slots; k++)
        for (uint32_t i = 0; i < 4; i++)
            count += is_facet(m, m->partition->order[k], i, &other, lost);
    tm_status status = tm_block_allocate(facet, count, CORNERS * count, error);
    for (size_t k = 0; k < m->mesh->slots && status == TM_OK; k++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t t = m->partition->order[k], below[3];
            if (!is_facet(m, t, i, &other, &ignored))
                continue;
            tm_tet_face_below(m->mesh, t, i, below);
            facet->integer[2 * f] = m->partition->cell[t];
            facet->integer[2 * f + 1] = other;
            for (int c = 0; c < CORNERS; c++) /* seen from outside */
                facet->item[CORNERS * f + (size_t)c] = below[CORNERS - 1 - c];
            if (facet->markers)
                facet->marker[f] = marker_of(m->mesh, t, i);
            f++;
            facet->start[f] = CORNERS * f;
        }
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
                              tm_error *error)
{
    maker m = {.partition = partition, .mesh = mesh};
    *lost = 0;
    cell->attributes = 1 + mesh->regions;
    tm_status status = make_facets(&m, facet, lost, error);
    if (status == TM_OK)
        status = tm_cells_from_facets(facet, cell, partition->cells, error);
    if (status == TM_OK)
        tm_cells_count_elements(cell, partition->cell, mesh->slots, mesh->region,
                                mesh->regions);
    return status;
}
