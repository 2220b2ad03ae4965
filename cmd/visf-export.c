/* SPDX-License-Identifier: GPL-3.0-or-later */
/* visf-export: a stream as a ViSF file. */
#include "common/input/mesh_input.h"

#include "../lib/format/visf.h"

#include <string.h>

enum { OPTION_BINARY = FILTER_OWN, OPTION_NEIGHBOURS, OPTION_PER_CELL };

static const struct option long_options[] = {
    {"binary", required_argument, NULL, OPTION_BINARY},
    {"neighbours", no_argument, NULL, OPTION_NEIGHBOURS},
    {"per-cell", no_argument, NULL, OPTION_PER_CELL},
    FILTER_OPTIONS};

static tm_visf_order read_order(const filter *f, const char *text)
{
    if (strcmp(text, "little") == 0)
        return TM_VISF_LITTLE;
    if (strcmp(text, "big") == 0)
        return TM_VISF_BIG;
    filter_usage_error(f, "--binary: '%s' is no byte order (little, big)", text);
}

static void read_options(filter *f, tm_visf_options *o)
{
    int c;
    while ((c = filter_option(f)) != -1) {
        switch (c) {
        case OPTION_BINARY:
            o->order = read_order(f, optarg);
            break;
        case OPTION_NEIGHBOURS:
            o->neighbours = true;
            break;
        default: /* OPTION_PER_CELL */
            o->per_cell = true;
        }
    }
    filter_operands(f);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "visf-export",
        .synopsis = "[--binary little|big] [--neighbours] [--per-cell] [FILE]",
        .purpose =
            "Writes points, a surface, tetrahedra, mixed elements or polyhedra as\n"
            "ViSF, the format of the mesh viewer Camarón.",
        .help = "      --binary ORDER  a binary file, in the byte order little or big\n"
                "      --neighbours    list the neighbouring polygons of each polygon\n"
                "      --per-cell      write each polygon once for each of its cells\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    tm_visf_options o = {.order = TM_VISF_TEXT};
    filter_start(&f, argc, argv);
    read_options(&f, &o);

    tm_stream stream;
    tm_text text = {0};
    tm_error error;
    mesh_input_read(&f, &stream);
    if (tm_visf_write(&text, &stream, &o, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    filter_write_text(&f, &text);
    mesh_input_report(&f, &stream);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
