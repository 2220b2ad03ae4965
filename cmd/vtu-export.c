/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtu-export: a stream as an unstructured grid of VTK. */
#include "common/input/mesh_input.h"

#include "../lib/format/mesh_format.h"

static const struct option long_options[] = {FILTER_OPTIONS};

int main(int argc, char **argv)
{
    filter f = {
        .name = "vtu-export",
        .synopsis = "[options] [FILE]",
        .purpose =
            "Writes points, triangles, tetrahedra, mixed elements or polyhedra as\n"
            "an unstructured grid of VTK (.vtu), which ParaView shows.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .binary = true,
    };
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);
    return mesh_write(&f, tm_vtu_write);
}
