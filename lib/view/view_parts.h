/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of this folder have in common. */
#ifndef TM_VIEW_PARTS_H
#define TM_VIEW_PARTS_H

#include "../element/shape.h"
#include "../mesh/cell_faces.h"
#include "../text/json.h"
#include "view.h"

/* Sides of facets in the page, as TM_NONE: the cell there is not in the page. */
#define TM_VIEW_LEFT_OUT (TM_NONE - 1)

/* A page in the making. Arrays are elements of `data`, and numbered. */
typedef struct view_writer {
    tm_json json;
    tm_text *data;
    size_t arrays;
    unsigned threads;
    double centre[3];
    double scale; /* coordinates in the page: (x - centre) / scale */
} view_writer;

/* One mesh, and which of its elements are in the page. */
typedef struct view_source {
    const tm_stream *stream;
    tm_content content;
    const tm_block *node;
    const tm_block *cell; /* the elements: of points .node */
    size_t kept;
    uint32_t *number; /* [kept] ascending; NULL: all are */
    uint8_t *outer;   /* [kept]: bit i: face i (shape.h) is on the boundary; NULL as well,
                         and of polyhedra */
} view_source;

/* Element k of the page in its block. */
static inline size_t view_element(const view_source *s, size_t k)
{
    return s->number ? s->number[k] : k;
}

/* Append an array to the page, and {"array":…,"type":…,"count":…} under the key to
 * the header: of numbers of 32 bits that are "u32" or "f32" as they are, or of bytes. */
void tm_view_numbers(view_writer *w, const char *key, const char *type,
                     const uint32_t *number, size_t count);
void tm_view_bytes(view_writer *w, const char *key, const uint8_t *byte, size_t count);

/* The bits of a value as a 32-bit float: the nearest, finite one. rounded: with 16
 * significant bits. */
uint32_t tm_view_float(double value);
uint32_t tm_view_float_rounded(double value);

/* Chooses what of a mesh is in the page: everything up to `most` elements, see
 * tm_view_options. *s has stream to content; number and outer are to be freed. */
tm_status tm_view_keep(view_source *s, size_t most, unsigned threads, tm_error *error);

/* Appends the members "fields" (measures, attributes, markers of elements and nodes). */
tm_status tm_view_fields(view_writer *w, const view_source *s, tm_error *error);

/* The measure by which elements are bad: value[e] of all elements of the block,
 * malloc'ed; NULL for points and surfaces. */
tm_status tm_view_quality(const view_source *s, unsigned threads, double **value,
                          tm_error *error);

/* Appends an object that is the mesh: its arrays, its fields, its names. */
tm_status tm_view_put_mesh(view_writer *w, const view_source *s, const char *name,
                           tm_error *error);

/* A string of any bytes: what is no UTF-8 and control characters as they can be shown. */
void tm_view_string(tm_json *json, const char *key, const char *bytes);

#endif
