/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_list.h"

#include "../../base/array.h"
#include "../../geom/ears.h"
#include "../../geom/vector.h"
#include "../../number/number.h"
#include "../binary.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER = 80, TRIANGLE = 50, COORDINATES = 3, CORNERS = 3, NORMAL_DIGITS = 6 };

typedef struct {
    tm_text *text;
    const tm_polygon_list *list;
    uint32_t (*triangle)[CORNERS]; /* of one polygon */
    tm_text name;
    tm_surface_written written;
} writer;

/* Cuts polygon p as its facet, so that both sides of that get the same triangles. */
static size_t cut(const writer *w, size_t p)
{
    const tm_polygon_list *list = w->list;
    const tm_polygon *polygon = &list->polygon[p];
    const size_t start = list->faces.start[polygon->facet];
    const size_t k = list->faces.start[polygon->facet + 1] - start;
    const size_t count =
        tm_cut_ears(list->xyz, list->faces.node + start, k, list->room, w->triangle);
    for (size_t t = 0; t < count && polygon->turned; t++) {
        const uint32_t second = w->triangle[t][1];
        w->triangle[t][1] = w->triangle[t][2];
        w->triangle[t][2] = second;
    }
    return count;
}

/* The unit normal; of a flat triangle 0 0 0, which readers take for none. */
static void find_normal(const writer *w, const uint32_t *corner, double normal[3])
{
    double a[3], b[3];
    tm_subtract(a, w->list->xyz[corner[1]], w->list->xyz[corner[0]]);
    tm_subtract(b, w->list->xyz[corner[2]], w->list->xyz[corner[0]]);
    tm_cross(normal, a, b);
    const double length = sqrt(tm_norm2(normal));
    for (int c = 0; c < COORDINATES; c++)
        normal[c] = length > 0 && isfinite(length) ? normal[c] / length + 0.0 : 0;
}

/* Text ------------------------------------------------------------------------------ */

static void write_facet(const writer *w, const uint32_t *corner)
{
    double normal[3];
    find_normal(w, corner, normal);
    tm_text_string(w->text, "facet normal");
    for (int c = 0; c < COORDINATES; c++) {
        char digits[TM_DOUBLE_CHARS + 1] = " ";
        const char *end = tm_write_rounded(digits + 1, normal[c], NORMAL_DIGITS);
        tm_text_append(w->text, digits, (size_t)(end - digits));
    }
    tm_text_string(w->text, "\n outer loop\n");
    for (int i = 0; i < CORNERS; i++)
        tm_polygon_point(w->list, w->list->number[corner[i]], "  vertex ", w->text);
    tm_text_string(w->text, " endloop\nendfacet\n");
}

/* The polygons first … end - 1. */
static void write_solid(writer *w, size_t first, size_t end)
{
    if (w->list->grouped)
        tm_polygon_name(w->list, w->list->polygon[first].value, &w->name);
    const char *name = w->name.size > 0 ? w->name.byte : "";
    const char *blank = *name ? " " : "";
    tm_text_format(w->text, "solid%s%s\n", blank, name);
    for (size_t p = first; p < end; p++) {
        const size_t count = cut(w, p);
        for (size_t t = 0; t < count; t++)
            write_facet(w, w->triangle[t]);
        w->written.polygons += count;
    }
    tm_text_format(w->text, "endsolid%s%s\n", blank, name);
}

static void write_text(writer *w)
{
    const size_t polygons = w->list->polygons;
    for (size_t p = 0, end; p < polygons; p = end) {
        end = w->list->grouped ? tm_polygon_group_end(w->list, p) : polygons;
        write_solid(w, p, end);
    }
}

/* Binary ---------------------------------------------------------------------------- */

static tm_status check_size(const writer *w, tm_error *error)
{
    const tm_polygon_list *list = w->list;
    const unsigned base = list->stream->base;
    for (size_t v = 0; v < list->nodes; v++)
        for (int c = 0; c < COORDINATES; c++)
            if (fabs(list->xyz[list->node[v]][c]) > (double)FLT_MAX)
                return tm_fail(error, TM_ERROR_INPUT,
                               "node %u: %g is too large for the 32-bit floats of binary "
                               "STL (text would be right)",
                               list->node[v] + base, list->xyz[list->node[v]][c]);
    return TM_OK;
}

static bool is_same(const float a[COORDINATES], const float b[COORDINATES])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static void put_triangle(writer *w, const uint32_t *corner)
{
    char bytes[TRIANGLE] = {0}, *at = bytes;
    double normal[3];
    float point[CORNERS][COORDINATES];
    find_normal(w, corner, normal);
    for (int c = 0; c < COORDINATES; c++, at += sizeof(float))
        tm_binary_put_float(at, (float)normal[c], false);
    for (int i = 0; i < CORNERS; i++)
        for (int c = 0; c < COORDINATES; c++, at += sizeof(float)) {
            point[i][c] = (float)w->list->xyz[corner[i]][c];
            tm_binary_put_float(at, point[i][c], false);
        }
    w->written.flat += is_same(point[0], point[1]) || is_same(point[1], point[2]) ||
                       is_same(point[2], point[0]);
    tm_text_append(w->text, bytes, sizeof bytes);
}

static tm_status write_binary(writer *w, tm_error *error)
{
    char header[HEADER + sizeof(uint32_t)] = "termesh";
    const size_t at = w->text->size + HEADER;
    tm_status status = check_size(w, error);
    if (status != TM_OK)
        return status;
    tm_text_append(w->text, header, sizeof header);
    for (size_t p = 0; p < w->list->polygons; p++) {
        const size_t count = cut(w, p);
        for (size_t t = 0; t < count; t++)
            put_triangle(w, w->triangle[t]);
        w->written.polygons += count;
    }
    if (w->written.polygons > UINT32_MAX)
        return tm_fail(error, TM_ERROR_INPUT,
                       "has %zu triangles (binary STL has 32 bits for their number)",
                       w->written.polygons);
    if (!w->text->failed)
        tm_binary_put_unsigned(w->text->byte + at, w->written.polygons, sizeof(uint32_t),
                               false);
    return TM_OK;
}

/* ------------------------------------------------------------------------------------ */

tm_status tm_stl_write(tm_text *text, const tm_stream *stream,
                       const tm_surface_file *file, tm_surface_written *written,
                       tm_error *error)
{
    tm_polygon_list list;
    tm_status status = tm_polygon_list_make(&list, stream, file->of, error);
    writer w = {.text = text, .list = &list};
    if (status == TM_OK) {
        w.triangle = tm_new(list.corners, sizeof *w.triangle);
        if (!w.triangle)
            status = tm_fail_memory(error);
    }
    if (status == TM_OK && file->binary) {
        status = write_binary(&w, error);
    } else if (status == TM_OK) {
        tm_polygon_list_sort(&list);
        write_text(&w);
    }
    if (status == TM_OK && (text->failed || w.name.failed))
        status = tm_fail_memory(error);
    *written = w.written;
    free(w.triangle);
    tm_text_free(&w.name);
    tm_polygon_list_free(&list);
    return status;
}
