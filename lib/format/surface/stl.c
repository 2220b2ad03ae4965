/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../binary.h"
#include "../../surface/point_table.h"
#include "../../stream/group_markers.h"
#include "../scan.h"

#include <math.h>
#include <string.h>

/* A binary file: 80 bytes of any text, the number of triangles, and for each the normal,
 * the corners (12 floats, little endian) and two bytes for whoever wants them. */
enum { HEADER = 80, COUNT = 4, NORMAL = 12, TRIANGLE = 50, CORNERS = 3, FLOAT = 4 };

static uint64_t binary_size(const char *bytes)
{
    uint64_t triangles = tm_binary_unsigned(bytes + HEADER, COUNT, false);
    return HEADER + COUNT + triangles * TRIANGLE;
}

/* Whether what would be a triangle has a unit normal, or none. */
static bool has_normal(const char *bytes)
{
    const double least = 0.98, most = 1.02; /* squared: of float, rounded somehow */
    double norm2 = 0;
    for (int k = 0; k < 3; k++) {
        const double x = (double)tm_binary_float(bytes + FLOAT * k, false);
        norm2 += x * x;
    }
    return norm2 == 0 || (norm2 >= least && norm2 <= most);
}

/* Some programs write more behind the last triangle. Then the first triangle and the last
 * have to look like some. */
bool tm_stl_is_binary(const char *bytes, size_t size)
{
    if (size < HEADER + COUNT || binary_size(bytes) > size)
        return false;
    const uint64_t end = binary_size(bytes);
    if (end == size)
        return true;
    return end > HEADER + COUNT && memchr(bytes, '\0', HEADER + COUNT) &&
           has_normal(bytes + HEADER + COUNT) && has_normal(bytes + end - TRIANGLE);
}

/* Appends the point as a node if it is new. */
static tm_status join(tm_polygon_surface *surface, tm_point_table *table,
                      const double xyz[3], uint32_t *node, tm_error *error)
{
    uint32_t last = (uint32_t)surface->nodes;
    tm_status status = tm_polygon_surface_add_node(surface, xyz, error);
    if (status != TM_OK)
        return status;
    if (!tm_point_table_join(table, surface->xyz, last, node))
        return tm_fail_memory(error);
    if (*node != last)
        surface->nodes--;
    return TM_OK;
}

static tm_status read_binary_triangle(tm_polygon_surface *surface, tm_point_table *table,
                                      const char *bytes, size_t triangle,
                                      const char *name, tm_error *error)
{
    uint32_t corner[CORNERS];
    tm_status status = TM_OK;
    for (int i = 0; i < CORNERS && status == TM_OK; i++) {
        double xyz[3];
        for (int k = 0; k < 3; k++) {
            xyz[k] = (double)tm_binary_float(bytes + NORMAL + FLOAT * (3 * i + k), false);
            if (!isfinite(xyz[k]))
                return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                                  "triangle %zu: a coordinate is not a finite number",
                                  triangle);
        }
        status = join(surface, table, xyz, &corner[i], error);
    }
    if (status == TM_OK)
        status = tm_polygon_surface_add_polygon(surface, corner, CORNERS, error);
    return status;
}

static tm_status read_binary(tm_polygon_surface *surface, tm_point_table *table,
                             const char *bytes, size_t size, const char *name,
                             tm_error *error)
{
    if (size < HEADER + COUNT)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "%zu bytes are too few for a binary STL file (84 or more)",
                          size);
    if (binary_size(bytes) > size)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "the binary STL file has %zu bytes, but claims %llu triangles "
                          "(which are %llu bytes)",
                          size,
                          (unsigned long long)((binary_size(bytes) - HEADER) / TRIANGLE),
                          (unsigned long long)binary_size(bytes));
    const size_t triangles = (size_t)(binary_size(bytes) - HEADER - COUNT) / TRIANGLE;
    surface->left_bytes = size - (size_t)binary_size(bytes);
    tm_status status = TM_OK;
    for (size_t t = 0; t < triangles && status == TM_OK; t++)
        status = read_binary_triangle(
            surface, table, bytes + HEADER + COUNT + t * TRIANGLE, t + 1, name, error);
    return status;
}

/* The next word must be the keyword; `right` says in messages what may stand there. */
static tm_status expect_of(tm_scan *scan, const char *keyword, const char *right,
                           tm_error *error)
{
    tm_scan_seek(scan);
    tm_word word = tm_scan_word(scan);
    if (tm_word_is_like(word, keyword))
        return TM_OK;
    if (word.size == 0)
        return tm_scan_fail(scan, error, "the file ends where '%s' should be", right);
    return tm_scan_fail(scan, error, "'%.*s' (where '%s' should be)", tm_word_shown(word),
                        word.begin, right);
}

static tm_status expect(tm_scan *scan, const char *keyword, tm_error *error)
{
    return expect_of(scan, keyword, keyword, error);
}

/* "normal" and three numbers, which may be nan. */
static void skip_normal(tm_scan *scan)
{
    tm_scan_seek(scan);
    tm_scan ahead = *scan;
    if (!tm_word_is_like(tm_scan_word(&ahead), "normal"))
        return;
    for (int i = 0; i < 1 + 3; i++) {
        tm_scan_seek(scan);
        tm_scan_word(scan);
    }
}

/* What follows "facet": the normal, then "outer loop", three points, "endloop",
 * "endfacet". */
static tm_status read_facet(tm_scan *scan, tm_polygon_surface *surface,
                            tm_point_table *table, tm_error *error)
{
    uint32_t corner[CORNERS];
    skip_normal(scan);
    tm_status status = expect(scan, "outer", error);
    if (status == TM_OK)
        status = expect(scan, "loop", error);
    for (int i = 0; i < CORNERS && status == TM_OK; i++) {
        double xyz[3];
        status = expect(scan, "vertex", error);
        if (status == TM_OK)
            status = tm_scan_point(scan, xyz, error);
        if (status == TM_OK)
            status = join(surface, table, xyz, &corner[i], error);
    }
    if (status == TM_OK)
        status = expect(scan, "endloop", error);
    if (status == TM_OK)
        status = expect(scan, "endfacet", error);
    if (status == TM_OK)
        status = tm_polygon_surface_add_polygon(surface, corner, CORNERS, error);
    return status;
}

/* What follows "solid" in its line is the solid's name: the marker of its facets. */
static tm_status begin_solid(tm_scan *scan, tm_polygon_surface *surface,
                             tm_group_markers *markers, tm_error *error)
{
    const tm_word name = tm_scan_rest(scan);
    return tm_group_marker(markers, name.begin, name.size, &surface->next_marker, error);
}

/* A file of one solid without a name has no groups. */
static void end_markers(tm_polygon_surface *surface, const tm_group_markers *markers)
{
    surface->has_facet_markers = markers->values > 1 || surface->group.count > 0;
    for (size_t f = 0; f < surface->facets && !surface->has_facet_markers; f++)
        surface->facet_marker[f] = 0;
}

/* One or several solids: solid NAME, facets, endsolid NAME. */
static tm_status read_text(tm_polygon_surface *surface, tm_point_table *table,
                           const char *bytes, size_t size, const char *name,
                           tm_error *error)
{
    tm_scan scan;
    tm_group_markers markers = {.group = &surface->group, .dimension = TM_GROUP_FACES};
    tm_scan_begin(&scan, bytes, size, name, '\0');
    tm_status status = TM_OK;
    while (status == TM_OK && tm_scan_seek(&scan)) {
        status = expect(&scan, "solid", error);
        if (status == TM_OK)
            status = begin_solid(&scan, surface, &markers, error);
        tm_scan_end_line(&scan);
        bool open = status == TM_OK;
        while (open && status == TM_OK) {
            tm_scan_seek(&scan);
            tm_scan ahead = scan;
            open = !tm_word_is_like(tm_scan_word(&ahead), "endsolid");
            status = expect_of(&scan, open ? "facet" : "endsolid", "facet' or 'endsolid",
                               error);
            if (open && status == TM_OK)
                status = read_facet(&scan, surface, table, error);
        }
        tm_scan_end_line(&scan);
    }
    end_markers(surface, &markers);
    tm_group_markers_free(&markers);
    return status;
}

/* Text begins with "solid" and has no zero byte; some binary files begin so, too. */
static bool is_text(const char *bytes, size_t size)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, "", '\0');
    tm_scan_seek(&scan);
    return !tm_stl_is_binary(bytes, size) &&
           tm_word_is_like(tm_scan_word(&scan), "solid") && !memchr(bytes, '\0', size);
}

tm_status tm_stl_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_point_table table = {0};
    tm_status status = is_text(bytes, size)
                           ? read_text(surface, &table, bytes, size, name, error)
                           : read_binary(surface, &table, bytes, size, name, error);
    tm_point_table_free(&table);
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}
