/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_grid.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../stream/group.h"

#include <stdlib.h>

/* Which parts there are ------------------------------------------------------------ */

/* The rows that may be marked: .facet belongs to elements or polyhedra, and a surface is
 * the content itself. */
static void find_parts(tm_vtk_grid *grid)
{
    static const char *const name[TM_VTK_PARTS] = {".face", ".facet", ".edge"};
    for (size_t p = 0; p < TM_VTK_PARTS; p++) {
        const tm_block *block = tm_stream_find(grid->stream, name[p]);
        const bool facets_of_none = p == 1 && grid->content != TM_CONTENT_MIXED &&
                                    grid->content != TM_CONTENT_POLYHEDRA;
        if (block && block->marker && block != grid->cell && !facets_of_none)
            grid->part[p] = block;
    }
}

static tm_status find_rows(tm_vtk_grid *grid, tm_error *error)
{
    size_t rows = 0;
    for (size_t p = 0; p < TM_VTK_PARTS; p++)
        for (size_t r = 0; grid->part[p] && r < grid->part[p]->count; r++)
            rows += grid->part[p]->marker[r] != 0;
    grid->row = tm_new(rows, sizeof *grid->row);
    grid->owner = tm_new(rows, sizeof *grid->owner);
    if (!grid->row || !grid->owner)
        return tm_fail_memory(error);
    for (size_t p = 0; p < TM_VTK_PARTS; p++) {
        for (size_t r = 0; grid->part[p] && r < grid->part[p]->count; r++)
            if (grid->part[p]->marker[r] != 0)
                grid->row[grid->marked++] = (uint32_t)r;
        grid->part_start[p + 1] = grid->marked;
    }
    return TM_OK;
}

/* Owners --------------------------------------------------------------------------- */

/* Of each node that is the first one of a marked cell, the rows that have it:
 * row[start[v]] … row[start[v + 1] - 1], in order. They are those of the cells, or of
 * .facet for polyhedra. */
typedef struct rows_at {
    const tm_block *block;
    unsigned char *is_first; /* [nodes] */
    size_t *start;           /* [nodes + 1] */
    uint32_t *row;
} rows_at;

static void count_rows(rows_at *at, size_t nodes)
{
    for (size_t r = 0, k; r < at->block->count; r++) {
        const uint32_t *node = tm_row_nodes(at->block, r, &k);
        for (size_t i = 0; i < k; i++)
            at->start[node[i]] += at->is_first[node[i]];
    }
    for (size_t v = 0; v < nodes; v++)
        at->start[v + 1] += at->start[v];
}

/* From the end of each list, which start[v] is after counting, to its beginning. */
static void fill_rows(rows_at *at)
{
    for (size_t r = at->block->count; r-- > 0;) {
        size_t k;
        const uint32_t *node = tm_row_nodes(at->block, r, &k);
        for (size_t i = 0; i < k; i++)
            if (at->is_first[node[i]])
                at->row[--at->start[node[i]]] = (uint32_t)r;
    }
}

static tm_status find_rows_at(rows_at *at, const tm_vtk_grid *grid, tm_error *error)
{
    const size_t nodes = grid->node->count;
    at->start = calloc(nodes + 1, sizeof *at->start);
    at->is_first = calloc(nodes + 1, 1);
    if (!at->start || !at->is_first)
        return tm_fail_memory(error);
    for (size_t i = 0, k; i < grid->marked; i++)
        at->is_first[*tm_vtk_marked_nodes(grid, i, &k)] = 1;
    count_rows(at, nodes);
    at->row = tm_new(at->start[nodes], sizeof *at->row);
    if (!at->row)
        return tm_fail_memory(error);
    fill_rows(at);
    return TM_OK;
}

static uint32_t owner_of(const rows_at *at, const uint32_t *wanted, size_t count)
{
    for (size_t i = at->start[*wanted]; i < at->start[*wanted + 1]; i++) {
        const uint32_t r = at->row[i];
        size_t k;
        const uint32_t *node = tm_row_nodes(at->block, r, &k);
        if (tm_vtk_has_all(node, k, wanted, count))
            return at->block->kind == TM_FACET ? at->block->integer[2 * r] : r;
    }
    return TM_NONE;
}

static tm_status find_owners(tm_vtk_grid *grid, tm_error *error)
{
    rows_at at = {.block = grid->cell};
    if (grid->content == TM_CONTENT_POLYHEDRA)
        at.block = tm_stream_find(grid->stream, ".facet");
    for (size_t i = 0; i < grid->marked; i++)
        grid->owner[i] = TM_NONE;
    if (grid->marked == 0 || grid->content == TM_CONTENT_POINTS)
        return TM_OK;
    const tm_status status = find_rows_at(&at, grid, error);
    for (size_t i = 0; i < grid->marked && status == TM_OK; i++) {
        size_t k;
        const uint32_t *node = tm_vtk_marked_nodes(grid, i, &k);
        grid->owner[i] = owner_of(&at, node, k);
    }
    free(at.is_first);
    free(at.start);
    free(at.row);
    return status;
}

/* ---------------------------------------------------------------------------------- */

tm_status tm_vtk_grid_find(tm_vtk_grid *grid, const tm_stream *stream,
                           const tm_vtk_options *options, unsigned threads,
                           tm_error *error)
{
    *grid = (tm_vtk_grid){.stream = stream,
                          .options = *options,
                          .threads = threads,
                          .node = tm_stream_find(stream, ".node"),
                          .content = tm_content_of(stream)};
    if (grid->content == TM_CONTENT_NOTHING)
        return tm_fail(error, TM_ERROR_INPUT, "has no nodes (.node)");
    grid->cell = tm_content_block(stream, grid->content);
    grid->group = options->names ? tm_stream_find(stream, ".group") : NULL;
    tm_status status = TM_OK;
    if (grid->content == TM_CONTENT_POLYHEDRA)
        status = tm_cell_faces_find(&grid->faces, stream, error);
    if (!options->boundary || status != TM_OK)
        return status;
    find_parts(grid);
    status = find_rows(grid, error);
    return status == TM_OK ? find_owners(grid, error) : status;
}

void tm_vtk_grid_free(tm_vtk_grid *grid)
{
    tm_cell_faces_free(&grid->faces);
    free(grid->row);
    free(grid->owner);
}

uint8_t tm_vtk_type(const tm_vtk_grid *grid, size_t c)
{
    static const uint8_t polygon[] = {
        [2] = TM_VTK_LINE, [3] = TM_VTK_TRIANGLE, [4] = TM_VTK_QUADRILATERAL};
    size_t k = 1;
    if (c >= grid->cell->count) {
        tm_vtk_marked_nodes(grid, c - grid->cell->count, &k);
        return k < sizeof polygon ? polygon[k] : (uint8_t)TM_VTK_POLYGON;
    }
    if (grid->content == TM_CONTENT_POLYHEDRA)
        return TM_VTK_POLYHEDRON;
    if (grid->content != TM_CONTENT_POINTS)
        tm_row_nodes(grid->cell, c, &k);
    return tm_vtk_cell_type(k);
}

void tm_vtk_name(const tm_vtk_grid *grid, size_t g, tm_text *text)
{
    tm_text_format(text, "%d %d %s", (int)tm_group_dimension_of(grid->group, g),
                   (int)tm_group_value(grid->group, g), tm_group_name(grid->group, g));
}
