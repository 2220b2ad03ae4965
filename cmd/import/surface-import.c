/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surface-import: a surface of any format that is read, as a stream. */
#include "../common/input/mesh_input.h"
#include "../common/input/surface_input.h"

static const struct option long_options[] = {FILTER_OPTIONS};

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

int main(int argc, char **argv)
{
    filter f = {
        .name = "surface-import",
        .synopsis = "[FILE]",
        .purpose =
            "Reads a surface (OFF, STL, PLY, OBJ, .mdl, .poly, .smesh) as a stream.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    tm_polygon_surface surface;
    tm_stream input, stream;
    tm_error error;
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);
    surface_input_read(&f, &surface, &input);
    check_facets(&f, &surface);
    tm_stream_init(&stream);
    if (tm_polygon_surface_to_stream(&surface, &stream, "", &error) != TM_OK)
        filter_fail(&f, &error);
    stream.base = surface.base;
    stream.history = input.history;
    input.history = (tm_text){0};
    say_left_out(&f, &surface);
    const size_t triangles = mesh_rows(&stream, ".face");
    note_triangles(&f, &surface, triangles);
    mesh_input_report(&f, &stream);
    filter_write(&f, &stream, "%zu nodes, %zu triangles", mesh_rows(&stream, ".node"),
                 triangles);
    tm_polygon_surface_free(&surface);
    tm_stream_free(&stream);
    tm_stream_free(&input);
    return filter_finish(&f, 0);
}
