/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen.h"

#include "../geom/predicates.h"
#include "../stream/group.h"
#include "scan.h"

/* Columns that `tetgen -nn` adds. */
enum { FACE_NEIGHBOURS = 2, EDGE_NEIGHBOURS = 1 };

enum { SECOND_ORDER_TETRAHEDRON = 10 };

typedef struct {
    tm_block *block;
    tm_scan *scan;
    unsigned *base;
    size_t nodes;
    size_t extra; /* columns that may follow and are skipped */
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
    if (status == TM_OK && corners == SECOND_ORDER_TETRAHEDRON)
        status =
            tm_scan_fail(r->scan, r->error,
                         "tetrahedra of 10 nodes, of second order (4 would be right: "
                         "run tetgen without -o2)");
    else if (status == TM_OK && corners != 4)
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
                 block->attributes + block->markers);
    double left = (double)(r->scan->end - r->scan->at);
    if ((double)count * columns * 2 > left + 2 || count >= UINT32_MAX)
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
        status = read_field(r, "the number of attributes", 0, INT32_MAX, &attributes);
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

/* The number that a row begins with; the first one of a file is 0 or 1. */
static tm_status read_number(reader *r, size_t row, unsigned *first)
{
    if (!tm_scan_seek(r->scan))
        return tm_scan_fail(r->scan, r->error, "the file ends after %zu of %zu rows", row,
                            r->block->count);
    int64_t number = 0;
    tm_status status = tm_scan_integer(r->scan, "the number of the row", INT64_MIN,
                                       INT64_MAX, &number, r->error);
    if (status != TM_OK)
        return status;
    if (row == 0 && (number == 0 || number == 1))
        *first = (unsigned)number;
    else if (row == 0)
        return tm_scan_fail(r->scan, r->error,
                            "the first row has number %lld (0 or 1 would be right)",
                            (long long)number);
    if (number != (int64_t)(row + *first))
        return tm_scan_fail(r->scan, r->error, "the row has number %lld (%zu is next)",
                            (long long)number, row + *first);
    return TM_OK;
}

static tm_status read_nodes(reader *r, uint32_t *node, size_t count)
{
    int64_t base = *r->base, last = (int64_t)r->nodes - 1 + base;
    tm_status status = TM_OK;
    for (size_t i = 0; i < count && status == TM_OK; i++) {
        int64_t value = 0;
        status = tm_scan_integer(r->scan, "node", base, last, &value, r->error);
        node[i] = (uint32_t)(value - base);
    }
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
    for (size_t i = 0; i < block->attributes && status == TM_OK; i++)
        status = tm_scan_double(r->scan, "an attribute",
                                &block->attribute[row * block->attributes + i], r->error);
    if (status == TM_OK && block->markers) {
        int64_t marker = 0;
        status = tm_scan_integer(r->scan, "the marker", INT32_MIN, INT32_MAX, &marker,
                                 r->error);
        block->marker[row] = (int32_t)marker;
    }
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
    unsigned first = 0;
    tm_status status = tm_scan_next_integer(r->scan, "the number of rows", 0, UINT32_MAX,
                                            &count, r->error);
    if (status == TM_OK)
        status = read_field(r, "the second number of the header", 0, 0, &zero);
    if (status == TM_OK)
        status = tm_scan_no_more(r->scan, "the header", r->error);
    tm_scan_end_line(r->scan);
    for (size_t row = 0; row < (size_t)count && status == TM_OK; row++) {
        status = read_number(r, row, &first);
        if (status == TM_OK)
            status = read_group(r);
    }
    if (status == TM_OK)
        status = tm_group_check(r->block, first, r->scan->name, r->error);
    return status;
}

tm_status tm_tetgen_read_rows(tm_block *block, tm_scan *scan, unsigned *base,
                              size_t nodes, tm_error *error)
{
    reader r = {block, scan, base, nodes, 0, error};
    if (block->kind == TM_FACE)
        r.extra = FACE_NEIGHBOURS;
    else if (block->kind == TM_EDGE)
        r.extra = EDGE_NEIGHBOURS;
    unsigned first = 0;
    tm_status status = block->kind == TM_GROUP ? read_groups(&r) : read_header(&r);
    const size_t rows = block->kind == TM_GROUP ? 0 : block->count;
    for (size_t row = 0; row < rows && status == TM_OK; row++) {
        status = read_number(&r, row, &first);
        if (block->kind == TM_NODE)
            *base = first;
        if (status == TM_OK)
            status = read_row(&r, row);
    }
    if (status != TM_OK)
        tm_block_allocate(block, 0, 0, NULL);
    return status;
}

tm_status tm_tetgen_read(tm_block *block, const char *bytes, size_t size,
                         const char *name, unsigned *base, size_t nodes, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    tm_status status = tm_tetgen_read_rows(block, &scan, base, nodes, error);
    if (status == TM_OK && tm_scan_seek(&scan)) {
        status = tm_scan_no_more(&scan, "the last row", error);
        tm_block_allocate(block, 0, 0, NULL);
    }
    return status;
}

tm_turned tm_tetgen_orient(const tm_block *node, tm_block *ele)
{
    enum { CORNERS = 4 };
    tm_turned result = {0};
    const double *xyz = node->real;
    for (size_t t = 0; t < ele->count; t++) {
        uint32_t *v = ele->integer + CORNERS * t;
        const double *corner[CORNERS];
        for (int i = 0; i < CORNERS; i++)
            corner[i] = xyz + (size_t)v[i] * 3;
        int sign = tm_orient3d(corner[0], corner[1], corner[2], corner[3]);
        if (sign < 0) {
            uint32_t last = v[3];
            v[3] = v[2];
            v[2] = last;
            result.turned++;
        } else if (sign == 0) {
            result.flat++;
        }
    }
    return result;
}
