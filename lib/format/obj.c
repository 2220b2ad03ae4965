/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../base/number.h"
#include "scan.h"

#include <string.h>

enum { POLYGON_MIN = 3 };

/* True where the statement has another word, behind line continuations if need be. */
static bool more(tm_scan *scan)
{
    while (tm_scan_more(scan)) {
        tm_scan ahead = *scan;
        if (!tm_word_is(tm_scan_word(&ahead), "\\"))
            return true;
        tm_scan_end_line(scan);
    }
    return false;
}

/* The next word; a continuation that touches it is left for more(). */
static tm_word next(tm_scan *scan)
{
    tm_word word = {scan->at, 0};
    if (!more(scan))
        return word;
    word = tm_scan_word(scan);
    if (word.begin[word.size - 1] == '\\') {
        word.size--;
        scan->at--;
    }
    return word;
}

static void end_statement(tm_scan *scan)
{
    while (next(scan).size > 0)
        continue;
    tm_scan_end_line(scan);
}

static tm_status read_vertex(tm_scan *scan, tm_polygon_surface *surface, tm_error *error)
{
    double xyz[3];
    for (int i = 0; i < 3; i++) {
        if (!more(scan))
            return tm_scan_fail(
                scan, error, "the vertex has %d coordinates (three would be right)", i);
        tm_word word = next(scan);
        tm_scan one;
        tm_scan_begin(&one, word.begin, word.size, scan->name, '\0');
        one.line = scan->line;
        tm_status status = tm_scan_double(&one, "a coordinate", &xyz[i], error);
        if (status != TM_OK)
            return status;
    }
    return tm_polygon_surface_add_node(surface, xyz, error);
}

/* The digits up to the first '/'. */
static tm_status read_corner(tm_scan *scan, tm_polygon_surface *surface, tm_error *error)
{
    tm_word word = next(scan);
    const char *end = word.begin + word.size;
    int64_t number = 0, nodes = (int64_t)surface->nodes;
    const char *after = tm_read_int64(word.begin, end, &number);
    if (!after || (after < end && *after != '/'))
        return tm_scan_fail(scan, error, "'%.*s' is not the number of a vertex",
                            tm_word_shown(word), word.begin);
    int64_t node = number < 0 ? nodes + number : number - 1;
    if (number < -nodes || number > nodes || number == 0)
        return tm_scan_fail(scan, error, "vertex %lld is out of range (1..%lld so far)",
                            (long long)number, (long long)nodes);
    return tm_polygon_surface_add_corner(surface, (uint32_t)node, error);
}

static tm_status read_face(tm_scan *scan, tm_polygon_surface *surface, tm_error *error)
{
    int corners = 0;
    tm_status status = TM_OK;
    while (status == TM_OK && more(scan)) {
        status = read_corner(scan, surface, error);
        if (corners < POLYGON_MIN)
            corners++;
    }
    if (status == TM_OK && corners < POLYGON_MIN)
        status =
            tm_scan_fail(scan, error, "the face has %d corners (three or more)", corners);
    if (status == TM_OK)
        status = tm_polygon_surface_end_face(surface, error);
    return status;
}

tm_status tm_obj_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    tm_status status = TM_OK;
    while (status == TM_OK && tm_scan_seek(&scan)) {
        tm_word word = tm_scan_word(&scan);
        if (tm_word_is(word, "v"))
            status = read_vertex(&scan, surface, error);
        else if (tm_word_is(word, "f"))
            status = read_face(&scan, surface, error);
        end_statement(&scan);
    }
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}
