/* SPDX-License-Identifier: GPL-3.0-or-later */
/* visf-export: a stream as a ViSF file. */
#include "../common/input/mesh_input.h"
#include "../common/export/rounded.h"

#include "../../lib/format/visf.h"

enum { OPTION_BINARY = FILTER_OWN, OPTION_NEIGHBOURS, OPTION_PER_CELL };

static const struct option long_options[] = {
    {"binary", required_argument, NULL, OPTION_BINARY},
    {"neighbours", no_argument, NULL, OPTION_NEIGHBOURS},
    {"per-cell", no_argument, NULL, OPTION_PER_CELL},
    FILTER_OPTIONS};

static const char *const orders[] = {"little", "big"};
static const filter_words option_words[] = {FILTER_WORDS(OPTION_BINARY, orders), {0}};

static filter f = {
    .name = "visf-export",
    .synopsis = "[--binary little|big] [--neighbours] [--per-cell] [FILE]",
    .purpose = "Writes points, a surface, tetrahedra, mixed elements or polyhedra as\n"
               "ViSF, the format of the mesh viewer Camarón.",
    .help = "      --binary ORDER  a binary file, in the byte order little or big\n"
            "      --neighbours    list the neighbouring polygons of each polygon\n"
            "      --per-cell      write each polygon once for each of its cells\n",
    .options = long_options,
    .words = option_words,
    .letters = FILTER_LETTERS,
};

static tm_visf_options visf = {.order = TM_VISF_TEXT};

static void read_options(void)
{
    int c;
    while ((c = filter_option(&f)) != -1) {
        switch (c) {
        case OPTION_BINARY:
            visf.order = filter_word(&f, OPTION_BINARY, optarg) == 0 ? TM_VISF_LITTLE
                                                                     : TM_VISF_BIG;
            f.binary = true;
            break;
        case OPTION_NEIGHBOURS:
            visf.neighbours = true;
            break;
        default: /* OPTION_PER_CELL */
            visf.per_cell = true;
        }
    }
    filter_operands(&f);
}

static tm_status write_visf(tm_text *text, const tm_stream *stream, unsigned threads,
                            tm_error *error)
{
    (void)threads;
    rounded_note(&f, stream,
                 visf.order == TM_VISF_TEXT ? TM_VISF_DIGITS : ROUNDED_TO_FLOATS);
    return tm_visf_write(text, stream, &visf, error);
}

int main(int argc, char **argv)
{
    filter_start(&f, argc, argv);
    read_options();
    return mesh_write(&f, write_visf);
}
