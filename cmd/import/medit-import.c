/* SPDX-License-Identifier: GPL-3.0-or-later */
/* medit-import: a mesh of Medit's format, with a solution, as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/medit/medit.h"

enum { OPTION_SOL = FILTER_OWN };

static const struct option long_options[] = {{"sol", required_argument, NULL, OPTION_SOL},
                                             FILTER_OPTIONS};

static const char *solution; /* NULL: none */

static void say(const filter *f, const tm_medit_report *r)
{
    if (r->attributes.size > 0)
        filter_note(f, "%s: attributes of nodes: %s", filter_input_name(f),
                    r->attributes.byte);
    mesh_note_count(f, r->turned, "elements were left-handed and are turned");
    mesh_note_count(f, r->cut,
                    "quadrilaterals of the surface are two triangles each now");
    mesh_leave_out_middles(f, r->middle_nodes, r->higher_order);
    mesh_leave_out_count(f, r->loose, "faces that no element has");
    if (r->marks.size > 0)
        filter_leave_out(f, "%s", r->marks.byte);
    if (r->sections.size > 0)
        filter_leave_out(f, "other sections: %s", r->sections.byte);
}

static tm_status read_medit(const filter *f, tm_stream *stream, const tm_text *bytes,
                            tm_error *error)
{
    const tm_medit_bytes mesh = {filter_input_name(f), bytes->byte, bytes->size};
    tm_text values = {0};
    tm_medit_report report;
    if (solution)
        filter_read_file(f, solution, &values);
    const tm_medit_bytes of_solution = {solution, values.byte, values.size};
    const tm_status status =
        tm_medit_read(stream, &mesh, solution ? &of_solution : NULL, &report, error);
    if (status == TM_OK)
        say(f, &report);
    tm_medit_report_free(&report);
    tm_text_free(&values);
    return status;
}

int main(int argc, char **argv)
{
    filter f = {.name = "medit-import",
                .synopsis = "[--sol FILE.sol] [FILE.mesh]",
                .purpose =
                    "Reads a mesh of Medit's format (.mesh, .meshb), as Mmg writes it: "
                    "points, a\nsurface or elements.",
                .help = "      --sol FILE      its solution (.sol, .solb): attributes of "
                        "nodes\n",
                .options = long_options,
                .letters = FILTER_LETTERS};
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        solution = optarg; /* OPTION_SOL */
    filter_operands(&f);
    return mesh_read(&f, read_medit);
}
