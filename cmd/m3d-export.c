/* SPDX-License-Identifier: GPL-3.0-or-later */
/* m3d-export: a stream as a mesh of the mixed-element octree mesher (.m3d). */
#include "common/mesh_input.h"

#include "../lib/format/m3d.h"

static const struct option long_options[] = {FILTER_OPTIONS};

int main(int argc, char **argv)
{
    filter f = {
        .name = "m3d-export",
        .synopsis = "[options] [FILE]",
        .purpose =
            "Writes mixed elements or tetrahedra as an .m3d mesh of the mixed-element\n"
            "octree mesher.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);

    tm_stream stream;
    tm_text text = {0};
    tm_error error;
    mesh_input_read(&f, &stream);
    if (tm_m3d_write(&text, &stream, TM_M3D, f.threads, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    filter_write_text(&f, &text);
    mesh_input_report(&f, &stream);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
