/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "visf.h"

#include "../base/array.h"
#include "../number/number.h"
#include "binary.h"
#include "../mesh/cell_faces.h"
#include "../mesh/polygon_edges.h"

#include <math.h>
#include <stdlib.h>

enum { POINTS, POLYGONS, POLYHEDRA };
enum { FLOAT_DIGITS = 9, WORD = 4, BUFFER = 1 << 14 };

typedef struct writer {
    const tm_visf_options *options;
    tm_cell_faces faces;
    size_t polygons;
    tm_text *text;
    char buffer[BUFFER + TM_DOUBLE_CHARS + 1]; /* not yet in text */
    size_t size;
    bool in_line; /* a number stands before in this line */
    tm_error *error;
} writer;

/* Numbers -------------------------------------------------------------------------- */

static void flush(writer *w)
{
    tm_text_append(w->text, w->buffer, w->size);
    w->size = 0;
}

static char *next(writer *w)
{
    if (w->size > BUFFER)
        flush(w);
    if (w->in_line)
        w->buffer[w->size++] = ' ';
    w->in_line = w->options->order == TM_VISF_TEXT;
    return w->buffer + w->size;
}

static void put(writer *w, size_t number)
{
    char *at = next(w), *end = at + WORD;
    if (w->options->order == TM_VISF_TEXT)
        end = tm_write_uint32(at, (uint32_t)number);
    else
        tm_binary_put_unsigned(at, number, WORD, w->options->order == TM_VISF_BIG);
    w->size += (size_t)(end - at);
}

static void put_real(writer *w, double number)
{
    char *at = next(w), *end = at + WORD;
    if (w->options->order == TM_VISF_TEXT)
        end = tm_write_rounded(at, number, FLOAT_DIGITS);
    else
        tm_binary_put_float(at, (float)number, w->options->order == TM_VISF_BIG);
    w->size += (size_t)(end - at);
}

static void end_line(writer *w)
{
    if (w->options->order == TM_VISF_TEXT)
        w->buffer[w->size++] = '\n';
    w->in_line = false;
}

/* A number on a line of its own. */
static void put_line(writer *w, size_t number)
{
    put(w, number);
    end_line(w);
}

/* Parts ---------------------------------------------------------------------------- */

static tm_status write_points(writer *w, const tm_block *node)
{
    enum { COORDINATES = 3 };
    put_line(w, node->count);
    for (size_t i = 0; i < COORDINATES * node->count; i++) {
        if (!isfinite((float)node->real[i]))
            return tm_fail_at(w->error, TM_ERROR_INPUT, NULL, 0, ".node",
                              "%g is too large for a 32-bit float, which ViSF has",
                              node->real[i]);
        put_real(w, node->real[i]);
        if (i % COORDINATES == COORDINATES - 1)
            end_line(w);
    }
    return TM_OK;
}

static void write_polygon(writer *w, size_t f, bool turn)
{
    size_t begin = w->faces.start[f], k = w->faces.start[f + 1] - begin;
    put(w, k);
    for (size_t i = 0; i < k; i++)
        put(w, w->faces.node[begin + (turn ? k - 1 - i : i)]);
    end_line(w);
}

static void write_polygons(writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    put_line(w, w->polygons);
    if (!w->options->per_cell) {
        for (size_t f = 0; f < faces->facets; f++)
            write_polygon(w, f, false);
        return;
    }
    for (size_t c = 0; c < faces->cells; c++)
        for (size_t i = faces->cell_start[c]; i < faces->cell_start[c + 1]; i++) {
            size_t f = faces->cell_facet[i];
            write_polygon(w, f, !tm_facet_is_outward(faces, f, c));
        }
}

static void write_polyhedra(writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    put_line(w, faces->cells);
    for (size_t c = 0; c < faces->cells; c++) {
        put(w, faces->cell_start[c + 1] - faces->cell_start[c]);
        for (size_t i = faces->cell_start[c]; i < faces->cell_start[c + 1]; i++)
            put(w, w->options->per_cell ? i : faces->cell_facet[i]);
        end_line(w);
    }
}

/* Neighbours ----------------------------------------------------------------------- */

/* The polygons that are written: the facets, or those of each cell as its group. */
typedef struct soup {
    size_t *start;
    uint32_t *node;
    uint32_t *group; /* NULL for the facets */
} soup;

static tm_status make_soup(const writer *w, soup *polygons, size_t corners)
{
    const tm_cell_faces *faces = &w->faces;
    *polygons = (soup){tm_new(w->polygons + 1, sizeof *polygons->start),
                       tm_new(corners, sizeof *polygons->node),
                       tm_new(w->polygons, sizeof *polygons->group)};
    if (!polygons->start || !polygons->node || !polygons->group)
        return tm_fail_memory(w->error);
    size_t at = 0;
    for (size_t c = 0; c < faces->cells; c++)
        for (size_t i = faces->cell_start[c]; i < faces->cell_start[c + 1]; i++) {
            size_t f = faces->cell_facet[i];
            polygons->start[i] = at;
            polygons->group[i] = (uint32_t)c;
            for (size_t j = faces->start[f]; j < faces->start[f + 1]; j++)
                polygons->node[at++] = faces->node[j];
        }
    polygons->start[w->polygons] = at;
    return TM_OK;
}

/* The other polygons at the edges of polygon p, each once: *list has `count` of them and
 * room for *room. seen[q] is p + 1 for those that were found. */
static tm_status find_neighbours(const writer *w, const tm_polygon_edges *edges,
                                 const size_t *start, size_t p, uint32_t *seen,
                                 uint32_t **list, size_t *room, size_t *count)
{
    *count = 0;
    seen[p] = (uint32_t)p + 1;
    for (size_t i = start[p]; i < start[p + 1]; i++) {
        size_t e = edges->edge_of[i], sides = edges->start[e + 1] - edges->start[e];
        uint32_t *grown = tm_grow(*list, room, *count + sides, sizeof **list);
        if (!grown)
            return tm_fail_memory(w->error);
        *list = grown;
        for (size_t j = edges->start[e]; j < edges->start[e + 1]; j++) {
            uint32_t q = edges->polygon[j];
            if (seen[q] != p + 1)
                grown[(*count)++] = q;
            seen[q] = (uint32_t)p + 1;
        }
    }
    return TM_OK;
}

static tm_status write_lists(writer *w, const tm_polygon_edges *edges,
                             const size_t *start)
{
    uint32_t *seen = calloc(w->polygons + 1, sizeof *seen), *list = NULL;
    size_t room = 0, count;
    tm_status status = seen ? TM_OK : tm_fail_memory(w->error);
    for (size_t p = 0; p < w->polygons && status == TM_OK; p++) {
        status = find_neighbours(w, edges, start, p, seen, &list, &room, &count);
        if (status != TM_OK)
            break;
        put(w, count);
        for (size_t i = 0; i < count; i++)
            put(w, list[i]);
        end_line(w);
    }
    free(seen);
    free(list);
    return status;
}

static tm_status write_neighbours(writer *w, size_t corners, size_t nodes)
{
    const tm_cell_faces *faces = &w->faces;
    soup own = {0}, polygons = {faces->start, faces->node, NULL};
    tm_polygon_edges edges = {0};
    tm_status status = TM_OK;
    if (w->options->per_cell) {
        status = make_soup(w, &own, corners);
        polygons = own;
    }
    if (status == TM_OK)
        status = tm_polygon_edges_find(&edges, w->polygons, polygons.start, polygons.node,
                                       nodes, polygons.group, faces->cells, w->error);
    if (status == TM_OK)
        status = write_lists(w, &edges, polygons.start);
    tm_polygon_edges_free(&edges);
    free(own.start);
    free(own.node);
    free(own.group);
    return status;
}

/* ---------------------------------------------------------------------------------- */

static size_t count_corners(const writer *w)
{
    const tm_cell_faces *faces = &w->faces;
    if (!w->options->per_cell)
        return faces->facets > 0 ? faces->start[faces->facets] : 0;
    size_t corners = 0;
    for (size_t i = 0; i < w->polygons; i++) {
        size_t f = faces->cell_facet[i];
        corners += faces->start[f + 1] - faces->start[f];
    }
    return corners;
}

static tm_status write_all(writer *w, const tm_block *node, int type)
{
    static const char digit[] = {
        [TM_VISF_BIG] = '0', [TM_VISF_LITTLE] = '1', [TM_VISF_TEXT] = '2'};
    w->buffer[w->size++] = digit[w->options->order];
    w->in_line = w->options->order == TM_VISF_TEXT;
    put_line(w, (size_t)type);
    tm_status status = write_points(w, node);
    if (status != TM_OK || type == POINTS)
        return status;
    write_polygons(w);
    put_line(w, w->options->neighbours);
    if (w->options->neighbours)
        status = write_neighbours(w, count_corners(w), node->count);
    if (status == TM_OK && type == POLYHEDRA)
        write_polyhedra(w);
    return status;
}

tm_status tm_visf_write(tm_text *text, const tm_stream *stream,
                        const tm_visf_options *options, tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_content content = tm_content_of(stream);
    if (content == TM_CONTENT_NOTHING)
        return tm_fail(error, TM_ERROR_INPUT, "has no nodes (.node)");
    int type = POLYHEDRA;
    if (content == TM_CONTENT_POINTS)
        type = POINTS;
    else if (content == TM_CONTENT_SURFACE)
        type = POLYGONS;
    writer *w = malloc(sizeof *w);
    if (!w)
        return tm_fail_memory(error);
    tm_visf_options effective = *options;
    effective.per_cell &= type == POLYHEDRA;
    *w = (writer){.options = &effective, .text = text, .error = error};
    tm_status status = tm_cell_faces_find(&w->faces, stream, error);
    if (status == TM_OK) {
        w->polygons =
            effective.per_cell ? w->faces.cell_start[w->faces.cells] : w->faces.facets;
        if (node->count > INT32_MAX || w->polygons > INT32_MAX)
            status = tm_fail(error, TM_ERROR_INPUT,
                             "has more nodes or polygons than ViSF's 31 bits can number");
    }
    if (status == TM_OK)
        status = write_all(w, node, type);
    flush(w);
    if (status == TM_OK && text->failed)
        status = tm_fail_memory(error);
    tm_cell_faces_free(&w->faces);
    free(w);
    return status;
}
