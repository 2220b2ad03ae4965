/* SPDX-License-Identifier: GPL-3.0-or-later */
/* getfem-export: a stream as a mesh file of the finite element library GetFEM. */
#include "common/mesh_input.h"

#include "../lib/format/getfem.h"

static const struct option long_options[] = {FILTER_OPTIONS};

int main(int argc, char **argv)
{
    filter f = {
        .name = "getfem-export",
        .synopsis = "[options] [FILE]",
        .purpose = "Writes mixed elements, tetrahedra or triangles as a mesh file of the "
                   "finite\n"
                   "element library GetFEM.",
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
    if (tm_getfem_write(&text, &stream, f.threads, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    filter_write_text(&f, &text);
    mesh_input_report(&f, &stream);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
