/* SPDX-License-Identifier: GPL-3.0-or-later */
/* off-export: the boundary of a mesh, or all its faces, as an OFF file. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/mesh_format.h"

enum { OPTION_ALL = FILTER_OWN };

static const struct option long_options[] = {{"all", no_argument, NULL, OPTION_ALL},
                                             FILTER_OPTIONS};

static bool all;

static tm_status write_off(tm_text *text, const tm_stream *stream, unsigned threads,
                           tm_error *error)
{
    (void)threads;
    return tm_off_write(text, stream, all, error);
}

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
    filter_start(&f, argc, argv);
    while (filter_option(&f) == OPTION_ALL)
        all = true;
    filter_operands(&f);
    return mesh_write(&f, write_off);
}
