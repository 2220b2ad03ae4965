/* SPDX-License-Identifier: GPL-3.0-or-later */
/* oct-export: the octants of a stream as a restart file of the octree mesher. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/oct.h"

enum { OPTION_IDS = FILTER_OWN };

static const struct option long_options[] = {{"ids", no_argument, NULL, OPTION_IDS},
                                             FILTER_OPTIONS};

static bool ids;

static tm_status write_oct(tm_text *text, const tm_stream *stream, unsigned threads,
                           tm_error *error)
{
    return tm_oct_write(text, stream, ids, threads, error);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "oct-export",
        .synopsis = "[--ids] [FILE]",
        .purpose = "Writes the octants of a stream as an .oct restart file of the "
                   "mixed-element\n"
                   "octree mesher.",
        .help = "      --ids           an id at the end of each octant's row\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ids = true;
    filter_operands(&f);
    return mesh_write(&f, write_oct);
}
