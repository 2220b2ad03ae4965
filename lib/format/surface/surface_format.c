/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../../text/input.h"
#include "../../stream/sniff.h"
#include "../scan.h"
#include "../tetgen.h"

#include <string.h>
#include <strings.h>

static bool has_suffix(const char *name, const char *suffix)
{
    size_t size = tm_unpacked_name(name), length = strlen(suffix);
    return size >= length && strncasecmp(name + size - length, suffix, length) == 0;
}

/* The beginning of a file: its first word. */
typedef struct head {
    const char *bytes;
    size_t size;
    tm_word word;
} head;

static bool is_stream(const head *h)
{
    return tm_word_is(h->word, "termesh");
}

/* OFF, or letters of its variants before it. */
static bool is_off(const head *h)
{
    const size_t length = strlen("OFF");
    return h->word.size >= length && h->word.size <= strlen("STCN4nOFF") &&
           memcmp(h->word.begin + h->word.size - length, "OFF", length) == 0;
}

static bool is_stl(const head *h)
{
    return tm_word_is_like(h->word, "solid");
}

static bool is_ply(const head *h)
{
    return tm_word_is(h->word, "ply");
}

static bool is_obj(const head *h)
{
    static const char *const keywords[] = {"v", "vt", "vn",     "vp",     "f", "g",
                                           "o", "s",  "mtllib", "usemtl", "l", "p"};
    for (size_t k = 0; k < sizeof keywords / sizeof keywords[0]; k++)
        if (tm_word_is(h->word, keywords[k]))
            return true;
    return false;
}

static bool is_mdl(const head *h)
{
    static const char points[] = "ARRAY1<POINT3D>]";
    return *h->word.begin == '[' && memmem(h->bytes, h->size, points, strlen(points));
}

static tm_status read_node(tm_polygon_surface *surface, const char *bytes, size_t size,
                           const char *name, tm_error *error)
{
    return tm_plc_read(surface, TM_PLC_NODE, bytes, size, name, error);
}

static tm_status read_poly(tm_polygon_surface *surface, const char *bytes, size_t size,
                           const char *name, tm_error *error)
{
    return tm_plc_read(surface, TM_PLC_POLY, bytes, size, name, error);
}

static tm_status read_smesh(tm_polygon_surface *surface, const char *bytes, size_t size,
                            const char *name, tm_error *error)
{
    return tm_plc_read(surface, TM_PLC_SMESH, bytes, size, name, error);
}

/* What is read. Files of TetGen have no first word that tells them. */
static const struct {
    const char *name;
    bool (*sniff)(const head *h);
    tm_status (*read)(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error);
} formats[] = {
    [TM_FORMAT_UNKNOWN] = {"", NULL, NULL},
    [TM_FORMAT_STREAM] = {"termesh stream", is_stream, NULL},
    [TM_FORMAT_OFF] = {"OFF", is_off, tm_off_read},
    [TM_FORMAT_STL] = {"STL", is_stl, tm_stl_read},
    [TM_FORMAT_PLY] = {"PLY", is_ply, tm_ply_read},
    [TM_FORMAT_OBJ] = {"OBJ", is_obj, tm_obj_read},
    [TM_FORMAT_MDL] = {".mdl", is_mdl, tm_mdl_read},
    [TM_FORMAT_NODE] = {".node", NULL, read_node},
    [TM_FORMAT_POLY] = {".poly", NULL, read_poly},
    [TM_FORMAT_SMESH] = {".smesh", NULL, read_smesh},
};
enum { FORMATS = sizeof formats / sizeof *formats };

static tm_format format_of_numbers(const char *bytes, size_t size, const char *name)
{
    for (int f = TM_FORMAT_NODE; f <= TM_FORMAT_SMESH; f++)
        if (has_suffix(name, formats[f].name))
            return (tm_format)f;
    switch (tm_plc_kind_of(bytes, size)) {
    case TM_PLC_POLY:
        return TM_FORMAT_POLY;
    case TM_PLC_SMESH:
        return TM_FORMAT_SMESH;
    default:
        return TM_FORMAT_NODE;
    }
}

/* A TetGen file begins with a count and, of nodes, the dimension; .ele files have 4 or
 * 10 there, and are no surface. */
static bool is_tetgen(tm_scan scan)
{
    int64_t nodes, dimension = 3;
    if (tm_scan_integer(&scan, "", 0, INT64_MAX, &nodes, NULL) != TM_OK)
        return false;
    return !tm_scan_more(&scan) ||
           (tm_scan_integer(&scan, "", 0, INT64_MAX, &dimension, NULL) == TM_OK &&
            (dimension == 3 || nodes == 0));
}

tm_format tm_format_of(const char *bytes, size_t size, const char *name)
{
    tm_scan scan;
    tm_scan_begin(&scan, bytes, size, name, '#');
    if (tm_stl_is_binary(bytes, size) || !tm_scan_seek(&scan))
        return tm_stl_is_binary(bytes, size) ? TM_FORMAT_STL : TM_FORMAT_UNKNOWN;
    tm_scan ahead = scan;
    const head h = {bytes, size, tm_scan_word(&ahead)};
    for (int f = 0; f < FORMATS; f++)
        if (formats[f].sniff && formats[f].sniff(&h))
            return (tm_format)f;
    if (is_tetgen(scan))
        return format_of_numbers(bytes, size, name);
    return has_suffix(name, ".stl") ? TM_FORMAT_STL : TM_FORMAT_UNKNOWN;
}

const char *tm_format_name(tm_format format)
{
    return formats[format].name;
}

tm_status tm_format_read(tm_polygon_surface *surface, tm_format format, const char *bytes,
                         size_t size, const char *name, tm_error *error)
{
    if (formats[format].read)
        return formats[format].read(surface, bytes, size, name, error);
    if (size == 0)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "is empty (a surface, or points)");
    const tm_look look = tm_look_at(bytes, size);
    return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                      "is no surface that can be read (OFF, STL, PLY, OBJ, .mdl, .node, "
                      ".poly or .smesh); looks like %s%s%s",
                      look.what, look.advice ? ": " : "", look.advice ? look.advice : "");
}
