/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_import.h"

#include "mesh_input.h"

#include <string.h>

enum { OPTION_MARKER = FILTER_OWN, OPTION_REGION };

static const struct option long_options[] = {
    {"marker", required_argument, NULL, OPTION_MARKER},
    {"region", required_argument, NULL, OPTION_REGION},
    FILTER_OPTIONS};

static tm_vtk_read_options options;
static vtk_reader *reader;

static void note_names(const filter *f, const char *what, const tm_text *names)
{
    if (names->size > 0)
        filter_note(f, "%s: %s: %s", filter_input_name(f), what, names->byte);
}

/* Where an option did not say so, and it is not the name that vtu-export writes. */
static void note_choice(const filter *f, const char *what, const char *array,
                        const char *option, const char *plain)
{
    if (array && !option && strcmp(array, plain) != 0)
        filter_note(f, "%s: cell data '%s' are %s (--%s takes others)",
                    filter_input_name(f), array, what, plain);
}

static void say(const filter *f, const tm_vtk_read_report *r)
{
    note_choice(f, "regions", r->region, options.region, "region");
    note_choice(f, "markers", r->marker, options.marker, "marker");
    note_names(f, "attributes of nodes", &r->node_attributes);
    note_names(f, "attributes of elements, after the region", &r->cell_attributes);
    mesh_note_count(f, r->turned, "elements were left-handed and are turned");
    mesh_note_count(f, r->joined, "points of several pieces are the same and joined");
    mesh_note_count(f, r->ghosts, "cells are ghosts of other pieces and left out");
    mesh_note_count(f, r->cut, "polygons of the surface are cut into triangles");
    if (r->higher_order > 0)
        filter_leave_out(f,
                         "%zu nodes of %zu elements of second or higher order, of which "
                         "the corners are taken",
                         r->middle_nodes, r->higher_order);
    mesh_leave_out_count(f, r->loose, "polygons that are no face of an element");
    mesh_leave_out_count(f, r->vertices, "cells of one point");
    mesh_leave_out_count(f, r->empty, "cells without points");
    if (r->left_out.size > 0)
        filter_leave_out(f, "data: %s", r->left_out.byte);
    if (r->measures.size > 0)
        filter_verbose(f, "%s: measures of vtu-export, left out: %s",
                       filter_input_name(f), r->measures.byte);
    if (r->polygons_joined > 0)
        filter_verbose(f, "%s: %zu polygons were there before and are joined",
                       filter_input_name(f), r->polygons_joined);
}

/* The name of a piece is from the folder on that its list is in. */
static tm_status load_piece(void *context, const char *source, tm_text *name,
                            tm_text *bytes, tm_error *error)
{
    const filter *f = context;
    const char *slash = f->input ? strrchr(f->input, '/') : NULL;
    if (slash && *source != '/')
        tm_text_append(name, f->input, (size_t)(slash + 1 - f->input));
    tm_text_string(name, source);
    if (name->failed)
        return tm_fail_memory(error);
    filter_read_file(f, name->byte, bytes);
    return TM_OK;
}

static tm_status read_grid(const filter *f, tm_stream *stream, const tm_text *bytes,
                           tm_error *error)
{
    tm_vtk_read_report report;
    options.threads = f->threads;
    options.load = load_piece;
    options.context = (void *)(uintptr_t)f;
    const tm_status status = reader(stream, bytes->byte, bytes->size,
                                    filter_input_name(f), &options, &report, error);
    if (status == TM_OK)
        say(f, &report);
    tm_vtk_read_report_free(&report);
    return status;
}

int vtk_import(int argc, char **argv, const char *name, const char *purpose,
               vtk_reader *read)
{
    filter f = {
        .name = name,
        .synopsis = "[--region NAME] [--marker NAME] [FILE]",
        .purpose = purpose,
        .help = "      --region NAME   the cell data that are regions of elements\n"
                "      --marker NAME   the cell data that are markers of the others\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    int c;
    reader = read;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1) {
        if (c == OPTION_REGION)
            options.region = optarg;
        else
            options.marker = optarg;
    }
    filter_operands(&f);
    return mesh_read(&f, read_grid);
}
