/* SPDX-License-Identifier: GPL-3.0-or-later */
/* m3d-import: a mesh of the mixed-element octree mesher as a stream. */
#include "common/import_file.h"
#include "common/mesh_input.h"

#include "../lib/format/m3d.h"

static const struct option long_options[] = {FILTER_OPTIONS};

int main(int argc, char **argv)
{
    filter f = {
        .name = "m3d-import",
        .synopsis = "[options] [FILE]",
        .purpose = "Reads an .m3d or .mvm mesh of the mixed-element octree mesher.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);

    tm_stream stream;
    tm_text bytes = {0};
    tm_error error;
    size_t materials = 0;
    tm_stream_init(&stream);
    import_input(&f, &bytes);
    if (tm_m3d_read(&stream, bytes.byte ? bytes.byte : "", bytes.size,
                    filter_input_name(&f), &materials, &error) != TM_OK)
        filter_fail(&f, &error);
    tm_text_free(&bytes);
    if (materials > 0)
        filter_note(&f,
                    "%s: the constants of the material of %zu elements are others than "
                    "1000.0 0.45 1.0 and left out",
                    filter_input_name(&f), materials);
    filter_write(&f, &stream, "%zu nodes, %zu elements",
                 tm_stream_find(&stream, ".node")->count,
                 tm_stream_find(&stream, ".mix")->count);
    mesh_input_report(&f, &stream);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
