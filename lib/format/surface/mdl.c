/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../scan.h"

enum { CORNERS = 3, IGNORED = 3 };

static tm_status read_points(tm_scan *scan, tm_polygon_surface *surface, tm_error *error)
{
    int64_t count = 0;
    tm_status status =
        tm_scan_next_integer(scan, "the number of points", 0, INT64_MAX, &count, error);
    for (int64_t v = 0; v < count && status == TM_OK; v++) {
        double xyz[3];
        for (int i = 0; i < 3 && status == TM_OK; i++)
            status = tm_scan_next_double(scan, "a coordinate", &xyz[i], error);
        if (status == TM_OK)
            status = tm_polygon_surface_add_node(surface, xyz, error);
    }
    return status;
}

/* Points may come later: the corners are checked against them at the end. */
static tm_status read_triangles(tm_scan *scan, tm_polygon_surface *surface,
                                tm_error *error)
{
    int64_t count = 0;
    tm_status status = tm_scan_next_integer(scan, "the number of triangles", 0, INT64_MAX,
                                            &count, error);
    for (int64_t f = 0; f < count && status == TM_OK; f++) {
        uint32_t corner[CORNERS];
        int64_t value = 0;
        for (int i = 0; i < CORNERS && status == TM_OK; i++) {
            status = tm_scan_next_integer(scan, "point", 0, UINT32_MAX, &value, error);
            corner[i] = (uint32_t)value;
        }
        for (int i = 0; i < IGNORED && status == TM_OK; i++)
            if (!tm_scan_seek(scan) || tm_scan_word(scan).size == 0)
                status = tm_scan_fail(scan, error, "the file ends in triangle %lld",
                                      (long long)f);
        if (status == TM_OK)
            status = tm_polygon_surface_add_polygon(surface, corner, CORNERS, error);
    }
    return status;
}

static tm_status check_corners(const tm_scan *scan, const tm_polygon_surface *surface,
                               tm_error *error)
{
    for (size_t i = 0; i < surface->corners; i++)
        if (surface->item[i] >= surface->nodes)
            return tm_fail_at(error, TM_ERROR_INPUT, scan->name, 0, NULL,
                              "triangle %zu: point %u is out of range (below %zu)",
                              i / CORNERS, surface->item[i], surface->nodes);
    return TM_OK;
}

tm_status tm_mdl_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '\0');
    bool points = false, triangles = false;
    tm_status status = TM_OK;
    while (status == TM_OK && tm_scan_seek(&scan)) {
        tm_word word = tm_scan_word(&scan);
        bool is_points = tm_word_is(word, "ARRAY1<POINT3D>]");
        bool is_triangles = tm_word_is(word, "ARRAY1<STRING>]");
        if ((is_points && points) || (is_triangles && triangles))
            status = tm_scan_fail(&scan, error, "a second section of type %.*s",
                                  tm_word_shown(word) - 1, word.begin);
        else if (is_points)
            status = read_points(&scan, surface, error);
        else if (is_triangles)
            status = read_triangles(&scan, surface, error);
        points |= is_points;
        triangles |= is_triangles;
    }
    if (status == TM_OK && !(points && triangles))
        status = tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                            "has no section of type ARRAY1<%s>",
                            points ? "STRING" : "POINT3D");
    if (status == TM_OK)
        status = check_corners(&scan, surface, error);
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}
