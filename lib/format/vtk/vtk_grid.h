/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cells of an unstructured grid, and what is known of them: what both of VTK's
 * formats write. */
#ifndef TM_FORMAT_VTK_GRID_H
#define TM_FORMAT_VTK_GRID_H

#include "../../mesh/cell_faces.h"
#include "../text_rows.h"
#include "vtk.h"

enum { TM_VTK_PARTS = 3, TM_VTK_NAME = 32 };

/* First the cells of the content, then the marked ones. */
typedef struct tm_vtk_grid {
    const tm_stream *stream;
    tm_vtk_options options;
    unsigned threads;
    const tm_block *node;
    const tm_block *group; /* or NULL */
    const tm_block *cell;  /* the block of the content; .node for points */
    tm_content content;
    tm_cell_faces faces;                 /* of polyhedra */
    size_t marked;                       /* cells after those */
    const tm_block *part[TM_VTK_PARTS];  /* .face, .facet, .edge; NULL: none is marked */
    size_t part_start[TM_VTK_PARTS + 1]; /* the marked cells of part p are */
    uint32_t *row;   /* row[part_start[p] … part_start[p + 1] - 1], rows of its block */
    uint32_t *owner; /* [marked]: a cell that has all its nodes; TM_NONE */
} tm_vtk_grid;

/* Finds the cells of a stream, which must outlive the grid. TM_ERROR_INPUT without nodes,
 * or as tm_cell_faces_find() for polyhedra; TM_ERROR_SYSTEM where memory is out. The grid
 * is to be freed, after an error too. O(n). */
tm_status tm_vtk_grid_find(tm_vtk_grid *grid, const tm_stream *stream,
                           const tm_vtk_options *options, unsigned threads,
                           tm_error *error);
void tm_vtk_grid_free(tm_vtk_grid *grid);

static inline size_t tm_vtk_cell_count(const tm_vtk_grid *grid)
{
    return grid->cell->count + grid->marked;
}

/* The part of marked cell i, from 0. */
static inline size_t tm_vtk_part(const tm_vtk_grid *grid, size_t i)
{
    size_t p = 0;
    while (i >= grid->part_start[p + 1])
        p++;
    return p;
}

/* The nodes of marked cell i, and how many. */
static inline const uint32_t *tm_vtk_marked_nodes(const tm_vtk_grid *grid, size_t i,
                                                  size_t *k)
{
    return tm_row_nodes(grid->part[tm_vtk_part(grid, i)], grid->row[i], k);
}

/* Whether all of `wanted` are among the k nodes. */
static inline bool tm_vtk_has_all(const uint32_t *node, size_t k, const uint32_t *wanted,
                                  size_t count)
{
    for (size_t i = 0; i < count; i++) {
        size_t j = 0;
        while (j < k && node[j] != wanted[i])
            j++;
        if (j == k)
            return false;
    }
    return true;
}

/* VTK's number of cell c. */
uint8_t tm_vtk_type(const tm_vtk_grid *grid, size_t c);

/* The rows of .group; 0 where there are no names. */
static inline size_t tm_vtk_names(const tm_vtk_grid *grid)
{
    return grid->group ? grid->group->count : 0;
}

/* Appends row g of .group to a text: "2 3 inlet". */
void tm_vtk_name(const tm_vtk_grid *grid, size_t g, tm_text *text);

/* A value for each point or cell: real or integer is NULL. */
typedef struct tm_vtk_column {
    char name[TM_VTK_NAME];
    size_t count;
    double *real;
    int32_t *integer;
} tm_vtk_column;

/* Takes a column, which is freed afterwards. */
typedef tm_status tm_vtk_take(void *context, const tm_vtk_column *column);

/* All columns one after the other, until one is refused; of points, and of cells. */
tm_status tm_vtk_point_data(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                            tm_error *error);
tm_status tm_vtk_cell_data(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                           tm_error *error);

/* A column for all cells, of reals or of integers; false where memory is out. */
bool tm_vtk_column_new(tm_vtk_column *column, const char *name, size_t count,
                       bool integers);

/* Gives marked cells the values of their owners, or `none`, then takes the column, if
 * status is TM_OK, and frees it. Returns what became of it. */
tm_status tm_vtk_finish(const tm_vtk_grid *grid, tm_vtk_column *column, int none,
                        tm_status status, tm_vtk_take *take, void *context);

/* vtk_quality.c: the columns of quality of cells, where they are wanted. */
tm_status tm_vtk_quality(const tm_vtk_grid *grid, tm_vtk_take *take, void *context,
                         tm_error *error);

#endif
