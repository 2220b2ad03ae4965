/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../mesh/cell_faces.h"
#include "../../stream/group.h"
#include "../binary.h"
#include "../text_rows.h"
#include "medit_input.h"

#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, INTEGER = 4, REAL = 8, TWO_GIB_FREE = 1 << 20 };

typedef struct writer {
    tm_text *text;
    const tm_stream *stream;
    unsigned threads;
    bool binary;
    int version;
    size_t start; /* of the file in the text */
    tm_error *error;
} writer;

/* Rows of a section: nodes or elements with a reference, or a solution. */
typedef struct rows {
    const tm_block *block;
    size_t nodes;  /* of an element; 0: vertices */
    uint32_t *row; /* [count]: rows of the block; NULL: all */
    size_t count;
} rows;

/* Binary ---------------------------------------------------------------------------- */

static void append_integer(writer *w, int64_t value, size_t size)
{
    char bytes[REAL];
    tm_binary_put_unsigned(bytes, (uint64_t)value, size, false);
    tm_text_append(w->text, bytes, size);
}

/* The head of a section whose rows and counts have `size` bytes. */
static void begin_section(writer *w, int code, size_t size)
{
    const size_t place = w->version >= 3 ? REAL : INTEGER;
    append_integer(w, code, INTEGER);
    append_integer(w, (int64_t)(w->text->size - w->start + place + size), place);
}

static char *put_integer(char *to, int64_t value)
{
    tm_binary_put_unsigned(to, (uint64_t)value, INTEGER, false);
    return to + INTEGER;
}

static char *put_bits(char *to, double real)
{
    uint64_t bits;
    memcpy(&bits, &real, sizeof bits);
    tm_binary_put_unsigned(to, bits, REAL, false);
    return to + REAL;
}

/* Rows ------------------------------------------------------------------------------ */

/* The marker or region of a row; 0 where it has none. */
static int32_t reference_of(const tm_block *block, size_t row)
{
    int32_t value = 0;
    if (block->kind == TM_ELE || block->kind == TM_MIX)
        return tm_group_region(block, row, &value) ? value : 0;
    return block->marker ? block->marker[row] : 0;
}

static size_t row_of(const rows *r, size_t i)
{
    return r->row ? r->row[i] : i;
}

/* The nodes of an element, from 1: the triangle of a wedge turns the other way. */
static void corners_of(const rows *r, size_t row, uint32_t node[TM_ELEMENT_NODES])
{
    const uint8_t *mirror = tm_element_shapes[TM_WEDGE_NODES].mirror;
    size_t k;
    const uint32_t *from = tm_row_nodes(r->block, row, &k);
    for (size_t i = 0; i < k; i++)
        node[i] = from[k == TM_WEDGE_NODES ? mirror[i] : i] + 1;
}

static size_t text_room(const void *context, size_t first, size_t past)
{
    const rows *r = context;
    return (past - first) * (r->nodes + COORDINATES + 2) * TM_NUMBER_ROOM;
}

static char *put_text(const void *context, size_t i, char *to)
{
    const rows *r = context;
    const size_t row = row_of(r, i);
    uint32_t node[TM_ELEMENT_NODES] = {0};
    if (r->nodes > 0)
        corners_of(r, row, node);
    for (size_t k = 0; k < r->nodes; k++) {
        to = tm_write_uint32(to, node[k]);
        *to++ = ' ';
    }
    for (size_t k = 0; r->nodes == 0 && k < COORDINATES; k++) {
        to = tm_write_double(to, r->block->real[COORDINATES * row + k]);
        *to++ = ' ';
    }
    to = tm_write_int64(to, reference_of(r->block, row));
    *to++ = '\n';
    return to;
}

static size_t binary_size(const rows *r)
{
    return r->nodes > 0 ? (r->nodes + 1) * INTEGER : COORDINATES * REAL + INTEGER;
}

static size_t binary_room(const void *context, size_t first, size_t past)
{
    return (past - first) * binary_size(context) + TM_NUMBER_ROOM;
}

static char *put_binary(const void *context, size_t i, char *to)
{
    const rows *r = context;
    const size_t row = row_of(r, i);
    uint32_t node[TM_ELEMENT_NODES] = {0};
    if (r->nodes > 0)
        corners_of(r, row, node);
    for (size_t k = 0; k < r->nodes; k++)
        to = put_integer(to, node[k]);
    for (size_t k = 0; r->nodes == 0 && k < COORDINATES; k++)
        to = put_bits(to, r->block->real[COORDINATES * row + k]);
    return put_integer(to, reference_of(r->block, row));
}

static void write_rows(writer *w, int code, const rows *r)
{
    const tm_text_rows of = {r, r->count, w->binary ? binary_room : text_room,
                             w->binary ? put_binary : put_text};
    if (w->binary) {
        begin_section(w, code, INTEGER + r->count * binary_size(r));
        append_integer(w, (int64_t)r->count, INTEGER);
    } else {
        tm_text_format(w->text, "%s\n%zu\n", tm_medit_section_of(code)->word, r->count);
    }
    tm_text_append_rows(w->text, &of, w->threads);
}

/* The rows of a block with so many nodes; none: no section. */
static tm_status write_elements(writer *w, int code, const char *block)
{
    rows r = {.block = tm_stream_find(w->stream, block),
              .nodes = tm_medit_section_of(code)->nodes};
    size_t room = 0;
    bool done = true;
    if (!r.block)
        return TM_OK;
    for (size_t i = 0, k; i < r.block->count && done; i++) {
        tm_row_nodes(r.block, i, &k);
        if (k == r.nodes)
            done = tm_append(&r.row, &r.count, &room, (uint32_t)i);
    }
    if (done && r.count > 0)
        write_rows(w, code, &r);
    free(r.row);
    return done ? TM_OK : tm_fail_memory(w->error);
}

/* Files ----------------------------------------------------------------------------- */

static void begin_file(writer *w)
{
    w->start = w->text->size;
    if (!w->binary) {
        tm_text_string(w->text, "MeshVersionFormatted 2\nDimension 3\n");
        return;
    }
    append_integer(w, 1, INTEGER);
    append_integer(w, w->version, INTEGER);
    begin_section(w, TM_MEDIT_DIMENSION, INTEGER);
    append_integer(w, COORDINATES, INTEGER);
}

static void end_file(writer *w)
{
    if (!w->binary) {
        tm_text_string(w->text, "End\n");
        return;
    }
    append_integer(w, TM_MEDIT_END, INTEGER);
    append_integer(w, 0, w->version >= 3 ? REAL : INTEGER);
}

static void write_names(writer *w)
{
    const tm_block *group = tm_stream_find(w->stream, ".group");
    for (size_t g = 0; group && !w->binary && g < group->count; g++)
        tm_text_format(w->text, "# termesh %d %d %s\n",
                       (int)tm_group_dimension_of(group, g),
                       (int)tm_group_value(group, g), tm_group_name(group, g));
}

/* Version 3 has places of 64 bits. */
static int version_for(const tm_stream *stream)
{
    size_t size = TWO_GIB_FREE;
    for (size_t b = 0; b < stream->blocks; b++) {
        const tm_block *block = &stream->block[b];
        size += block->count * (COORDINATES + TM_ELEMENT_NODES + 1) * INTEGER +
                block->count * block->attributes * REAL;
    }
    return size > INT32_MAX ? 3 : 2;
}

static size_t count_polygons(const tm_stream *stream)
{
    const tm_block *facet = tm_stream_find(stream, ".facet");
    size_t count = 0;
    for (size_t r = 0, k; facet && r < facet->count; r++) {
        tm_row_nodes(facet, r, &k);
        count += k > 4;
    }
    return count;
}

static tm_status check_content(const tm_stream *stream, tm_error *error)
{
    const tm_content content = tm_content_of(stream);
    if (content == TM_CONTENT_NOTHING || content == TM_CONTENT_POLYHEDRA)
        return tm_fail(error, TM_ERROR_INPUT,
                       "holds no points, surface or elements (.node with .face, .ele or "
                       ".mix)");
    return TM_OK;
}

/* Elements of one block alone, as the content says. */
static tm_status write_all(writer *w)
{
    static const struct {
        int code;
        const char *block;
    } sections[] = {
        {TM_MEDIT_TETRAHEDRA, ".ele"},  {TM_MEDIT_TETRAHEDRA, ".mix"},
        {TM_MEDIT_PYRAMIDS, ".mix"},    {TM_MEDIT_PRISMS, ".mix"},
        {TM_MEDIT_HEXAHEDRA, ".mix"},   {TM_MEDIT_TRIANGLES, ".face"},
        {TM_MEDIT_TRIANGLES, ".facet"}, {TM_MEDIT_QUADRILATERALS, ".facet"},
        {TM_MEDIT_EDGES, ".edge"},
    };
    const bool is_mixed = tm_content_of(w->stream) == TM_CONTENT_MIXED;
    const rows vertices = {.block = tm_stream_find(w->stream, ".node"),
                           .count = tm_stream_find(w->stream, ".node")->count};
    tm_status status = TM_OK;
    write_rows(w, TM_MEDIT_VERTICES, &vertices);
    for (size_t s = 0; s < sizeof sections / sizeof *sections && status == TM_OK; s++) {
        const char *block = sections[s].block;
        const bool is_other = strcmp(block, is_mixed ? ".ele" : ".mix") == 0 ||
                              strcmp(block, is_mixed ? ".face" : ".facet") == 0;
        if (!is_other)
            status = write_elements(w, sections[s].code, block);
    }
    return status;
}

tm_status tm_medit_write(tm_text *text, const tm_stream *stream, bool binary,
                         unsigned threads, size_t *polygons, tm_error *error)
{
    writer w = {.text = text,
                .stream = stream,
                .threads = threads,
                .binary = binary,
                .version = version_for(stream),
                .error = error};
    *polygons = count_polygons(stream);
    tm_status status = check_content(stream, error);
    if (status != TM_OK)
        return status;
    begin_file(&w);
    write_names(&w);
    status = write_all(&w);
    end_file(&w);
    return status == TM_OK && text->failed ? tm_fail_memory(error) : status;
}

/* Solutions ------------------------------------------------------------------------- */

static size_t solution_room(const void *context, size_t first, size_t past)
{
    const tm_block *node = context;
    return (past - first) * node->attributes * TM_NUMBER_ROOM;
}

static char *put_solution(const void *context, size_t row, char *to)
{
    const tm_block *node = context;
    for (size_t a = 0; a < node->attributes; a++) {
        to = tm_write_double(to, node->attribute[row * node->attributes + a]);
        *to++ = a + 1 < node->attributes ? ' ' : '\n';
    }
    return to;
}

static char *put_binary_solution(const void *context, size_t row, char *to)
{
    const tm_block *node = context;
    for (size_t a = 0; a < node->attributes; a++)
        to = put_bits(to, node->attribute[row * node->attributes + a]);
    return to;
}

/* Value k of `kinds`, which are scalars where there are none. */
static void write_kinds(writer *w, const tm_medit_kind *kind, size_t kinds, size_t values)
{
    for (size_t k = 0; k < values; k++) {
        const int is = (int)(kinds > 0 ? kind[k] : TM_MEDIT_SCALAR);
        if (w->binary)
            append_integer(w, is, INTEGER);
        else
            tm_text_format(w->text, " %d", is);
    }
}

tm_status tm_medit_write_solution(tm_text *text, const tm_stream *stream,
                                  const tm_medit_kind *kind, size_t kinds, bool binary,
                                  unsigned threads, tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    writer w = {.text = text,
                .stream = stream,
                .threads = threads,
                .binary = binary,
                .version = version_for(stream),
                .error = error};
    size_t numbers = 0;
    for (size_t k = 0; k < kinds; k++)
        numbers += tm_medit_numbers[kind[k]];
    if (!node || node->attributes == 0)
        return tm_fail(error, TM_ERROR_INPUT,
                       "has no attributes of nodes for a solution");
    if (kinds > 0 && numbers != node->attributes)
        return tm_fail(error, TM_ERROR_INPUT,
                       "nodes have %zu attributes, but the kinds of values are of %zu",
                       node->attributes, numbers);
    const size_t values = kinds > 0 ? kinds : node->attributes;
    begin_file(&w);
    if (binary) {
        begin_section(&w, TM_MEDIT_SOLUTION,
                      (2 + values) * INTEGER + node->count * node->attributes * REAL);
        append_integer(&w, (int64_t)node->count, INTEGER);
        append_integer(&w, (int64_t)values, INTEGER);
    } else {
        tm_text_format(text, "SolAtVertices\n%zu\n%zu", node->count, values);
    }
    write_kinds(&w, kind, kinds, values);
    if (!binary)
        tm_text_string(text, "\n");
    const tm_text_rows of = {node, node->count, solution_room,
                             binary ? put_binary_solution : put_solution};
    tm_text_append_rows(text, &of, threads);
    end_file(&w);
    return text->failed ? tm_fail_memory(error) : TM_OK;
}
