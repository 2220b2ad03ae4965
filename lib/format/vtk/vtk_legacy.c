/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_grid.h"

#include <string.h>

enum { DELETE = 127 };

static void append_rows(const tm_vtk_grid *grid, tm_text *text, const void *context,
                        size_t count, size_t (*room)(const void *, size_t, size_t),
                        char *(*put)(const void *, size_t, char *))
{
    const tm_text_rows rows = {context, count, room, put};
    tm_text_append_rows(text, &rows, grid->threads);
}

/* Cells ---------------------------------------------------------------------------- */

/* How many numbers the cells first … past - 1 of the content are, with the one before
 * each that says how many follow. */
static size_t count_of_content(const tm_vtk_grid *grid, size_t first, size_t past)
{
    if (grid->content == TM_CONTENT_POINTS)
        return 2 * (past - first);
    if (grid->content == TM_CONTENT_POLYHEDRA) {
        const tm_cell_faces *faces = &grid->faces;
        size_t numbers = 2 * (past - first);
        for (size_t i = faces->cell_start[first]; i < faces->cell_start[past]; i++) {
            size_t f = faces->cell_facet[i];
            numbers += 1 + faces->start[f + 1] - faces->start[f];
        }
        return numbers;
    }
    if (grid->cell->start)
        return grid->cell->start[past] - grid->cell->start[first] + past - first;
    return (past - first) * (1 + tm_block_integers(grid->cell->kind));
}

/* The same of any cells. */
static size_t count_numbers(const tm_vtk_grid *grid, size_t first, size_t past)
{
    const size_t cells = grid->cell->count;
    size_t numbers = 0, k;
    if (first < cells)
        numbers = count_of_content(grid, first, past < cells ? past : cells);
    for (size_t c = first < cells ? cells : first; c < past; c++) {
        tm_vtk_marked_nodes(grid, c - cells, &k);
        numbers += 1 + k;
    }
    return numbers;
}

static size_t cell_room(const void *context, size_t first, size_t past)
{
    return (count_numbers(context, first, past) + past - first) * TM_NUMBER_ROOM;
}

/* The faces of a polyhedron, all outward. */
static char *put_polyhedron(const tm_vtk_grid *grid, size_t c, char *to)
{
    const tm_cell_faces *faces = &grid->faces;
    size_t begin = faces->cell_start[c], end = faces->cell_start[c + 1];
    to = tm_write_int64(to, (int64_t)count_of_content(grid, c, c + 1) - 1);
    to = tm_put_number(to, (uint32_t)(end - begin));
    for (size_t i = begin; i < end; i++) {
        size_t f = faces->cell_facet[i], k = faces->start[f + 1] - faces->start[f];
        const uint32_t *node = faces->node + faces->start[f];
        bool outward = tm_facet_is_outward(faces, f, c);
        to = tm_put_number(to, (uint32_t)k);
        for (size_t j = 0; j < k; j++)
            to = tm_put_number(to, node[outward ? j : k - 1 - j]);
    }
    return to;
}

static char *put_cell(const void *context, size_t c, char *to)
{
    const tm_vtk_grid *grid = context;
    const size_t cells = grid->cell->count;
    const uint32_t vertex = (uint32_t)c, *node = &vertex;
    size_t k = 1;
    if (c >= cells)
        node = tm_vtk_marked_nodes(grid, c - cells, &k);
    else if (grid->content != TM_CONTENT_POINTS && grid->content != TM_CONTENT_POLYHEDRA)
        node = tm_row_nodes(grid->cell, c, &k);
    if (c < cells && grid->content == TM_CONTENT_POLYHEDRA) {
        to = put_polyhedron(grid, c, to);
    } else {
        to = tm_write_uint32(to, (uint32_t)k);
        for (size_t i = 0; i < k; i++)
            to = tm_put_number(to, node[i]);
    }
    *to++ = '\n';
    return to;
}

static size_t type_room(const void *context, size_t first, size_t past)
{
    enum { DIGITS = 2 };
    (void)context;
    return (past - first) * (DIGITS + 1);
}

static char *put_type(const void *context, size_t c, char *to)
{
    to = tm_write_uint32(to, tm_vtk_type(context, c));
    *to++ = '\n';
    return to;
}

static void append_cells(const tm_vtk_grid *grid, tm_text *text)
{
    const size_t cells = tm_vtk_cell_count(grid);
    tm_text_format(text, "CELLS %zu %zu\n", cells, count_numbers(grid, 0, cells));
    append_rows(grid, text, grid, cells, cell_room, put_cell);
    tm_text_format(text, "CELL_TYPES %zu\n", cells);
    append_rows(grid, text, grid, cells, type_room, put_type);
}

/* Data ----------------------------------------------------------------------------- */

typedef struct data_writer {
    const tm_vtk_grid *grid;
    tm_text *text;
    const char *heading; /* NULL: it is there */
} data_writer;

static size_t value_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * TM_NUMBER_ROOM;
}

static char *put_value(const void *context, size_t row, char *to)
{
    const tm_vtk_column *column = context;
    to = column->real ? tm_write_double(to, column->real[row])
                      : tm_write_int64(to, column->integer[row]);
    *to++ = '\n';
    return to;
}

static tm_status append_column(void *context, const tm_vtk_column *column)
{
    data_writer *w = context;
    if (w->heading)
        tm_text_format(w->text, "%s %zu\n", w->heading, column->count);
    w->heading = NULL;
    tm_text_format(w->text, "SCALARS %s %s 1\nLOOKUP_TABLE default\n", column->name,
                   column->real ? "double" : "int");
    append_rows(w->grid, w->text, column, column->count, value_room, put_value);
    return TM_OK;
}

/* Each name is a line, in which bytes that are no letters, digits or the like are %XX, as
 * vtkDataWriter has them. */
static void append_names(const tm_vtk_grid *grid, tm_text *text)
{
    const size_t names = tm_vtk_names(grid);
    tm_text name = {0};
    if (names > 0)
        tm_text_format(text, "FIELD FieldData 1\ngroup_names 1 %zu string\n", names);
    for (size_t g = 0; g < names; g++) {
        name.size = 0;
        tm_vtk_name(grid, g, &name);
        for (size_t i = 0; i < name.size; i++) {
            const unsigned char byte = (unsigned char)name.byte[i];
            const bool plain = byte > ' ' && byte < DELETE && !strchr("\"%", byte);
            tm_text_format(text, plain ? "%c" : "%%%02X", byte);
        }
        tm_text_string(text, "\n");
    }
    text->failed |= name.failed;
    tm_text_free(&name);
}

static tm_status append_grid(const tm_vtk_grid *grid, tm_text *text, tm_error *error)
{
    data_writer cells = {grid, text, "CELL_DATA"}, points = {grid, text, "POINT_DATA"};
    tm_text_format(text, "# vtk DataFile Version 3.0\ntermesh\nASCII\n"
                         "DATASET UNSTRUCTURED_GRID\n");
    append_names(grid, text);
    tm_text_format(text, "POINTS %zu double\n", grid->node->count);
    tm_text_append_points(text, grid->node->real, grid->node->count, "", grid->threads);
    append_cells(grid, text);
    tm_status status = tm_vtk_cell_data(grid, append_column, &cells, error);
    if (status == TM_OK)
        status = tm_vtk_quality(grid, append_column, &cells, error);
    if (status == TM_OK)
        status = tm_vtk_point_data(grid, append_column, &points, error);
    return status == TM_OK && text->failed ? tm_fail_memory(error) : status;
}

tm_status tm_vtk_write(tm_text *text, const tm_stream *stream,
                       const tm_vtk_options *options, unsigned threads, tm_error *error)
{
    tm_vtk_grid grid;
    tm_status status = tm_vtk_grid_find(&grid, stream, options, threads, error);
    if (status == TM_OK)
        status = append_grid(&grid, text, error);
    tm_vtk_grid_free(&grid);
    return status;
}
