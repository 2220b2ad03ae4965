/* SPDX-License-Identifier: GPL-3.0-or-later */
/* medit-export: a stream as a mesh of Medit's format, with a solution. */
#include "../common/input/left_out.h"
#include "../common/input/mesh_input.h"

#include "../../lib/format/medit/medit.h"

#include <string.h>

enum { OPTION_BINARY = FILTER_OWN, OPTION_KINDS, OPTION_SOL };

static const struct option long_options[] = {
    {"binary", no_argument, NULL, OPTION_BINARY},
    {"kinds", required_argument, NULL, OPTION_KINDS},
    {"sol", required_argument, NULL, OPTION_SOL},
    FILTER_OPTIONS};

enum { KINDS_MAX = TM_ATTRIBUTES_MAX };

typedef struct options {
    bool binary;
    const char *solution; /* NULL: none */
    tm_medit_kind kind[KINDS_MAX];
    size_t kinds;
} options;

static options o;
static tm_error error;

/* "scalar,vector,tensor" */
static void read_kinds(const filter *f, const char *list)
{
    static const char *const word[] = {[TM_MEDIT_SCALAR] = "scalar",
                                       [TM_MEDIT_VECTOR] = "vector",
                                       [TM_MEDIT_TENSOR] = "tensor"};
    o.kinds = 0;
    for (const char *at = list, *end; at; at = *end ? end + 1 : NULL) {
        end = strchrnul(at, ',');
        int k = TM_MEDIT_SCALAR;
        while (k < TM_MEDIT_KINDS && (strlen(word[k]) != (size_t)(end - at) ||
                                      strncmp(word[k], at, (size_t)(end - at)) != 0))
            k++;
        if (k == TM_MEDIT_KINDS || o.kinds == KINDS_MAX)
            filter_usage_error(f, "--kinds: '%s' is no list of scalar, vector and tensor",
                               list);
        o.kind[o.kinds++] = (tm_medit_kind)k;
    }
}

static void read_options(filter *f)
{
    int c;
    while ((c = filter_option(f)) != -1) {
        if (c == OPTION_BINARY)
            o.binary = true;
        else if (c == OPTION_KINDS)
            read_kinds(f, optarg);
        else
            o.solution = optarg;
    }
    f->binary = o.binary;
    filter_operands(f);
    if (o.kinds > 0 && !o.solution)
        filter_usage_error(f, "--kinds is of --sol");
    filter_other_file(f, "--sol", o.solution);
}

static void leave_out(const filter *f, const tm_stream *stream, size_t polygons)
{
    const char *format =
        o.binary ? o.solution ? "medit-export --binary --sol" : "medit-export --binary"
        : o.solution ? "medit-export --sol"
                     : "medit-export";
    if (polygons > 0)
        filter_leave_out(f, "%zu facets of more than four nodes (.facet)", polygons);
    mesh_leave_out_of(f, stream, format);
}

int main(int argc, char **argv)
{
    filter f = {.name = "medit-export",
                .synopsis = "[--binary] [--sol FILE.sol [--kinds LIST]] [FILE]",
                .purpose = "Writes points, a surface or elements as a mesh of Medit's "
                           "format (.mesh), as\nMmg reads it.",
                .help = "      --binary        binary (.meshb, .solb)\n"
                        "      --sol FILE      the attributes of nodes as its solution\n"
                        "      --kinds LIST    of scalar, vector and tensor: what these "
                        "are (scalars)\n",
                .options = long_options,
                .letters = FILTER_LETTERS};
    tm_stream stream;
    tm_text text = {0}, values = {0};
    size_t polygons = 0;
    filter_start(&f, argc, argv);
    read_options(&f);
    mesh_input_read(&f, &stream);
    filter_stage(&f, "formatting");
    tm_status status =
        tm_medit_write(&text, &stream, o.binary, f.threads, &polygons, &error);
    if (status == TM_OK && o.solution)
        status = tm_medit_write_solution(&values, &stream, o.kind, o.kinds, o.binary,
                                         f.threads, &error);
    if (status != TM_OK)
        mesh_input_fail(&f, &error);
    leave_out(&f, &stream, polygons);
    mesh_input_report(&f, &stream);
    if (o.solution && output_files_write(f.files, o.solution, &values, &error) != TM_OK)
        filter_fail(&f, &error);
    filter_write_text(&f, &text);
    tm_text_free(&text);
    tm_text_free(&values);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
