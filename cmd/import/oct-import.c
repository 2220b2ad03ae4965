/* SPDX-License-Identifier: GPL-3.0-or-later */
/* oct-import: the octree of a restart file of the mixed-element octree mesher, with its
 * mesh and its surface, as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/mesh_format.h"
#include "../../lib/format/oct.h"
#include "../../lib/format/surface/surface_format.h"
#include "../../lib/surface/polygon_surface.h"

static const struct option options[] = {
    {"mesh", required_argument, NULL, 'm'},
    {"surface", required_argument, NULL, 's'},
    FILTER_OPTIONS,
};

static filter f = {
    .name = "oct-import",
    .synopsis = "[-m MESH] [-s SURFACE] [FILE]",
    .purpose = "Reads an .oct restart file of the mixed-element octree mesher.",
    .help = "  -m, --mesh MESH           the .m3d or .mvm file beside it: its elements\n"
            "  -s, --surface SURFACE     the surface that was meshed\n",
    .options = options,
    .letters = "m:s:" FILTER_LETTERS,
};

static tm_error error;

static void succeed(tm_status status)
{
    if (status != TM_OK)
        filter_fail(&f, &error);
}

static void read_mesh(const char *file, tm_stream *stream)
{
    tm_text bytes = {0};
    size_t materials;
    filter_read_file(&f, file, &bytes);
    if (tm_m3d_read(stream, bytes.byte, bytes.size, file, &materials, &error) != TM_OK)
        filter_fail_file(&f, &error, &bytes, "m3d-import");
    mesh_leave_out_materials(&f, materials);
    tm_text_free(&bytes);
}

static void read_surface(const char *file, tm_stream *stream)
{
    tm_text bytes = {0};
    tm_polygon_surface surface;
    filter_read_file(&f, file, &bytes);
    const char *text = bytes.byte;
    tm_polygon_surface_init(&surface);
    const tm_format format = tm_format_of(text, bytes.size, file);
    if (tm_format_read(&surface, format, text, bytes.size, file, &error) != TM_OK) {
        if (format <= TM_FORMAT_STREAM)
            filter_fail(&f, &error);
        filter_fail_file(&f, &error, &bytes, "tetgen-mesh");
    }
    succeed(tm_polygon_surface_to_stream(&surface, stream, "surface", &error));
    tm_polygon_surface_free(&surface);
    tm_text_free(&bytes);
}

static void read_octants(tm_stream *stream)
{
    tm_text bytes = {0};
    tm_oct oct;
    const char *name = filter_input_name(&f);
    filter_read_bytes(&f, &bytes);
    if (tm_oct_read(&oct, bytes.byte, bytes.size, name, &error) != TM_OK)
        filter_fail_file(&f, &error, &bytes, f.name);
    succeed(tm_oct_to_stream(&oct, stream, name, &error));
    tm_oct_free(&oct);
    tm_text_free(&bytes);
}

int main(int argc, char **argv)
{
    const char *mesh = NULL, *surface = NULL;
    int c;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1)
        if (c == 'm')
            mesh = optarg;
        else
            surface = optarg;
    filter_operands(&f);

    tm_stream stream;
    tm_stream_init(&stream);
    if (mesh)
        read_mesh(mesh, &stream);
    read_octants(&stream);
    if (surface)
        read_surface(surface, &stream);
    mesh_input_report(&f, &stream);
    filter_write(&f, &stream, "%zu nodes, %zu elements, %zu octants",
                 tm_stream_find(&stream, ".node")->count,
                 tm_stream_find(&stream, ".mix")->count,
                 tm_stream_find(&stream, ".octant")->count);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
