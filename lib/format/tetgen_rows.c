/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../element/tet_quality.h"
#include "../stream/group.h"
#include "row_order.h"
#include "scan.h"

#include <stdlib.h>
#include <string.h>

/* Columns that `tetgen -nn` adds. */
enum { FACE_NEIGHBOURS = 2, EDGE_NEIGHBOURS = 1 };

enum { SECOND_ORDER_TETRAHEDRON = 10 };

typedef struct {
    tm_block *block;
    tm_scan *scan;
    tm_tetgen_nodes *nodes;
    size_t rows;
    tm_row_order order; /* of the rows' numbers */
    size_t middles;     /* nodes that follow the corners in elements of second order */
    size_t extra;       /* columns that may follow and are skipped */
    tm_error *error;
} reader;

/* A header field that may be left out: *value is then as it was. */
static tm_status read_field(reader *r, const char *what, int64_t lo, int64_t hi,
                            int64_t *value)
{
    if (!tm_scan_more(r->scan))
        return TM_OK;
    return tm_scan_integer(r->scan, what, lo, hi, value, r->error);
}

static tm_status read_dimension(reader *r)
{
    int64_t dimension = 3;
    tm_status status = read_field(r, "the dimension", INT64_MIN, INT64_MAX, &dimension);
    if (status == TM_OK && dimension != 3)
        status =
            tm_scan_fail(r->scan, r->error, "nodes of dimension %lld (3 would be right)",
                         (long long)dimension);
    return status;
}

static tm_status read_order(reader *r)
{
    int64_t corners = 4;
    tm_status status =
        read_field(r, "the nodes per tetrahedron", INT64_MIN, INT64_MAX, &corners);
    if (status == TM_OK && corners == SECOND_ORDER_TETRAHEDRON) {
        r->middles = SECOND_ORDER_TETRAHEDRON - 4;
        r->nodes->middle = calloc(r->nodes->count + 1, sizeof *r->nodes->middle);
        return r->nodes->middle ? TM_OK : tm_fail_memory(r->error);
    }
    if (status == TM_OK && corners != 4)
        status =
            tm_scan_fail(r->scan, r->error, "tetrahedra of %lld nodes (4 would be right)",
                         (long long)corners);
    return status;
}

/* Each column of a row takes two bytes at least: no more rows than that are believed. */
static tm_status check_claim(reader *r, int64_t count)
{
    const tm_block *block = r->block;
    double columns =
        (double)(1 + tm_block_reals(block->kind) + tm_block_integers(block->kind) +
                 block->attributes + block->markers + r->middles);
    double left = (double)(r->scan->end - r->scan->at);
    if ((double)count * columns * 2 > left + 2 || count >= TM_IDS)
        return tm_scan_fail(r->scan, r->error,
                            "the header claims %lld rows, more than the rest of the file "
                            "can hold",
                            (long long)count);
    return TM_OK;
}

static tm_status read_header(reader *r)
{
    tm_block *block = r->block;
    int64_t count = 0, attributes = 0, markers = 0;
    tm_status status = tm_scan_next_integer(r->scan, "the number of rows", 0, INT64_MAX,
                                            &count, r->error);
    if (status == TM_OK && block->kind == TM_NODE)
        status = read_dimension(r);
    if (status == TM_OK && block->kind == TM_ELE)
        status = read_order(r);
    if (status == TM_OK && (block->kind == TM_NODE || block->kind == TM_ELE))
        status =
            read_field(r, "the number of attributes", 0, TM_ATTRIBUTES_MAX, &attributes);
    if (status == TM_OK && block->kind != TM_ELE)
        status = read_field(r, "whether there are markers", 0, 1, &markers);
    if (status == TM_OK)
        status = tm_scan_no_more(r->scan, "the header", r->error);
    tm_scan_end_line(r->scan);
    block->attributes = (size_t)attributes;
    block->markers = markers != 0;
    if (status == TM_OK)
        status = check_claim(r, count);
    if (status == TM_OK)
        status = tm_block_allocate(block, (size_t)count, 0, r->error);
    return status;
}

/* The number that a row begins with. */
static tm_status read_number(reader *r, size_t row)
{
    if (!tm_scan_seek(r->scan))
        return tm_scan_fail(r->scan, r->error, "the file ends after %zu of %zu rows", row,
                            r->block->count);
    int64_t number = 0;
    tm_status status = tm_scan_integer(r->scan, "the number of the row", INT64_MIN,
                                       INT64_MAX, &number, r->error);
    if (status != TM_OK)
        return status;
    switch (tm_row_order_add(&r->order, r->rows, row, number)) {
    case TM_ROW_NUMBERED:
        return TM_OK;
    case TM_ROW_NO_MEMORY:
        return tm_fail_memory(r->error);
    default:
        return row == 0
                   ? tm_scan_fail(r->scan, r->error,
                                  "the first row has number %lld (0 or 1 would be right)",
                                  (long long)number)
                   : tm_scan_fail(r->scan, r->error,
                                  "the row has number %lld (%zu is next)",
                                  (long long)number, row + (size_t)r->order.first);
    }
}

/* Where the rows were in another order: puts them in that of their numbers. */
static tm_status sort_rows(reader *r)
{
    int64_t number = 0;
    if (!tm_row_order_finish(&r->order, r->block->count, &number))
        return tm_scan_fail(r->scan, r->error,
                            "no row has number %lld (each from 0 or 1 on would be right)",
                            (long long)number);
    return tm_row_order_apply(&r->order, r->block) ? TM_OK : tm_fail_memory(r->error);
}

static tm_status read_nodes(reader *r, uint32_t *node, size_t count)
{
    int64_t base = r->nodes->base, last = (int64_t)r->nodes->count - 1 + base;
    tm_status status = TM_OK;
    for (size_t i = 0; i < count && status == TM_OK; i++) {
        int64_t value = 0;
        status = tm_scan_integer(r->scan, "node", base, last, &value, r->error);
        node[i] = (uint32_t)(value - base);
    }
    return status;
}

/* Nodes in the middle of edges, which follow the corners. */
static tm_status read_middles(reader *r)
{
    uint32_t node[SECOND_ORDER_TETRAHEDRON];
    const tm_status status = read_nodes(r, node, r->middles);
    for (size_t i = 0; i < r->middles && status == TM_OK; i++)
        r->nodes->middle[node[i]] = true;
    return status;
}

static tm_status read_marker(reader *r, size_t row)
{
    int64_t marker = 0;
    const tm_status status =
        tm_scan_whole(r->scan, "the marker", INT32_MIN, INT32_MAX, &marker, r->error);
    r->block->marker[row] = (int32_t)marker;
    return status;
}

/* What may follow a row: nothing, or just what -nn adds. */
static tm_status read_extra(reader *r)
{
    for (size_t i = 0; i < r->extra && tm_scan_more(r->scan); i++) {
        int64_t neighbour;
        tm_status status =
            tm_scan_integer(r->scan, "a neighbour", -1, INT64_MAX, &neighbour, r->error);
        if (status != TM_OK)
            return status;
    }
    return tm_scan_no_more(r->scan, "the row", r->error);
}

static tm_status read_row(reader *r, size_t row)
{
    tm_block *block = r->block;
    size_t integers = tm_block_integers(block->kind);
    tm_status status = TM_OK;
    if (block->kind == TM_NODE)
        status = tm_scan_point(r->scan, block->real + row * 3, r->error);
    else
        status = read_nodes(r, block->integer + row * integers, integers);
    if (status == TM_OK && r->middles > 0)
        status = read_middles(r);
    for (size_t i = 0; i < block->attributes && status == TM_OK; i++)
        status = tm_scan_double(r->scan, "an attribute",
                                &block->attribute[row * block->attributes + i], r->error);
    if (status == TM_OK && block->markers)
        status = read_marker(r, row);
    if (status == TM_OK)
        status = read_extra(r);
    tm_scan_end_line(r->scan);
    return status;
}

/* dimension, value, and the name, which is the rest of the line. */
static tm_status read_group(reader *r)
{
    int64_t dimension = 0, value = 0;
    tm_status status = tm_scan_integer(r->scan, "the dimension", 0,
                                       TM_GROUP_DIMENSIONS - 1, &dimension, r->error);
    if (status == TM_OK)
        status =
            tm_scan_integer(r->scan, "the value", INT32_MIN, INT32_MAX, &value, r->error);
    if (status != TM_OK)
        return status;
    tm_text name = {0};
    const tm_word rest = tm_scan_rest(r->scan);
    tm_group_clean(&name, rest.begin, rest.size);
    if (name.failed)
        status = tm_fail_memory(r->error);
    else if (name.size == 0)
        status = tm_scan_fail(r->scan, r->error, "there is no name");
    else
        status = tm_group_add(r->block, (tm_group_dimension)dimension, (int32_t)value,
                              name.byte, r->error);
    tm_text_free(&name);
    tm_scan_end_line(r->scan);
    return status;
}

static tm_status read_groups(reader *r)
{
    int64_t count = 0, zero = 0;
    tm_status status = tm_scan_next_integer(r->scan, "the number of rows", 0, UINT32_MAX,
                                            &count, r->error);
    if (status == TM_OK)
        status = read_field(r, "the second number of the header", 0, 0, &zero);
    if (status == TM_OK)
        status = tm_scan_no_more(r->scan, "the header", r->error);
    tm_scan_end_line(r->scan);
    r->rows = (size_t)count;
    for (size_t row = 0; row < r->rows && status == TM_OK; row++) {
        status = read_number(r, row);
        if (status == TM_OK)
            status = read_group(r);
    }
    if (status == TM_OK)
        status =
            tm_group_check(r->block, (unsigned)r->order.first, r->scan->name, r->error);
    return status;
}

/* What kinds of rows have behind their corners. */
static void set_columns(reader *r)
{
    if (r->block->kind != TM_FACE && r->block->kind != TM_EDGE)
        return;
    const bool is_face = r->block->kind == TM_FACE;
    r->extra = is_face ? FACE_NEIGHBOURS : EDGE_NEIGHBOURS;
    if (r->nodes->middle)
        r->middles = is_face ? 3 : 1;
}

tm_status tm_tetgen_read_rows(tm_block *block, tm_scan *scan, tm_tetgen_nodes *nodes,
                              tm_error *error)
{
    reader r = {.block = block, .scan = scan, .nodes = nodes, .error = error};
    const bool is_group = block->kind == TM_GROUP;
    set_columns(&r);
    tm_status status = is_group ? read_groups(&r) : read_header(&r);
    const size_t rows = r.rows = is_group ? 0 : block->count;
    for (size_t row = 0; row < rows && status == TM_OK; row++) {
        status = read_number(&r, row);
        if (status == TM_OK)
            status = read_row(&r, row);
    }
    if (status == TM_OK && rows > 0)
        status = sort_rows(&r);
    if (status == TM_OK && block->kind == TM_NODE) {
        nodes->count = block->count;
        if (rows > 0)
            nodes->base = (unsigned)r.order.first;
    }
    tm_row_order_free(&r.order);
    if (status != TM_OK)
        tm_block_clear(block);
    return status;
}

tm_status tm_tetgen_read(tm_block *block, const char *bytes, size_t size,
                         const char *name, tm_tetgen_nodes *nodes, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    tm_status status = tm_tetgen_read_rows(block, &scan, nodes, error);
    if (status == TM_OK && tm_scan_seek(&scan)) {
        status = tm_scan_no_more(&scan, "the last row", error);
        tm_block_clear(block);
    }
    return status;
}

void tm_tetgen_nodes_free(tm_tetgen_nodes *nodes)
{
    free(nodes->middle);
    *nodes = (tm_tetgen_nodes){.base = 1};
}

/* Which number a node has when those that are dropped are gone; TM_NONE: it is. */
static uint32_t *number_anew(const tm_tetgen_nodes *nodes, tm_block *const other[3],
                             size_t *kept)
{
    uint32_t *number = tm_new(nodes->count, sizeof *number);
    if (!number)
        return NULL;
    for (size_t v = 0; v < nodes->count; v++)
        number[v] = nodes->middle[v] ? TM_NONE : 0;
    for (int b = 0; b < 3; b++) {
        const size_t corners = other[b] ? tm_block_integers(other[b]->kind) : 0;
        for (size_t i = 0; corners > 0 && i < corners * other[b]->count; i++)
            number[other[b]->integer[i]] = 0;
    }
    *kept = 0;
    for (size_t v = 0; v < nodes->count; v++)
        if (number[v] != TM_NONE)
            number[v] = (uint32_t)(*kept)++;
    return number;
}

tm_status tm_tetgen_drop_middles(tm_tetgen_nodes *nodes, tm_block *node,
                                 tm_block *const other[3], size_t *dropped,
                                 tm_error *error)
{
    *dropped = 0;
    if (!nodes->middle)
        return TM_OK;
    size_t kept;
    uint32_t *number = number_anew(nodes, other, &kept);
    if (!number)
        return tm_fail_memory(error);
    const size_t attributes = node->attributes;
    for (size_t v = 0; v < nodes->count; v++) {
        const uint32_t to = number[v];
        if (to == TM_NONE)
            continue;
        memmove(node->real + 3 * to, node->real + 3 * v, 3 * sizeof *node->real);
        if (attributes > 0)
            memmove(node->attribute + attributes * to, node->attribute + attributes * v,
                    attributes * sizeof *node->attribute);
        if (node->markers)
            node->marker[to] = node->marker[v];
    }
    for (int b = 0; b < 3; b++) {
        const size_t corners = other[b] ? tm_block_integers(other[b]->kind) : 0;
        for (size_t i = 0; corners > 0 && i < corners * other[b]->count; i++)
            other[b]->integer[i] = number[other[b]->integer[i]];
    }
    free(number);
    *dropped = nodes->count - kept;
    nodes->count = node->count = kept;
    return TM_OK;
}

tm_turned tm_tetgen_orient(const tm_block *node, tm_block *ele)
{
    enum { CORNERS = 4 };
    tm_turned result = {0};
    const double(*xyz)[3] = (const double(*)[3])node->real;
    for (size_t t = 0; t < ele->count; t++) {
        const int sign = tm_tet_turn(xyz, ele->integer + CORNERS * t);
        result.turned += sign < 0;
        result.flat += sign == 0;
    }
    return result;
}
