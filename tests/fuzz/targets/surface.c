/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surface files of all formats, told by their content; numbers alone are read as each of
 * those that have no more. What is read becomes a stream and, where it can be, a surface
 * that bounds a solid. */
#include "target.h"

#include "../../../lib/format/surface/surface_format.h"
#include "../../../lib/surface/surface.h"

static void build(const tm_polygon_surface *polygons, bool lenient)
{
    static const double angle = 30;
    const tm_surface_options options = {.feature_angle = angle,
                                        .unless_rough = lenient,
                                        .lenient = lenient,
                                        .regions = !lenient,
                                        .walls = !lenient};
    tm_surface surface;
    tm_error error;
    const tm_status status = tm_surface_build(&surface, polygons, &options, &error);
    require(status == TM_OK || (status == TM_ERROR_INPUT && error.what[0]),
            "no surface, but no reason");
    if (status == TM_OK && tm_surface_check(&surface, &error) != TM_OK)
        require(false, error.what);
    tm_surface_free(&surface);
}

static void read_as(tm_format format, const char *bytes, size_t size)
{
    tm_polygon_surface polygons;
    tm_stream stream;
    tm_error error;
    tm_polygon_surface_init(&polygons);
    const tm_status status =
        tm_format_read(&polygons, format, bytes, size, "file", &error);
    if (status != TM_OK) {
        require(status == TM_ERROR_INPUT && error.what[0], "not read, but no reason");
        require(polygons.nodes == 0 && polygons.corners == 0,
                "not read, but something is left");
        return;
    }
    tm_stream_init(&stream);
    require(tm_polygon_surface_to_stream(&polygons, &stream, "", &error) == TM_OK,
            "the surface is no stream");
    check_round_trip(&stream);
    tm_stream_free(&stream);
    build(&polygons, false);
    build(&polygons, true);
    tm_polygon_surface_free(&polygons);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    const char *text = (const char *)bytes;
    const tm_format format = tm_format_of(text, size, "file");
    if (format == TM_FORMAT_NODE || format == TM_FORMAT_POLY || format == TM_FORMAT_SMESH)
        for (int f = TM_FORMAT_NODE; f <= TM_FORMAT_SMESH; f++)
            read_as((tm_format)f, text, size);
    else if (format != TM_FORMAT_STREAM)
        read_as(format, text, size);
    return 0;
}
