/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mdl-import: an .mdl surface as a stream. */
#include "common/input/import_file.h"
#include "common/input/mesh_input.h"

#include "../lib/format/mdl.h"
#include "../lib/surface/polygon_surface.h"

static const struct option long_options[] = {FILTER_OPTIONS};

int main(int argc, char **argv)
{
    filter f = {
        .name = "mdl-import",
        .synopsis = "[options] [FILE]",
        .purpose = "Reads an .mdl surface of the mixed-element octree mesher.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);

    tm_stream stream;
    tm_polygon_surface surface;
    tm_text bytes = {0};
    tm_error error;
    tm_stream_init(&stream);
    tm_polygon_surface_init(&surface);
    import_input(&f, &bytes);
    stream.base = 0;
    if (tm_mdl_read(&surface, bytes.byte ? bytes.byte : "", bytes.size,
                    filter_input_name(&f), &error) != TM_OK ||
        tm_polygon_surface_to_stream(&surface, &stream, "", &error) != TM_OK)
        filter_fail(&f, &error);
    tm_text_free(&bytes);
    filter_write(&f, &stream, "%zu nodes, %zu triangles", surface.nodes,
                 surface.polygons);
    mesh_input_report(&f, &stream);
    tm_polygon_surface_free(&surface);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
