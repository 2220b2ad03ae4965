/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surface-import: a surface of any format that is read, as a stream. */
#include "../common/input/mesh_input.h"
#include "../common/input/surface_stream.h"

static const struct option long_options[] = {FILTER_OPTIONS};

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
    tm_stream stream;
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);
    surface_stream_read(&f, &stream);
    mesh_input_report(&f, &stream);
    filter_write(&f, &stream, "%zu nodes, %zu triangles", mesh_rows(&stream, ".node"),
                 mesh_rows(&stream, ".face"));
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
