/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../scan.h"

#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, POLYGON_MIN = 3 };

/* [ST][C][N][4][n]OFF. Sets *extra where more than x y z may follow in a vertex line. */
static tm_status read_keyword(tm_scan *scan, bool *extra, tm_error *error)
{
    tm_scan_seek(scan);
    tm_word word = tm_scan_word(scan);
    const char *suffix = word.begin + word.size - strlen("OFF");
    if (word.size < strlen("OFF") || memcmp(suffix, "OFF", strlen("OFF")) != 0)
        return tm_scan_fail(scan, error, "'%.*s' is no keyword of OFF (OFF, COFF, …)",
                            tm_word_shown(word), word.begin);
    for (const char *c = word.begin; c < suffix; c++) {
        if (*c == '4' || *c == 'n')
            return tm_scan_fail(scan, error,
                                "%.*s has other than three coordinates (OFF has three)",
                                tm_word_shown(word), word.begin);
        if (!memchr("STCN", *c, strlen("STCN")))
            return tm_scan_fail(scan, error, "'%.*s' is no keyword of OFF (OFF, COFF, …)",
                                tm_word_shown(word), word.begin);
    }
    *extra = word.begin < suffix;
    return TM_OK;
}

static tm_status read_counts(tm_scan *scan, int64_t *nodes, int64_t *faces,
                             tm_error *error)
{
    tm_scan_seek(scan);
    tm_scan ahead = *scan;
    if (tm_word_is_like(tm_scan_word(&ahead), "BINARY"))
        return tm_scan_fail(scan, error, "binary OFF is not read (text OFF is)");
    tm_status status =
        tm_scan_integer(scan, "the number of vertices", 0, INT64_MAX, nodes, error);
    if (status == TM_OK)
        status = tm_scan_integer(scan, "the number of faces", 0, INT64_MAX, faces, error);
    int64_t edges;
    if (status == TM_OK && tm_scan_more(scan))
        status = tm_scan_integer(scan, "the number of edges", INT64_MIN, INT64_MAX,
                                 &edges, error);
    if (status == TM_OK)
        status = tm_scan_no_more(scan, "the three counts", error);
    return status;
}

static tm_status read_vertex(tm_scan *scan, tm_polygon_surface *surface, bool extra,
                             int64_t nodes, tm_error *error)
{
    if (!tm_scan_seek(scan))
        return tm_scan_fail(scan, error, "the file ends after %zu of %lld vertices",
                            surface->nodes, (long long)nodes);
    double xyz[COORDINATES];
    tm_status status = tm_scan_point(scan, xyz, error);
    if (status == TM_OK && !extra && tm_scan_more(scan))
        status = tm_scan_fail(scan, error,
                              "more than three coordinates (with colours the file should "
                              "begin with COFF, with normals NOFF)");
    if (status == TM_OK)
        status = tm_polygon_surface_add_node(surface, xyz, error);
    tm_scan_end_line(scan);
    return status;
}

/* Corners may go on in the next line; what follows them in theirs is a colour. */
static tm_status read_face(tm_scan *scan, tm_polygon_surface *surface, int64_t faces,
                           tm_error *error)
{
    if (!tm_scan_seek(scan))
        return tm_scan_fail(scan, error, "the file ends after %zu of %lld faces",
                            surface->polygons, (long long)faces);
    int64_t corners = 0, node = 0, last = (int64_t)surface->nodes - 1;
    tm_status status = tm_scan_integer(scan, "the number of corners", POLYGON_MIN,
                                       INT32_MAX, &corners, error);
    for (int64_t i = 0; i < corners && status == TM_OK; i++) {
        status = tm_scan_next_integer(scan, "vertex", 0, last, &node, error);
        if (status == TM_OK)
            status = tm_polygon_surface_add_corner(surface, (uint32_t)node, error);
    }
    if (status == TM_OK)
        status = tm_polygon_surface_end_face(surface, error);
    tm_scan_end_line(scan);
    return status;
}

tm_status tm_off_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    bool extra = false;
    int64_t nodes = 0, faces = 0;
    tm_status status = read_keyword(&scan, &extra, error);
    if (status == TM_OK)
        status = read_counts(&scan, &nodes, &faces, error);
    tm_scan_end_line(&scan);
    for (int64_t v = 0; v < nodes && status == TM_OK; v++)
        status = read_vertex(&scan, surface, extra, nodes, error);
    for (int64_t f = 0; f < faces && status == TM_OK; f++)
        status = read_face(&scan, surface, faces, error);
    if (status == TM_OK && tm_scan_seek(&scan))
        status = tm_scan_no_more(&scan, "the last face", error);
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}
