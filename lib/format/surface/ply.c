/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../../base/array.h"
#include "../../number/number.h"
#include "../binary.h"
#include "../scan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POLYGON_MIN = 3 };

typedef enum { ASCII, LITTLE_ENDIAN_BINARY, BIG_ENDIAN_BINARY } encoding;

typedef struct {
    const char *name; /* and its older one */
    const char *other;
    size_t size;
    bool is_signed;
    bool is_real;
} type;

static const type types[] = {
    {"char", "int8", 1, true, false},    {"uchar", "uint8", 1, false, false},
    {"short", "int16", 2, true, false},  {"ushort", "uint16", 2, false, false},
    {"int", "int32", 4, true, false},    {"uint", "uint32", 4, false, false},
    {"float", "float32", 4, true, true}, {"double", "float64", 8, true, true},
};

/* What a property is to us. */
typedef enum { SKIPPED, X, Y, Z, CORNERS, MARKER } meaning;

typedef struct {
    meaning meaning;
    const type *length; /* of a list, the type of its length; else NULL */
    const type *type;
} property;

typedef enum { OTHER, VERTEX, FACE } element_kind;

typedef struct {
    element_kind kind;
    int64_t count;
    size_t properties;
    property *property;
    size_t capacity;
} element;

typedef struct {
    tm_scan scan;
    encoding encoding;
    size_t elements;
    element *element;
    size_t capacity;
    tm_polygon_surface *surface;
    tm_error *error;
} reader;

/* Header ------------------------------------------------------------------------ */

static tm_status read_type(reader *r, const type **found)
{
    tm_word word = tm_scan_word(&r->scan);
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (tm_word_is(word, types[i].name) || tm_word_is(word, types[i].other)) {
            *found = &types[i];
            return TM_OK;
        }
    return tm_scan_fail(&r->scan, r->error, "'%.*s' is no type of PLY (float, int, …)",
                        tm_word_shown(word), word.begin);
}

static meaning meaning_of(element_kind kind, tm_word name, bool is_list)
{
    if (kind == VERTEX && !is_list && name.size == 1 && *name.begin >= 'x' &&
        *name.begin <= 'z')
        return (meaning)(X + (*name.begin - 'x'));
    if (kind == FACE && is_list &&
        (tm_word_is(name, "vertex_indices") || tm_word_is(name, "vertex_index")))
        return CORNERS;
    if (kind == FACE && !is_list && tm_word_is(name, "marker"))
        return MARKER;
    return SKIPPED;
}

static tm_status read_format(reader *r)
{
    static const char *const names[] = {"ascii", "binary_little_endian",
                                        "binary_big_endian"};
    tm_word word = tm_scan_word(&r->scan);
    for (int i = 0; i <= BIG_ENDIAN_BINARY; i++)
        if (tm_word_is(word, names[i])) {
            r->encoding = (encoding)i;
            return TM_OK;
        }
    return tm_scan_fail(&r->scan, r->error,
                        "'%.*s' is no format of PLY (ascii, binary_little_endian or "
                        "binary_big_endian)",
                        tm_word_shown(word), word.begin);
}

static tm_status read_element(reader *r)
{
    element new = {0};
    tm_word word = tm_scan_word(&r->scan);
    if (tm_word_is(word, "vertex"))
        new.kind = VERTEX;
    else if (tm_word_is(word, "face"))
        new.kind = FACE;
    tm_status status = tm_scan_integer(&r->scan, "the number of elements", 0, INT64_MAX,
                                       &new.count, r->error);
    if (status != TM_OK)
        return status;
    for (size_t e = 0; e < r->elements; e++)
        if (new.kind != OTHER && r->element[e].kind == new.kind)
            return tm_scan_fail(&r->scan, r->error, "a second element %.*s",
                                tm_word_shown(word), word.begin);
    element *grown = tm_grow(r->element, &r->capacity, r->elements + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(r->error);
    r->element = grown;
    grown[r->elements++] = new;
    return TM_OK;
}

static tm_status read_property(reader *r)
{
    if (r->elements == 0)
        return tm_scan_fail(&r->scan, r->error, "a property before the first element");
    element *owner = &r->element[r->elements - 1];
    property new = {0};
    tm_scan ahead = r->scan;
    tm_status status = TM_OK;
    if (tm_word_is(tm_scan_word(&ahead), "list")) {
        r->scan = ahead;
        status = read_type(r, &new.length);
        if (status == TM_OK && new.length->is_real)
            status =
                tm_scan_fail(&r->scan, r->error,
                             "the length of a list is a real number (uchar, int, …)");
    }
    if (status == TM_OK)
        status = read_type(r, &new.type);
    if (status != TM_OK)
        return status;
    new.meaning = meaning_of(owner->kind, tm_scan_word(&r->scan), new.length != NULL);
    if (new.meaning >= CORNERS &&new.type->is_real)
        return tm_scan_fail(&r->scan, r->error, "%s are real numbers (int or uint)",
                            new.meaning == CORNERS ? "vertex_indices" : "markers");
    r->surface->has_facet_markers |= new.meaning == MARKER;
    for (size_t p = 0; p < owner->properties; p++)
        if (new.meaning != SKIPPED && owner->property[p].meaning == new.meaning)
            return tm_scan_fail(&r->scan, r->error, "the property is there twice");
    property *grown =
        tm_grow(owner->property, &owner->capacity, owner->properties + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(r->error);
    owner->property = grown;
    grown[owner->properties++] = new;
    return TM_OK;
}

/* "marker N NAME" is the name of a marker, where neither has one yet; all else is not for
 * us. */
static tm_status read_comment(reader *r)
{
    tm_block *group = &r->surface->group;
    int64_t value = 0;
    if (!tm_word_is(tm_scan_word(&r->scan), "marker"))
        return TM_OK;
    const tm_word number = tm_scan_word(&r->scan), rest = tm_scan_rest(&r->scan);
    const char *end = number.begin + number.size;
    if (tm_read_int64(number.begin, end, &value) != end || value != (int32_t)value)
        return TM_OK;
    tm_text name = {0};
    tm_group_clean(&name, rest.begin, rest.size);
    tm_status status = name.failed ? tm_fail_memory(r->error) : TM_OK;
    if (status == TM_OK && name.size > 0 &&
        !tm_group_find(group, TM_GROUP_FACES, (int32_t)value) &&
        !tm_group_named(group, TM_GROUP_FACES, name.byte, name.size))
        status = tm_group_add(group, TM_GROUP_FACES, (int32_t)value, name.byte, r->error);
    tm_text_free(&name);
    return status;
}

static tm_status read_header_line(reader *r, tm_word word)
{
    if (tm_word_is(word, "format"))
        return read_format(r);
    if (tm_word_is(word, "element"))
        return read_element(r);
    if (tm_word_is(word, "property"))
        return read_property(r);
    if (tm_word_is(word, "comment"))
        return read_comment(r);
    if (tm_word_is(word, "obj_info"))
        return TM_OK;
    return tm_scan_fail(&r->scan, r->error,
                        "'%.*s' is no keyword of a PLY header (element, property, "
                        "end_header, …)",
                        tm_word_shown(word), word.begin);
}

static bool has(const element *e, meaning what)
{
    for (size_t p = 0; p < e->properties; p++)
        if (e->property[p].meaning == what)
            return true;
    return false;
}

/* Vertices are there, before the faces, with all coordinates; faces have corners. */
static tm_status check_header(reader *r)
{
    bool vertices = false;
    for (size_t i = 0; i < r->elements; i++) {
        const element *e = &r->element[i];
        if (e->kind == VERTEX && !(has(e, X) && has(e, Y) && has(e, Z)))
            return tm_scan_fail(&r->scan, r->error, "vertices without x, y or z");
        if (e->kind == FACE && !has(e, CORNERS))
            return tm_scan_fail(&r->scan, r->error, "faces without vertex_indices");
        if (e->kind == FACE && !vertices)
            return tm_scan_fail(&r->scan, r->error, "faces come before the vertices");
        vertices |= e->kind == VERTEX;
    }
    if (!vertices)
        return tm_scan_fail(&r->scan, r->error, "has no element vertex");
    return TM_OK;
}

static tm_status read_header(reader *r)
{
    if (!tm_word_is(tm_scan_word(&r->scan), "ply"))
        return tm_scan_fail(&r->scan, r->error, "does not begin with 'ply'");
    for (;;) {
        tm_scan_end_line(&r->scan);
        if (!tm_scan_seek(&r->scan))
            return tm_scan_fail(&r->scan, r->error, "the file ends before end_header");
        tm_word word = tm_scan_word(&r->scan);
        if (tm_word_is(word, "end_header"))
            break;
        tm_status status = read_header_line(r, word);
        if (status != TM_OK)
            return status;
    }
    tm_scan_end_line(&r->scan);
    return check_header(r);
}

/* Values ------------------------------------------------------------------------ */

/* The next bytes of binary data. */
static tm_status take(reader *r, const type *t, const char **bytes)
{
    *bytes = r->scan.at;
    if ((size_t)(r->scan.end - r->scan.at) < t->size)
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->scan.name, 0, NULL,
                          "the file ends early: %zu vertices and %zu faces were read",
                          r->surface->nodes, r->surface->polygons);
    r->scan.at += t->size;
    return TM_OK;
}

static tm_status read_integer(reader *r, const type *t, int64_t *value)
{
    if (r->encoding == ASCII)
        return tm_scan_next_integer(&r->scan, "an integer", INT64_MIN, INT64_MAX, value,
                                    r->error);
    const char *bytes;
    tm_status status = take(r, t, &bytes);
    if (status != TM_OK)
        return status;
    uint64_t bits = tm_binary_unsigned(bytes, t->size, r->encoding == BIG_ENDIAN_BINARY);
    uint64_t sign = UINT64_C(1) << (8 * t->size - 1);
    *value = t->is_signed ? (int64_t)(bits ^ sign) - (int64_t)sign : (int64_t)bits;
    return TM_OK;
}

static tm_status read_real(reader *r, const type *t, double *value)
{
    int64_t integer = 0;
    if (r->encoding == ASCII)
        return tm_scan_next_double(&r->scan, "a number", value, r->error);
    if (!t->is_real) {
        tm_status status = read_integer(r, t, &integer);
        *value = (double)integer;
        return status;
    }
    const char *bytes;
    bool big = r->encoding == BIG_ENDIAN_BINARY;
    tm_status status = take(r, t, &bytes);
    if (status != TM_OK)
        return status;
    *value = t->size == sizeof(float) ? (double)tm_binary_float(bytes, big)
                                      : tm_binary_double(bytes, big);
    if (!isfinite(*value))
        return tm_fail_at(r->error, TM_ERROR_INPUT, r->scan.name, 0, NULL,
                          "vertex %zu: a coordinate is not a finite number",
                          r->surface->nodes);
    return TM_OK;
}

static tm_status skip(reader *r, const type *t)
{
    const char *bytes;
    if (r->encoding != ASCII)
        return take(r, t, &bytes);
    if (!tm_scan_seek(&r->scan) || tm_scan_word(&r->scan).size == 0)
        return tm_scan_fail(&r->scan, r->error, "the file ends where a number should be");
    return TM_OK;
}

/* Elements ---------------------------------------------------------------------- */

/* Where the data are binary, messages count faces; in text they name the line. */
static tm_status fail_face(reader *r, const char *what, int64_t value, const char *right)
{
    size_t line = r->encoding == ASCII ? r->scan.line : 0;
    return tm_fail_at(r->error, TM_ERROR_INPUT, r->scan.name, line, NULL,
                      "face %zu: %s %lld (%s)", r->surface->polygons, what,
                      (long long)value, right);
}

static tm_status read_corners(reader *r, const property *p, int64_t length)
{
    if (length < POLYGON_MIN)
        return fail_face(r, "the number of corners is", length, "three or more");
    tm_status status = TM_OK;
    for (int64_t i = 0; i < length && status == TM_OK; i++) {
        int64_t node = 0;
        status = read_integer(r, p->type, &node);
        if (status != TM_OK)
            return status;
        if (node < 0 || node >= (int64_t)r->surface->nodes)
            return fail_face(r, "there is no vertex", node, "they are counted from 0");
        status = tm_polygon_surface_add_corner(r->surface, (uint32_t)node, r->error);
    }
    if (status == TM_OK)
        status = tm_polygon_surface_end_face(r->surface, r->error);
    return status;
}

static tm_status read_marker(reader *r, const property *p, int32_t *marker)
{
    int64_t value = 0;
    const tm_status status = read_integer(r, p->type, &value);
    if (status == TM_OK && value != (int32_t)value)
        return fail_face(r, "the marker is", value, "a number of 32 bits");
    *marker = (int32_t)value;
    return status;
}

/* One property of a vertex, into xyz, or of a face, which is added, or into *marker. */
static tm_status read_value(reader *r, const property *p, double xyz[3], int32_t *marker)
{
    int64_t length = 1;
    tm_status status = TM_OK;
    if (p->length)
        status = read_integer(r, p->length, &length);
    if (status != TM_OK)
        return status;
    if (length < 0)
        return fail_face(r, "the length of a list is", length, "0 or more");
    if (p->meaning == CORNERS)
        return read_corners(r, p, length);
    if (p->meaning == MARKER)
        return read_marker(r, p, marker);
    if (p->meaning != SKIPPED)
        return read_real(r, p->type, &xyz[p->meaning - X]);
    for (int64_t i = 0; i < length && status == TM_OK; i++)
        status = skip(r, p->type);
    return status;
}

static tm_status read_elements(reader *r, const element *e)
{
    tm_status status = TM_OK;
    /* An element without properties has no data; its count is only a claim. */
    int64_t count = e->properties > 0 ? e->count : 0;
    for (int64_t i = 0; i < count && status == TM_OK; i++) {
        double xyz[3] = {0};
        int32_t marker = 0;
        for (size_t p = 0; p < e->properties && status == TM_OK; p++)
            status = read_value(r, &e->property[p], xyz, &marker);
        if (status == TM_OK && e->kind == VERTEX)
            status = tm_polygon_surface_add_node(r->surface, xyz, r->error);
        if (status == TM_OK && e->kind == FACE)
            r->surface->facet_marker[r->surface->facets - 1] = marker;
    }
    return status;
}

tm_status tm_ply_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    reader r = {.surface = surface, .error = error};
    tm_scan_begin(&r.scan, bytes, size, name, '\0');
    tm_status status = read_header(&r);
    for (size_t e = 0; e < r.elements && status == TM_OK; e++)
        status = read_elements(&r, &r.element[e]);
    for (size_t e = 0; e < r.elements; e++)
        free(r.element[e].property);
    free(r.element);
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}
