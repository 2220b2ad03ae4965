/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gmsh-export: a stream as a mesh in a format that Gmsh writes. */
#include "../common/gmsh/gmsh_names.h"
#include "../common/input/left_out.h"
#include "../common/export/rounded.h"
#include "../common/input/mesh_input.h"

#include "../../lib/element/shape.h"

#include <stdlib.h>
#include <string.h>

enum { OPTION_FORMAT = FILTER_OWN, OPTION_BINARY, OPTION_NO_POINTS };

static const struct option long_options[] = {
    {"format", required_argument, NULL, OPTION_FORMAT},
    {"binary", no_argument, NULL, OPTION_BINARY},
    {"no-points", no_argument, NULL, OPTION_NO_POINTS},
    FILTER_OPTIONS};

static const filter_words words[] = {{OPTION_FORMAT, &gmsh_output_formats[0].name,
                                      sizeof *gmsh_output_formats, GMSH_OUTPUTS},
                                     {0}};

static filter f = {
    .name = "gmsh-export",
    .synopsis = "[--format FORMAT] [--binary] [--no-points] OUT [FILE]",
    .purpose =
        "Writes points, triangles, tetrahedra or mixed elements as OUT, a mesh in a\n"
        "format that Gmsh knows, by its library; markers, regions and their names\n"
        "are physical groups. OUT may be - for standard output.",
    .help =
        "      --format FORMAT  not by the suffix of OUT, but msh4, msh40, msh2, msh1,\n"
        "                       mesh, inp, bdf, unv, su2, key, med or cgns\n"
        "      --binary         .msh of version 4.1 or 2.2 in binary\n"
        "      --no-points      no points for nodes with a marker\n",
    .options = long_options,
    .letters = FILTER_LETTERS,
    .words = words,
};

static gmsh_output format = GMSH_OUTPUTS;
static bool points = true;

static void read_options(void)
{
    int c;
    while ((c = filter_option(&f)) != -1) {
        if (c == OPTION_FORMAT)
            format = (gmsh_output)filter_word(&f, c, optarg);
        else if (c == OPTION_BINARY)
            f.binary = true;
        else
            points = false;
    }
}

/* OUT is the first operand, unless -o says it. */
static void read_operands(void)
{
    if (!f.output && !f.forced) {
        if (optind >= f.argc)
            filter_usage_error(&f, "OUT is missing, the file that is to be written");
        f.output = f.argv[optind++];
        if (strcmp(f.output, "-") == 0)
            f.output = NULL;
    }
    if (f.json && f.output && strcmp(f.json, f.output) == 0)
        filter_usage_error(&f, "OUT and --json are the same file, '%s'", f.json);
    if (format == GMSH_OUTPUTS && f.output)
        format = gmsh_output_of(f.output);
    if (format == GMSH_OUTPUTS)
        filter_usage_error(&f,
                           "the format is not known: a suffix (.msh, .msh2, .mesh, .inp, "
                           ".bdf, .unv, .su2, .key, .med, .cgns) or --format says it");
    if (f.binary && !gmsh_output_formats[format].has_binary)
        filter_usage_error(&f, "--binary: only msh4 and msh2 can be binary, not %s",
                           gmsh_output_formats[format].name);
    filter_operands(&f);
}

/* Gmsh leaves cells out without a word that a format, or its writer, does not have. */
static void refuse_cells(const gmsh_plan *plan)
{
    const unsigned shapes = gmsh_output_formats[format].shapes;
    size_t wrong[TM_ELEMENT_NODES + 1] = {0};
    tm_error error;
    for (size_t i = 0, k; i < plan->items[GMSH_CELLS]; i++) {
        tm_row_nodes(plan->item[GMSH_CELLS][i].block, plan->item[GMSH_CELLS][i].row, &k);
        wrong[k] += !(shapes & 1u << k);
    }
    for (size_t k = 0; k <= TM_ELEMENT_NODES; k++)
        if (wrong[k] > 0) {
            tm_fail_at(&error, TM_ERROR_INPUT, NULL, 0, ".mix",
                       "has %zu %s, which Gmsh does not write to the format %s (msh4 has "
                       "them)",
                       wrong[k], tm_element_shapes[k].plural,
                       gmsh_output_formats[format].name);
            mesh_input_fail(&f, &error);
        }
}

/* Numbers run together, or become others, that are too long for a format. */
static void refuse_numbers(const gmsh_plan *plan)
{
    const gmsh_output_format *to = &gmsh_output_formats[format];
    size_t elements = 0;
    int32_t most = 0;
    tm_error error;
    for (int d = 0; d < GMSH_DIMENSIONS; d++) {
        elements += plan->items[d];
        for (size_t i = 0; i < plan->values[d]; i++)
            for (size_t g = 0; g < plan->value[d][i].groups; g++)
                if (plan->value[d][i].group[g] > most)
                    most = plan->value[d][i].group[g];
    }
    if (most > to->most)
        tm_fail(&error, TM_ERROR_INPUT,
                "has a marker or region %d, too long for the format %s (%d at most; msh4 "
                "has it)",
                (int)most, to->name, (int)to->most);
    else if (plan->node->count > to->most_rows || elements > to->most_rows)
        tm_fail(
            &error, TM_ERROR_INPUT,
            "has %zu nodes and %zu elements, too many for the format %s (%zu at most; "
            "msh4 has them)",
            plan->node->count, elements, to->name, to->most_rows);
    else
        return;
    mesh_input_fail(&f, &error);
}

static void leave_out_names(const gmsh_plan *plan)
{
    gmsh_lost_names lost;
    tm_error error;
    if (gmsh_find_lost_names(&lost, plan, format, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    if (lost.cut > 0)
        filter_leave_out(&f, "what %zu names have behind %d bytes (.group)", lost.cut,
                         GMSH_NAME_MOST);
    if (lost.joined > 0)
        filter_leave_out(&f, "%zu names that are others' in this format (.group)",
                         lost.joined);
    if (lost.swapped > 0)
        filter_leave_out(&f,
                         "%zu names of groups with the number of one of a higher "
                         "dimension, whose name Gmsh reads (.group)",
                         lost.swapped);
}

/* What is in the stream, but not in the file. */
static void leave_out(const tm_stream *stream, const gmsh_plan *plan)
{
    char row[64];
    snprintf(row, sizeof row, "%s %s", f.name, gmsh_output_formats[format].name);
    mesh_leave_out_of(&f, stream, row);
    leave_out_names(plan);
    if (plan->unused > 0)
        filter_leave_out(&f, "%zu nodes that nothing has which is written (.node)",
                         plan->unused);
    if (plan->polygons > 0)
        filter_leave_out(&f, "%zu facets of more than four nodes (.facet)",
                         plan->polygons);
    if (plan->renumbered > 0)
        filter_leave_out(&f,
                         "%zu markers and regions below 0, whose groups have other "
                         "numbers",
                         plan->renumbered);
}

static void write_json(const gmsh_plan *plan, size_t bytes)
{
    static const char *const key[] = {"points", "edges", "faces", "cells"};
    tm_json *json = filter_json_begin(&f);
    tm_json_integer(json, "nodes", (int64_t)(plan->node->count - plan->unused));
    for (int d = 0; d < GMSH_DIMENSIONS; d++)
        tm_json_integer(json, key[d], (int64_t)plan->items[d]);
    tm_json_string(json, "format", gmsh_output_formats[format].name);
    tm_json_integer(json, "bytes", (int64_t)bytes);
    filter_json_end(&f);
}

/* As if nodes had none. */
static void forget_markers(tm_block *node)
{
    if (!node)
        return;
    free(node->marker);
    node->marker = NULL;
    node->markers = false;
}

int main(int argc, char **argv)
{
    tm_stream stream;
    tm_text text = {0};
    tm_error error;
    filter_start(&f, argc, argv);
    read_options();
    read_operands();
    mesh_input_read(&f, &stream);
    if (!points)
        forget_markers(tm_stream_find(&stream, ".node"));
    gmsh_plan plan = {.points = gmsh_output_formats[format].has_points &&
                                !mesh_marks_boundary_nodes(&stream)};
    if (gmsh_plan_make(&plan, &stream, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    refuse_cells(&plan);
    refuse_numbers(&plan);
    leave_out(&stream, &plan);
    if (!f.binary)
        rounded_note(&f, &stream, gmsh_output_formats[format].digits);
    filter_stage(&f, "writing by Gmsh");
    if (gmsh_write(&text, &plan, format, f.binary, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    write_json(&plan, text.size);
    filter_write_text(&f, &text);
    gmsh_plan_free(&plan);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
