/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_stream.h"

#include "mesh_input.h"
#include "surface_input.h"

/* A facet that is not one polygon would become another one. */
static void check_facets(const filter *f, const tm_polygon_surface *surface)
{
    tm_error error;
    for (size_t i = 0; i < surface->facets; i++)
        if (surface->facet_start[i + 1] - surface->facet_start[i] != 1 ||
            surface->facet_hole_start[i + 1] != surface->facet_hole_start[i]) {
            tm_fail(&error, TM_ERROR_INPUT,
                    "facet %zu has several polygons, or a hole (tetgen-mesh takes them)",
                    i + surface->base);
            mesh_input_fail(f, &error);
        }
}

static void say_left_out(const filter *f, const tm_polygon_surface *surface)
{
    size_t segments = 0;
    for (size_t p = 0; p < surface->polygons; p++)
        segments += surface->start[p + 1] - surface->start[p] < 3;
    if (segments > 0)
        filter_leave_out(f, "%zu facets of one or two nodes", segments);
    if (surface->regions + surface->holes > 0)
        filter_leave_out(f, "%zu regions and %zu holes by their points", surface->regions,
                         surface->holes);
}

/* Triangles without area, a node twice, are not made of polygons. */
static void note_triangles(const filter *f, const tm_polygon_surface *surface,
                           size_t triangles)
{
    size_t due = 0, larger = 0;
    for (size_t p = 0; p < surface->polygons; p++) {
        const size_t k = surface->start[p + 1] - surface->start[p];
        due += k > 2 ? k - 2 : 0;
        larger += k > 3;
    }
    if (larger > 0)
        filter_verbose(f, "%zu polygons were cut into triangles", larger);
    if (triangles < due)
        filter_note(f, "%s: %zu triangles that have a node twice are dropped",
                    filter_input_name(f), due - triangles);
}

void surface_stream_read(const filter *f, tm_stream *stream)
{
    tm_polygon_surface surface;
    tm_stream input;
    tm_error error;
    surface_input_read(f, &surface, &input);
    check_facets(f, &surface);
    tm_stream_init(stream);
    if (tm_polygon_surface_to_stream(&surface, stream, "", &error) != TM_OK)
        filter_fail(f, &error);
    stream->base = surface.base;
    stream->history = input.history;
    input.history = (tm_text){0};
    say_left_out(f, &surface);
    surface_input_leave_out_blocks(f, &input);
    note_triangles(f, &surface, mesh_rows(stream, ".face"));
    tm_polygon_surface_free(&surface);
    tm_stream_free(&input);
}
