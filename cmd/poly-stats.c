/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly-stats: how many polyhedra are simple and star-shaped, and how good they are. */
#include "common/input/mesh_input.h"
#include "common/input/mesh_share.h"
#include "common/plot/plot.h"

#include "../lib/examine/ranks/examine_ranks.h"

#include <stdlib.h>

enum { OPTION_PLOT = FILTER_OWN, OPTION_FOR };

static const struct option long_options[] = {
    {"plot", required_argument, NULL, OPTION_PLOT},
    {"for", required_argument, NULL, OPTION_FOR},
    FILTER_OPTIONS};

static const filter_words words[] = {FILTER_WORDS(OPTION_FOR, tm_poly_use_names), {0}};

static void write_plot(const filter *f, const char *file, const tm_poly_statistics *s)
{
    tm_text script = {0};
    if (!filter_speaks())
        return;
    poly_plot_script(&script, s);
    plot_write(f, &script, file);
}

/* What standard output or -o gets; nothing where standard output is for the JSON. */
static void write_report(filter *f, const tm_poly_statistics *s)
{
    if (!filter_has_report(f))
        return;
    tm_text text = {0};
    tm_poly_statistics_table(&text, s);
    filter_write_text(f, &text);
    tm_text_free(&text);
}

static void measure(const filter *f, tm_poly_statistics *s)
{
    tm_error error;
    tm_stream stream;
    mesh_input_read_to_compute(f, &stream);
    const tm_poly_arrays mesh = tm_poly_arrays_of(&stream);
    filter_stage(f, "measuring");
    if (tm_poly_statistics_measure(s, &mesh, f->threads, &error) != TM_OK)
        filter_fail(f, &error);
    tm_stream_free(&stream);
}

/* The same of a mesh of which each rank has a slice. */
static void measure_slices(const filter *f, tm_poly_statistics *s)
{
    tm_error error;
    tm_slices slices;
    mesh_share_read(f, &slices);
    const tm_poly_slices mesh = {.own = tm_poly_arrays_of(&slices.stream),
                                 .nodes = mesh_share_rows(&slices, ".node"),
                                 .facets = mesh_share_rows(&slices, ".facet"),
                                 .cells = mesh_share_rows(&slices, ".cell")};
    filter_stage(f, "measuring");
    filter_agree(f, tm_poly_statistics_ranks(s, &mesh, f->threads, &error), &error);
    tm_slices_free(&slices);
}

static void note_unmatched(const filter *f, const tm_poly_statistics *s)
{
    if (s->unmatched > 0)
        filter_note(f,
                    "%s: %zu of %zu facets do not belong to the polyhedra that they "
                    "name: see mesh-check",
                    filter_input_name(f), s->unmatched, s->size.faces);
}

/* Whether the mesh is fit for what it is wanted for; a note says so, and why not. */
static bool judge(const filter *f, const tm_poly_statistics *s, tm_poly_use use)
{
    const tm_poly_finite_volume *fv = &s->fv;
    const char *name = tm_poly_use_names[use];
    if (tm_poly_is_fit(s, use)) {
        filter_note(f, "fit for %s", name);
        return true;
    }
    filter_note(f, "not fit for %s:", name);
    if (s->non_simple > 0)
        filter_note(f, "%zu polyhedra are no balls", s->non_simple);
    if (!(s->min_volume > 0))
        filter_note(f, "the smallest volume is %.3g", s->min_volume);
    if (use == TM_USE_VEM && s->not_star_shaped > 0)
        filter_note(f, "%zu polyhedra are not star-shaped", s->not_star_shaped);
    if (use == TM_USE_FV && fv->non_orthogonal > 0)
        filter_note(f, "%zu facets are not orthogonal", fv->non_orthogonal);
    if (use == TM_USE_FV && fv->skew > 0)
        filter_note(f, "%zu facets are skew", fv->skew);
    if (use == TM_USE_FV && fv->wrong_pyramids > 0)
        filter_note(f, "%zu pyramids have no volume", fv->wrong_pyramids);
    return false;
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "poly-stats",
        .synopsis = "[--for fv|vem|dg] [--plot FILE.svg] [FILE]",
        .purpose = "Says how good the polyhedra of a mesh are: how many are simple and\n"
                   "star-shaped, their facets and tetrahedra, edges, angles, kernels.",
        .help =
            "      --for USE       exit 1 if they are not fit for it: fv, finite "
            "volumes;\n"
            "                      vem, virtual elements; dg, discontinuous Galerkin\n"
            "      --plot FILE.svg draw histograms by gnuplot\n",
        .options = long_options,
        .words = words,
        .letters = FILTER_LETTERS,
        .json_is_output = true,
        .ranks = true,
    };
    const char *plot = NULL;
    int c, use = TM_POLY_USES;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1)
        if (c == OPTION_PLOT)
            plot = optarg;
        else if (c == OPTION_FOR)
            use = filter_word(&f, OPTION_FOR, optarg);
    filter_operands(&f);
    plot_check_file(&f, plot);

    tm_poly_statistics statistics;
    if (filter_together(&f, true))
        measure_slices(&f, &statistics);
    else
        measure(&f, &statistics);
    note_unmatched(&f, &statistics);
    if (f.json) {
        tm_poly_statistics_json(filter_json_begin(&f), &statistics);
        filter_json_end(&f);
    }
    if (plot)
        write_plot(&f, plot, &statistics);
    write_report(&f, &statistics);
    const bool fit = use == TM_POLY_USES || judge(&f, &statistics, (tm_poly_use)use);
    return filter_finish(&f, fit ? EXIT_SUCCESS : EXIT_GOAL);
}
