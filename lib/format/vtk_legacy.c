/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_format.h"

#include "../element/shape.h"
#include "../mesh/cell_faces.h"
#include "text_rows.h"

#include <stdio.h>

enum { NAME = 32 };

typedef struct writer {
    const tm_block *node;
    const tm_block *cell; /* the block of the content; .node for points */
    tm_content content;
    tm_cell_faces faces; /* of polyhedra */
    unsigned threads;
    tm_text *text;
} writer;

static void append_rows(const writer *w, const void *context, size_t count,
                        size_t (*room)(const void *, size_t, size_t),
                        char *(*put)(const void *, size_t, char *))
{
    const tm_text_rows rows = {context, count, room, put};
    tm_text_append_rows(w->text, &rows, w->threads);
}

/* Cells ---------------------------------------------------------------------------- */

/* How many numbers the cells first … past - 1 are, with the one before each that says how
 * many follow. */
static size_t count_numbers(const void *context, size_t first, size_t past)
{
    const writer *w = context;
    if (w->content == TM_CONTENT_POINTS)
        return 2 * (past - first);
    if (w->content == TM_CONTENT_POLYHEDRA) {
        const tm_cell_faces *faces = &w->faces;
        size_t numbers = 2 * (past - first);
        for (size_t i = faces->cell_start[first]; i < faces->cell_start[past]; i++) {
            size_t f = faces->cell_facet[i];
            numbers += 1 + faces->start[f + 1] - faces->start[f];
        }
        return numbers;
    }
    if (w->cell->start)
        return w->cell->start[past] - w->cell->start[first] + past - first;
    return (past - first) * (1 + tm_block_integers(w->cell->kind));
}

static size_t cell_room(const void *context, size_t first, size_t past)
{
    return (count_numbers(context, first, past) + past - first) * TM_NUMBER_ROOM;
}

/* The faces of a polyhedron, all outward. */
static char *put_polyhedron(const void *context, size_t c, char *to)
{
    const writer *w = context;
    const tm_cell_faces *faces = &w->faces;
    size_t begin = faces->cell_start[c], end = faces->cell_start[c + 1];
    to = tm_write_int64(to, (int64_t)count_numbers(w, c, c + 1) - 1);
    to = tm_put_number(to, (uint32_t)(end - begin));
    for (size_t i = begin; i < end; i++) {
        size_t f = faces->cell_facet[i], k = faces->start[f + 1] - faces->start[f];
        const uint32_t *node = faces->node + faces->start[f];
        bool outward = tm_facet_is_outward(faces, f, c);
        to = tm_put_number(to, (uint32_t)k);
        for (size_t j = 0; j < k; j++)
            to = tm_put_number(to, node[outward ? j : k - 1 - j]);
    }
    *to++ = '\n';
    return to;
}

static char *put_vertex(const void *context, size_t row, char *to)
{
    (void)context;
    *to++ = '1';
    to = tm_put_number(to, (uint32_t)row);
    *to++ = '\n';
    return to;
}

static char *put_element(const void *context, size_t row, char *to)
{
    const writer *w = context;
    size_t k;
    const uint32_t *node = tm_row_nodes(w->cell, row, &k);
    to = tm_write_uint32(to, (uint32_t)k);
    for (size_t i = 0; i < k; i++)
        to = tm_put_number(to, node[i]);
    *to++ = '\n';
    return to;
}

static size_t type_room(const void *context, size_t first, size_t past)
{
    enum { DIGITS = 2 };
    (void)context;
    return (past - first) * (DIGITS + 1);
}

static char *put_type(const void *context, size_t row, char *to)
{
    const writer *w = context;
    size_t nodes = 1;
    if (w->content != TM_CONTENT_POINTS && w->content != TM_CONTENT_POLYHEDRA)
        tm_row_nodes(w->cell, row, &nodes);
    to =
        tm_write_uint32(to, w->content == TM_CONTENT_POLYHEDRA ? TM_VTK_POLYHEDRON
                                                               : tm_vtk_cell_type(nodes));
    *to++ = '\n';
    return to;
}

static void append_cells(const writer *w)
{
    char *(*put)(const void *, size_t, char *) = put_element;
    if (w->content == TM_CONTENT_POINTS)
        put = put_vertex;
    if (w->content == TM_CONTENT_POLYHEDRA)
        put = put_polyhedron;
    tm_text_format(w->text, "CELLS %zu %zu\n", w->cell->count,
                   count_numbers(w, 0, w->cell->count));
    append_rows(w, w, w->cell->count, cell_room, put);
    tm_text_format(w->text, "CELL_TYPES %zu\n", w->cell->count);
    append_rows(w, w, w->cell->count, type_room, put_type);
}

/* Data ----------------------------------------------------------------------------- */

typedef struct column {
    const tm_block *block;
    size_t attribute; /* which */
} column;

static size_t value_room(const void *context, size_t first, size_t past)
{
    (void)context;
    return (past - first) * TM_NUMBER_ROOM;
}

static char *put_value(const void *context, size_t row, char *to)
{
    const column *c = context;
    to = tm_write_double(to,
                         c->block->attribute[row * c->block->attributes + c->attribute]);
    *to++ = '\n';
    return to;
}

static char *put_marker(const void *context, size_t row, char *to)
{
    const column *c = context;
    to = tm_write_int64(to, c->block->marker[row]);
    *to++ = '\n';
    return to;
}

static void append_data(const writer *w, const char *heading, const tm_block *block,
                        const char *first_name)
{
    static const char scalars[] = "SCALARS %s %s 1\nLOOKUP_TABLE default\n";
    if (block->attributes == 0 && !block->marker)
        return;
    tm_text_format(w->text, "%s %zu\n", heading, block->count);
    column c = {block, 0};
    for (; c.attribute < block->attributes; c.attribute++) {
        char name[NAME];
        snprintf(name, sizeof name, "attribute_%zu", c.attribute + 1);
        tm_text_format(w->text, scalars, c.attribute == 0 ? first_name : name, "double");
        append_rows(w, &c, block->count, value_room, put_value);
    }
    if (block->marker) {
        tm_text_format(w->text, scalars, "marker", "int");
        append_rows(w, &c, block->count, value_room, put_marker);
    }
}

tm_status tm_vtk_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error)
{
    tm_status status = TM_OK;
    writer w = {.node = tm_stream_find(stream, ".node"),
                .content = tm_content_of(stream),
                .threads = threads,
                .text = text};
    if (w.content == TM_CONTENT_NOTHING)
        return tm_fail(error, TM_ERROR_INPUT, "has no nodes (.node)");
    w.cell = tm_content_block(stream, w.content);
    if (w.content == TM_CONTENT_POLYHEDRA)
        status = tm_cell_faces_find(&w.faces, stream, error);
    if (status == TM_OK) {
        tm_text_format(text,
                       "# vtk DataFile Version 3.0\ntermesh\nASCII\n"
                       "DATASET UNSTRUCTURED_GRID\nPOINTS %zu double\n",
                       w.node->count);
        tm_text_append_points(text, w.node->real, w.node->count, "", threads);
        append_cells(&w);
        if (w.content != TM_CONTENT_POINTS)
            append_data(&w, "CELL_DATA", w.cell,
                        w.content == TM_CONTENT_POLYHEDRA ? "tetrahedra" : "region");
        append_data(&w, "POINT_DATA", w.node, "attribute_1");
        if (text->failed)
            status = tm_fail_memory(error);
    }
    tm_cell_faces_free(&w.faces);
    return status;
}
