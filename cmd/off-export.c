/* SPDX-License-Identifier: GPL-3.0-or-later */
/* off-export: the boundary of a mesh, or all its faces, as an OFF file. */
#include "common/input/mesh_input.h"

#include "../lib/format/off.h"

enum { OPTION_ALL = FILTER_OWN };

static const struct option long_options[] = {{"all", no_argument, NULL, OPTION_ALL},
                                             FILTER_OPTIONS};

int main(int argc, char **argv)
{
    filter f = {
        .name = "off-export",
        .synopsis = "[--all] [FILE]",
        .purpose =
            "Writes the boundary of tetrahedra, mixed elements or polyhedra, or a\n"
            "surface, as polygons in an OFF file.",
        .help = "      --all           write the faces inside, too\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    bool all = false;
    filter_start(&f, argc, argv);
    while (filter_option(&f) == OPTION_ALL)
        all = true;
    filter_operands(&f);

    tm_stream stream;
    tm_text text = {0};
    tm_error error;
    mesh_input_read(&f, &stream);
    if (tm_off_write(&text, &stream, all, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    filter_write_text(&f, &text);
    mesh_input_report(&f, &stream);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
