/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "visf.h"

#include "binary.h"
#include "scan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { POINTS, POLYGONS, POLYHEDRA };
enum { TEXT = 2, COORDINATES = 3, TRIANGLE = 3, TETRAHEDRON = 4, WORD = 4 };

/* A place in the file; a copy of it is one, too. */
typedef struct place {
    bool text;
    bool big;
    tm_scan scan; /* of text, and of binary files the next byte and the end */
} place;

typedef struct reader {
    place at;
    int type;
    tm_block *node;
    tm_lists polygons;
    tm_lists polyhedra;
    tm_polyhedra_repairs *repairs;
    tm_error *error;
} reader;

static tm_status fail(reader *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static tm_status fail(reader *r, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tm_fail_at_list(r->error, TM_ERROR_INPUT, r->at.scan.name,
                    r->at.text ? r->at.scan.line : 0, NULL, format, arguments);
    va_end(arguments);
    return TM_ERROR_INPUT;
}

/* Numbers -------------------------------------------------------------------------- */

static tm_status next_word(reader *r, const char *what, const char **word)
{
    tm_scan *scan = &r->at.scan;
    if (scan->end - scan->at < WORD)
        return fail(r, "the file ends where %s should be", what);
    *word = scan->at;
    scan->at += WORD;
    return TM_OK;
}

static tm_status next_integer(reader *r, const char *what, int64_t lo, int64_t hi,
                              int64_t *value)
{
    if (r->at.text)
        return tm_scan_next_integer(&r->at.scan, what, lo, hi, value, r->error);
    const char *word = NULL;
    tm_status status = next_word(r, what, &word);
    if (status != TM_OK)
        return status;
    uint64_t bits = tm_binary_unsigned(word, WORD, r->at.big);
    *value = bits > INT32_MAX ? (int64_t)bits - ((int64_t)1 << 32) : (int64_t)bits;
    if (*value < lo || *value > hi)
        return fail(r, "%s: %lld is out of range (%lld..%lld)", what, (long long)*value,
                    (long long)lo, (long long)hi);
    return TM_OK;
}

static tm_status next_coordinate(reader *r, size_t axis, double *value)
{
    static const char *const what[COORDINATES] = {"an x coordinate", "a y coordinate",
                                                  "a z coordinate"};
    if (r->at.text)
        return tm_scan_next_double(&r->at.scan, what[axis], value, r->error);
    const char *word = NULL;
    tm_status status = next_word(r, what[axis], &word);
    if (status != TM_OK)
        return status;
    *value = (double)tm_binary_float(word, r->at.big);
    return isfinite(*value) ? TM_OK : fail(r, "%s is not a finite number", what[axis]);
}

/* A count of things of so many numbers each at least: not more than there is room for in
 * the rest of the file. */
static tm_status next_count(reader *r, const char *what, size_t numbers, size_t *count)
{
    int64_t value;
    tm_status status = next_integer(r, what, 0, INT32_MAX, &value);
    if (status != TM_OK)
        return status;
    size_t left = (size_t)(r->at.scan.end - r->at.scan.at) + 1;
    size_t least = r->at.text ? 2 : WORD;
    *count = (size_t)value;
    if (*count > left / (least * numbers))
        return fail(r, "%s is %zu: more than the rest of the file can hold", what,
                    *count);
    return TM_OK;
}

static bool is_at_end(reader *r)
{
    return r->at.text ? !tm_scan_seek(&r->at.scan) : r->at.scan.at == r->at.scan.end;
}

/* Parts ---------------------------------------------------------------------------- */

static tm_status read_points(reader *r)
{
    size_t count = 0;
    tm_status status = next_count(r, "the number of points", COORDINATES, &count);
    if (status == TM_OK)
        status = tm_block_allocate(r->node, count, 0, r->error);
    for (size_t i = 0; i < COORDINATES * count && status == TM_OK; i++)
        status = next_coordinate(r, i % COORDINATES, &r->node->real[i]);
    return status;
}

/* Appends a list of at least `least` numbers below `limit`. */
static tm_status read_list(reader *r, tm_lists *to, const char *what, size_t least,
                           size_t limit)
{
    size_t k = 0;
    tm_status status = next_count(r, what, 1, &k);
    if (status != TM_OK)
        return status;
    if (k < least)
        return fail(r, "%s is %zu (%zu or more would be right)", what, k, least);
    uint32_t *item = tm_lists_room(to, k);
    if (!item)
        return tm_fail_memory(r->error);
    for (size_t i = 0; i < k && status == TM_OK; i++) {
        int64_t number = 0;
        status = next_integer(r, "a number in the list", 0, (int64_t)limit - 1, &number);
        item[i] = (uint32_t)number;
    }
    if (status == TM_OK && !tm_lists_end(to, k))
        status = tm_fail_memory(r->error);
    return status;
}

static tm_status begin_lists(reader *r, tm_lists *to)
{
    return tm_lists_begin(to) ? TM_OK : tm_fail_memory(r->error);
}

static tm_status read_polygons(reader *r)
{
    size_t count = 0;
    tm_status status = next_count(r, "the number of polygons", 1 + TRIANGLE, &count);
    if (status == TM_OK)
        status = begin_lists(r, &r->polygons);
    for (size_t p = 0; p < count && status == TM_OK; p++)
        status = read_list(r, &r->polygons, "the number of corners of a polygon",
                           TRIANGLE, r->node->count);
    return status;
}

/* At least so many. */
static tm_status read_polyhedra(reader *r, size_t least)
{
    size_t count = 0;
    tm_status status = begin_lists(r, &r->polyhedra);
    if (status == TM_OK && r->type == POLYHEDRA)
        status = next_count(r, "the number of polyhedra", 1 + TETRAHEDRON, &count);
    if (status == TM_OK && r->type == POLYHEDRA && count < least)
        status = fail(r, "the file ends before its polyhedra");
    for (size_t c = 0; c < count && status == TM_OK; c++)
        status = read_list(r, &r->polyhedra, "the number of polygons of a polyhedron",
                           TETRAHEDRON, r->polygons.count);
    if (status == TM_OK && !is_at_end(r))
        status = fail(r, "there is more behind the last %s",
                      r->type == POLYHEDRA ? "polyhedron" : "polygon");
    return status;
}

/* The flag and what it says. */
static tm_status skip_neighbours(reader *r)
{
    int64_t flag = 0;
    size_t count = r->polygons.count;
    tm_lists skipped = {0};
    tm_status status = begin_lists(r, &skipped);
    if (status == TM_OK)
        status =
            next_integer(r, "whether neighbours follow", INT32_MIN, INT32_MAX, &flag);
    for (size_t p = 0; p < count && status == TM_OK && flag != 0; p++) {
        skipped.count = 0;
        status =
            read_list(r, &skipped, "the number of neighbours of a polygon", 0, count);
    }
    tm_lists_free(&skipped);
    return status;
}

/* What follows the polygons, with the flag or without it: what fits up to the end of the
 * file. (0 and nothing more is the flag of a file that is cut short.) If nothing fits,
 * the error is that of what fits farther. */
static tm_status read_rest(reader *r)
{
    const place begin = r->at;
    tm_error *const error = r->error, with_flag;
    r->error = &with_flag;
    tm_status status = skip_neighbours(r);
    if (status == TM_OK)
        status = read_polyhedra(r, 0);
    r->error = error;
    if (status == TM_OK)
        return TM_OK;
    if (status != TM_ERROR_INPUT)
        return tm_fail_as(error, &with_flag);
    const char *reached = r->at.scan.at;
    r->at = begin;
    status = read_polyhedra(r, 1);
    if (status == TM_ERROR_INPUT && reached >= r->at.scan.at)
        tm_fail_as(error, &with_flag);
    return status;
}

/* The stream ----------------------------------------------------------------------- */

static tm_status add_surface(reader *r, tm_stream *stream)
{
    const tm_lists *polygons = &r->polygons;
    for (size_t p = 0; p < polygons->count; p++)
        if (polygons->start[p + 1] - polygons->start[p] != TRIANGLE)
            return tm_fail_at(r->error, TM_ERROR_INPUT, r->at.scan.name, 0, NULL,
                              "polygon %zu of the surface has %zu corners (a stream has "
                              "surfaces of triangles)",
                              p, polygons->start[p + 1] - polygons->start[p]);
    tm_block *face = tm_stream_add(stream, ".face");
    if (!face)
        return tm_fail_memory(r->error);
    tm_status status = tm_block_allocate(face, polygons->count, 0, r->error);
    if (status == TM_OK && polygons->count > 0)
        memcpy(face->integer, polygons->item,
               TRIANGLE * polygons->count * sizeof *face->integer);
    return status;
}

/* ---------------------------------------------------------------------------------- */

static tm_status read_head(reader *r)
{
    static const char no_visf[] = "is no ViSF file (it begins with 0, 1 or 2 for the "
                                  "byte order or text, and 0, 1 or 2 for the type)";
    tm_scan *scan = &r->at.scan;
    int64_t order, type = POINTS;
    const int first = scan->at < scan->end ? *scan->at : EOF;
    if (first == '0' || first == '1' || first == 0 || first == 1) {
        r->at.big = first == '0' || first == 0;
        scan->at++;
    } else {
        r->at.text = true;
        if (tm_scan_next_integer(scan, "", TEXT, TEXT, &order, r->error) != TM_OK)
            return tm_fail_at(r->error, TM_ERROR_INPUT, scan->name, 0, NULL, no_visf);
    }
    if (next_integer(r, "the type", POINTS, POLYHEDRA, &type) != TM_OK)
        return tm_fail_at(r->error, TM_ERROR_INPUT, scan->name, 0, NULL, no_visf);
    r->type = (int)type;
    return TM_OK;
}

static tm_status read_all(reader *r, tm_stream *stream)
{
    tm_status status = read_head(r);
    if (status != TM_OK)
        return status;
    r->node = tm_stream_add(stream, ".node");
    if (!r->node)
        return tm_fail_memory(r->error);
    status = read_points(r);
    if (r->type == POINTS) {
        if (status == TM_OK && !is_at_end(r))
            status = fail(r, "there is more behind the last point");
        return status;
    }
    if (status == TM_OK)
        status = read_polygons(r);
    if (status == TM_OK)
        status = read_rest(r);
    if (status != TM_OK)
        return status;
    if (r->type == POLYGONS)
        return add_surface(r, stream);
    return tm_polyhedra_to_stream(stream, &r->polygons, &r->polyhedra, r->at.scan.name,
                                  r->repairs, r->error);
}

tm_status tm_visf_read(tm_stream *stream, const char *bytes, size_t size,
                       const char *name, tm_polyhedra_repairs *repairs, tm_error *error)
{
    reader r = {.repairs = repairs, .error = error};
    *repairs = (tm_polyhedra_repairs){0};
    tm_scan_begin(&r.at.scan, bytes, size, name, '#');
    tm_status status = read_all(&r, stream);
    tm_lists_free(&r.polygons);
    tm_lists_free(&r.polyhedra);
    if (status != TM_OK)
        tm_stream_free(stream);
    stream->base = 0;
    return status;
}
