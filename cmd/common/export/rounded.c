/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rounded.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool is_one(double a, double b, int digits)
{
    if (a == b)
        return true;
    if (digits == ROUNDED_TO_FLOATS)
        return (float)a == (float)b;
    /* a digit more would tell them: most numbers need no text */
    if (fabs(a - b) > pow(10, 1 - digits) * fmax(fabs(a), fabs(b)))
        return false;
    char text[2][40];
    snprintf(text[0], sizeof text[0], "%.*g", digits, a);
    snprintf(text[1], sizeof text[1], "%.*g", digits, b);
    return strcmp(text[0], text[1]) == 0;
}

static bool falls_together(const double *a, const double *b, int digits)
{
    return (a[0] != b[0] || a[1] != b[1] || a[2] != b[2]) && is_one(a[0], b[0], digits) &&
           is_one(a[1], b[1], digits) && is_one(a[2], b[2], digits);
}

/* Of polygons the sides, of cells each two corners. */
static bool has_one_corner_less(const tm_block *rows, size_t r, const double *xyz,
                                int digits)
{
    const bool is_polygon = rows->kind == TM_FACET;
    size_t k;
    const uint32_t *node = tm_row_nodes(rows, r, &k);
    for (size_t i = 0; i < k; i++) {
        const size_t before = (i + k - 1) % k;
        const size_t first = is_polygon ? before : 0, past = is_polygon ? before + 1 : i;
        for (size_t j = first; j < past; j++)
            if (falls_together(xyz + 3 * (size_t)node[i], xyz + 3 * (size_t)node[j],
                               digits))
                return true;
    }
    return false;
}

void rounded_note(const filter *f, const tm_stream *stream, int digits)
{
    static const struct {
        const char *block, *rows;
    } kinds[] = {{".ele", "tetrahedra"},
                 {".mix", "elements"},
                 {".facet", "facets"},
                 {".face", "triangles"}};
    const tm_block *node = tm_stream_find(stream, ".node"), *rows = NULL;
    size_t kind = 0, count = 0;
    while (kind < sizeof kinds / sizeof *kinds &&
           !(rows = tm_stream_find(stream, kinds[kind].block)))
        kind++;
    if (!rows || !node)
        return;
    for (size_t r = 0; r < rows->count; r++)
        count += has_one_corner_less(rows, r, node->real, digits);
    if (count == 0)
        return;
    char what[40] = "32-bit floats";
    if (digits != ROUNDED_TO_FLOATS)
        snprintf(what, sizeof what, "%d digits", digits);
    filter_note(f,
                "%s: %zu of %zu %s have two corners that are one in the %s of the file",
                filter_input_name(f), count, rows->count, kinds[kind].rows, what);
}
