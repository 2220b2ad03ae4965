/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "visf.h"

#include "../base/array.h"
#include "binary.h"
#include "../mesh/cell_orient.h"
#include "../mesh/polygon_table.h"
#include "scan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS, POLYGONS, POLYHEDRA };
enum { TEXT = 2, COORDINATES = 3, TRIANGLE = 3, TETRAHEDRON = 4, WORD = 4 };

/* Lists of numbers, one after another. */
typedef struct lists {
    size_t count;
    size_t *start; /* [count + 1] */
    uint32_t *item;
    size_t start_room, item_room;
} lists;

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
    lists polygons;
    lists polyhedra;
    tm_visf_repairs *repairs;
    tm_error *error;
} reader;

static tm_status fail(reader *r, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static tm_status fail(reader *r, const char *format, ...)
{
    char what[sizeof((tm_error){0}).what];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return tm_fail_at(r->error, TM_ERROR_INPUT, r->at.scan.name,
                      r->at.text ? r->at.scan.line : 0, NULL, "%s", what);
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
static tm_status read_list(reader *r, lists *to, const char *what, size_t least,
                           size_t limit)
{
    size_t k = 0, begin = to->start[to->count];
    tm_status status = next_count(r, what, 1, &k);
    if (status != TM_OK)
        return status;
    if (k < least)
        return fail(r, "%s is %zu (%zu or more would be right)", what, k, least);
    uint32_t *item = tm_grow(to->item, &to->item_room, begin + k, sizeof *item);
    if (!item)
        return tm_fail_memory(r->error);
    to->item = item;
    for (size_t i = 0; i < k && status == TM_OK; i++) {
        int64_t number = 0;
        status = next_integer(r, "a number in the list", 0, (int64_t)limit - 1, &number);
        item[begin + i] = (uint32_t)number;
    }
    size_t *start = tm_grow(to->start, &to->start_room, to->count + 2, sizeof *to->start);
    if (status == TM_OK && !start)
        status = tm_fail_memory(r->error);
    to->start = start ? start : to->start;
    if (status == TM_OK)
        start[++to->count] = begin + k;
    return status;
}

static tm_status begin_lists(reader *r, lists *to)
{
    free(to->start);
    free(to->item);
    *to = (lists){0};
    to->start = tm_grow(NULL, &to->start_room, 1, sizeof *to->start);
    if (!to->start)
        return tm_fail_memory(r->error);
    to->start[0] = 0;
    return TM_OK;
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
    lists skipped = {0};
    tm_status status = begin_lists(r, &skipped);
    if (status == TM_OK)
        status =
            next_integer(r, "whether neighbours follow", INT32_MIN, INT32_MAX, &flag);
    for (size_t p = 0; p < count && status == TM_OK && flag != 0; p++) {
        skipped.count = 0;
        status =
            read_list(r, &skipped, "the number of neighbours of a polygon", 0, count);
    }
    free(skipped.start);
    free(skipped.item);
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
    const lists *polygons = &r->polygons;
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

/* Makes all polygons that are the same one, and drops those that no polyhedron has: the
 * polyhedra then name polygons as they are numbered then. */
static tm_status join_polygons(reader *r)
{
    lists *polygons = &r->polygons, *polyhedra = &r->polyhedra;
    size_t count = polygons->count, kept = 0, end = 0;
    uint32_t *name = tm_new(count, sizeof *name); /* the first that is the same */
    tm_polygon_table table = {0};
    bool done = name != NULL;
    for (size_t p = 0; p < count && done; p++)
        done = tm_polygon_table_join(&table, polygons->start, polygons->item, (uint32_t)p,
                                     &name[p]);
    tm_polygon_table_free(&table);
    unsigned char *used = calloc(count + 1, 1);
    if (!done || !used) {
        free(name);
        free(used);
        return tm_fail_memory(r->error);
    }
    size_t items = polyhedra->start[polyhedra->count];
    for (size_t i = 0; i < items; i++) {
        r->repairs->joined += name[polyhedra->item[i]] != polyhedra->item[i];
        polyhedra->item[i] = name[polyhedra->item[i]];
        used[polyhedra->item[i]] = 1;
    }
    for (size_t p = 0; p < count; p++) {
        size_t begin = polygons->start[p], k = polygons->start[p + 1] - begin;
        r->repairs->dropped += name[p] == p && !used[p];
        if (!used[p])
            continue;
        memmove(polygons->item + end, polygons->item + begin, k * sizeof *polygons->item);
        polygons->start[kept] = end;
        end += k;
        name[p] = (uint32_t)kept++;
    }
    polygons->start[kept] = end;
    polygons->count = kept;
    for (size_t i = 0; i < items; i++)
        polyhedra->item[i] = name[polyhedra->item[i]];
    free(name);
    free(used);
    return TM_OK;
}

/* A polygon is in two polyhedra at most, and only once in each. */
static tm_status check_uses(reader *r, tm_block *facet)
{
    const lists *polyhedra = &r->polyhedra;
    memset(facet->integer, UINT8_MAX, 2 * facet->count * sizeof *facet->integer);
    for (size_t c = 0; c < polyhedra->count; c++)
        for (size_t i = polyhedra->start[c]; i < polyhedra->start[c + 1]; i++) {
            uint32_t *side = facet->integer + 2 * (size_t)polyhedra->item[i];
            if (side[0] == c || side[1] != TM_NONE)
                return tm_fail_at(r->error, TM_ERROR_INPUT, r->at.scan.name, 0, NULL,
                                  "polyhedron %zu has a polygon twice, or one that two "
                                  "others have",
                                  c);
            side[side[0] != TM_NONE] = (uint32_t)c;
        }
    return TM_OK;
}

static void reverse(uint32_t *node, size_t k)
{
    for (size_t i = 1, j = k - 1; i < j; i++, j--) {
        uint32_t swapped = node[i];
        node[i] = node[j];
        node[j] = swapped;
    }
}

/* Side 0 becomes the cell that the facet is outward for; where there is one cell and the
 * facet is inward, the facet is turned. */
static void set_sides(reader *r, tm_block *facet, const bool *inward)
{
    const lists *polyhedra = &r->polyhedra;
    memset(facet->integer, UINT8_MAX, 2 * facet->count * sizeof *facet->integer);
    for (size_t c = 0; c < polyhedra->count; c++)
        for (size_t i = polyhedra->start[c]; i < polyhedra->start[c + 1]; i++)
            facet->integer[2 * (size_t)polyhedra->item[i] + inward[i]] = (uint32_t)c;
    for (size_t f = 0; f < facet->count; f++) {
        uint32_t *side = facet->integer + 2 * f;
        if (side[0] != TM_NONE)
            continue;
        side[0] = side[1];
        side[1] = TM_NONE;
        reverse(facet->item + facet->start[f], facet->start[f + 1] - facet->start[f]);
        r->repairs->turned++;
    }
}

static tm_status orient(reader *r, tm_block *facet)
{
    const lists *polyhedra = &r->polyhedra;
    size_t uses = polyhedra->start[polyhedra->count];
    const tm_polygon_cells mesh = {r->node->count,   (const double(*)[3])r->node->real,
                                   facet->count,     facet->start,
                                   facet->item,      polyhedra->count,
                                   polyhedra->start, polyhedra->item};
    bool *inward = tm_new(uses, sizeof *inward);
    tm_status status = inward ? check_uses(r, facet) : tm_fail_memory(r->error);
    if (status == TM_OK) {
        tm_error cause;
        status = tm_cells_orient(&mesh, inward, &cause);
        if (status == TM_ERROR_INPUT)
            tm_fail_at(r->error, status, r->at.scan.name, 0, NULL, "%s", cause.what);
        else if (status != TM_OK)
            tm_fail_as(r->error, &cause);
    }
    if (status == TM_OK)
        set_sides(r, facet, inward);
    free(inward);
    return status;
}

/* Adds a block with a copy of the lists. */
static tm_status add_lists(reader *r, tm_stream *stream, const char *name,
                           const lists *from, tm_block **block)
{
    *block = tm_stream_add(stream, name);
    if (!*block)
        return tm_fail_memory(r->error);
    size_t items = from->start[from->count];
    tm_status status = tm_block_allocate(*block, from->count, items, r->error);
    if (status != TM_OK)
        return status;
    memcpy((*block)->start, from->start, (from->count + 1) * sizeof *from->start);
    if (items > 0)
        memcpy((*block)->item, from->item, items * sizeof *from->item);
    return TM_OK;
}

static tm_status add_polyhedra(reader *r, tm_stream *stream)
{
    tm_block *facet, *cell;
    tm_status status = join_polygons(r);
    if (status == TM_OK)
        status = add_lists(r, stream, ".facet", &r->polygons, &facet);
    r->node = tm_stream_find(stream, ".node"); /* adding may move blocks */
    if (status == TM_OK)
        status = orient(r, facet);
    if (status == TM_OK)
        status = add_lists(r, stream, ".cell", &r->polyhedra, &cell);
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
    return r->type == POLYGONS ? add_surface(r, stream) : add_polyhedra(r, stream);
}

tm_status tm_visf_read(tm_stream *stream, const char *bytes, size_t size,
                       const char *name, tm_visf_repairs *repairs, tm_error *error)
{
    reader r = {.repairs = repairs, .error = error};
    *repairs = (tm_visf_repairs){0};
    tm_scan_begin(&r.at.scan, bytes, size, name, '#');
    tm_status status = read_all(&r, stream);
    free(r.polygons.start);
    free(r.polygons.item);
    free(r.polyhedra.start);
    free(r.polyhedra.item);
    if (status != TM_OK)
        tm_stream_free(stream);
    stream->base = 0;
    return status;
}
