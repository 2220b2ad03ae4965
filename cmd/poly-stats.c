/* SPDX-License-Identifier: GPL-3.0-or-later */
/* poly-stats: how many polyhedra are simple and star-shaped, and how good they are. */
#include "common/input/mesh_input.h"
#include "common/plot/plot.h"

enum { OPTION_PLOT = FILTER_OWN };

static const struct option long_options[] = {
    {"plot", required_argument, NULL, OPTION_PLOT}, FILTER_OPTIONS};

static void write_plot(const filter *f, const char *file, const tm_poly_statistics *s)
{
    tm_text script = {0};
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

static void measure(const filter *f, const tm_stream *stream, tm_poly_statistics *s)
{
    tm_error error;
    const tm_poly_arrays mesh = tm_poly_arrays_of(stream);
    filter_stage(f, "measuring");
    if (tm_poly_statistics_measure(s, &mesh, f->threads, &error) != TM_OK)
        filter_fail(f, &error);
    if (s->unmatched > 0)
        filter_note(f,
                    "%s: %zu of %zu facets do not belong to the polyhedra that they "
                    "name: see mesh-check",
                    filter_input_name(f), s->unmatched, mesh.facets);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "poly-stats",
        .synopsis = "[--plot FILE.svg] [FILE]",
        .purpose = "Says how good the polyhedra of a mesh are: how many are simple and\n"
                   "star-shaped, their facets and tetrahedra, edges, angles, kernels.",
        .help = "      --plot FILE.svg draw histograms by gnuplot\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .json_is_output = true,
    };
    const char *plot = NULL;
    int c;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1)
        if (c == OPTION_PLOT)
            plot = optarg;
    filter_operands(&f);
    filter_other_file(&f, "--plot", plot);

    tm_stream stream;
    tm_poly_statistics statistics;
    mesh_input_read_to_compute(&f, &stream);
    measure(&f, &stream, &statistics);
    if (f.json) {
        tm_poly_statistics_json(filter_json_begin(&f), &statistics);
        filter_json_end(&f);
    }
    if (plot)
        write_plot(&f, plot, &statistics);
    write_report(&f, &statistics);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
