/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_export.h"

#include "mesh_input.h"

enum { OPTION_NO_BOUNDARY = FILTER_OWN, OPTION_NO_NAMES, OPTION_NO_QUALITY };

static const struct option long_options[] = {
    {"no-boundary", no_argument, NULL, OPTION_NO_BOUNDARY},
    {"no-names", no_argument, NULL, OPTION_NO_NAMES},
    {"no-quality", no_argument, NULL, OPTION_NO_QUALITY},
    FILTER_OPTIONS};

static tm_vtk_options options = {.boundary = true, .quality = true, .names = true};
static vtk_writer *writer;

static tm_status write_grid(tm_text *text, const tm_stream *stream, unsigned threads,
                            tm_error *error)
{
    return writer(text, stream, &options, threads, error);
}

int vtk_export(int argc, char **argv, const char *name, const char *purpose, bool binary,
               vtk_writer *write)
{
    filter f = {
        .name = name,
        .synopsis = "[--no-boundary] [--no-names] [--no-quality] [FILE]",
        .purpose = purpose,
        .help = "      --no-boundary   no cells for marked triangles, facets and edges\n"
                "      --no-names      no names of markers and regions\n"
                "      --no-quality    no quality of cells\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .binary = binary,
    };
    int c;
    writer = write;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1) {
        switch (c) {
        case OPTION_NO_BOUNDARY:
            options.boundary = false;
            break;
        case OPTION_NO_NAMES:
            options.names = false;
            break;
        default: /* OPTION_NO_QUALITY */
            options.quality = false;
        }
    }
    filter_operands(&f);
    return mesh_write(&f, write_grid);
}
