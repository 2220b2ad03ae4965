/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "mdl.h"
#include "obj.h"
#include "off.h"
#include "ply.h"
#include "scan.h"
#include "stl.h"
#include "tetgen_poly.h"

#include <string.h>
#include <strings.h>

static bool has_suffix(const char *name, const char *suffix)
{
    size_t size = strlen(name), length = strlen(suffix);
    return size >= length && strcasecmp(name + size - length, suffix) == 0;
}

/* OFF, or letters of its variants before it. */
static bool is_off_keyword(tm_word word)
{
    size_t length = strlen("OFF");
    return word.size >= length && word.size <= strlen("STCN4nOFF") &&
           memcmp(word.begin + word.size - length, "OFF", length) == 0;
}

static bool is_obj_keyword(tm_word word)
{
    static const char *const keywords[] = {"v", "vt", "vn",     "vp",     "f", "g",
                                           "o", "s",  "mtllib", "usemtl", "l", "p"};
    for (size_t k = 0; k < sizeof keywords / sizeof keywords[0]; k++)
        if (tm_word_is(word, keywords[k]))
            return true;
    return false;
}

static tm_format format_of_numbers(const char *bytes, size_t size, const char *name)
{
    static const struct {
        const char *suffix;
        tm_format format;
    } known[] = {{".node", TM_FORMAT_NODE},
                 {".poly", TM_FORMAT_POLY},
                 {".smesh", TM_FORMAT_SMESH}};
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (has_suffix(name, known[k].suffix))
            return known[k].format;
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
    tm_word word = tm_scan_word(&ahead);
    if (tm_word_is(word, "termesh"))
        return TM_FORMAT_STREAM;
    if (is_off_keyword(word))
        return TM_FORMAT_OFF;
    if (tm_word_is(word, "ply"))
        return TM_FORMAT_PLY;
    if (tm_word_is_like(word, "solid"))
        return TM_FORMAT_STL;
    if (is_obj_keyword(word))
        return TM_FORMAT_OBJ;
    if (*word.begin == '[' && memmem(bytes, size, "ARRAY1<POINT3D>]", 16))
        return TM_FORMAT_MDL;
    if (is_tetgen(scan))
        return format_of_numbers(bytes, size, name);
    return has_suffix(name, ".stl") ? TM_FORMAT_STL : TM_FORMAT_UNKNOWN;
}

const char *tm_format_name(tm_format format)
{
    static const char *const names[] = {
        [TM_FORMAT_UNKNOWN] = "",   [TM_FORMAT_STREAM] = "termesh stream",
        [TM_FORMAT_OFF] = "OFF",    [TM_FORMAT_STL] = "STL",
        [TM_FORMAT_PLY] = "PLY",    [TM_FORMAT_OBJ] = "OBJ",
        [TM_FORMAT_MDL] = ".mdl",   [TM_FORMAT_NODE] = ".node",
        [TM_FORMAT_POLY] = ".poly", [TM_FORMAT_SMESH] = ".smesh",
    };
    return names[format];
}

tm_status tm_format_read(tm_polygon_surface *surface, tm_format format, const char *bytes,
                         size_t size, const char *name, tm_error *error)
{
    switch (format) {
    case TM_FORMAT_OFF:
        return tm_off_read(surface, bytes, size, name, error);
    case TM_FORMAT_STL:
        return tm_stl_read(surface, bytes, size, name, error);
    case TM_FORMAT_PLY:
        return tm_ply_read(surface, bytes, size, name, error);
    case TM_FORMAT_OBJ:
        return tm_obj_read(surface, bytes, size, name, error);
    case TM_FORMAT_MDL:
        return tm_mdl_read(surface, bytes, size, name, error);
    case TM_FORMAT_NODE:
        return tm_plc_read(surface, TM_PLC_NODE, bytes, size, name, error);
    case TM_FORMAT_POLY:
        return tm_plc_read(surface, TM_PLC_POLY, bytes, size, name, error);
    case TM_FORMAT_SMESH:
        return tm_plc_read(surface, TM_PLC_SMESH, bytes, size, name, error);
    default:
        return tm_fail_at(
            error, TM_ERROR_INPUT, name, 0, NULL,
            size == 0 ? "is empty (a surface, or points)"
                      : "is no surface that can be read (OFF, STL, PLY, OBJ, .mdl, "
                        ".node, .poly or .smesh)");
    }
}
