/* SPDX-License-Identifier: GPL-3.0-or-later */
/* abaqus-export: a stream as an input file of Abaqus or CalculiX. */
#include "../common/input/left_out.h"
#include "../common/input/mesh_input.h"

#include "../../lib/format/abaqus/abaqus.h"

static filter *self;

static tm_status write_abaqus(tm_text *text, const tm_stream *stream, unsigned threads,
                              tm_error *error)
{
    size_t loose = 0;
    const tm_status status = tm_abaqus_write(text, stream, threads, &loose, error);
    if (status == TM_OK && loose > 0)
        filter_leave_out(self, "%zu marked faces that no element has", loose);
    return status;
}

int main(int argc, char **argv)
{
    static const struct option long_options[] = {FILTER_OPTIONS};
    filter f = {.name = "abaqus-export",
                .synopsis = "[options] [FILE]",
                .purpose =
                    "Writes points, a surface or elements as an input file of CalculiX "
                    "or\nAbaqus (.inp), with sets and surfaces.",
                .help = "",
                .options = long_options,
                .letters = FILTER_LETTERS};
    self = &f;
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        ;
    filter_operands(&f);
    return mesh_write(&f, write_abaqus);
}
