/* SPDX-License-Identifier: GPL-3.0-or-later */
/* jens-stats: how good tetrahedra, pyramids, wedges and hexahedra are, by J_ENS and other
 * measures, and whether they are proved to be valid. */
#include "common/filter.h"
#include "common/gnuplot.h"
#include "common/jens_list.h"
#include "common/jens_plot.h"

#include "../lib/format/tetgen_orient.h"

#include <string.h>

enum { HISTO = FILTER_OWN, PLOT, FAIL_BELOW, CERTIFY, VERDICT };

static const struct option long_options[] = {
    {"jens", no_argument, NULL, 'e'},
    {"scaled-jacobian", no_argument, NULL, 's'},
    {"elements", no_argument, NULL, 'j'},
    {"aspect-ratio", no_argument, NULL, 'a'},
    {"nodes", no_argument, NULL, 'l'},
    {"verdict", no_argument, NULL, VERDICT},
    {"histo", required_argument, NULL, HISTO},
    {"plot", required_argument, NULL, PLOT},
    {"fail-below", required_argument, NULL, FAIL_BELOW},
    {"certify", no_argument, NULL, CERTIFY},
    FILTER_OPTIONS};

static const char own_help[] =
    "  -e, --jens          the histogram of J_ENS (this is the default)\n"
    "  -s, --scaled-jacobian\n"
    "                      the histogram of the scaled Jacobian\n"
    "  -j, --elements      a line per element: number, J_ENS, scaled Jacobian\n"
    "  -a, --aspect-ratio  a line per element: number, aspect ratio\n"
    "  -l, --nodes         a line per element: number, J_ENS of each of its nodes\n"
    "      --verdict       a line per element: number, scaled Jacobian and shape as\n"
    "                      VTK has them\n"
    "      --histo FILE    write the histogram to FILE as well, in two columns\n"
    "      --plot FILE.svg draw both histograms by gnuplot\n"
    "      --fail-below T  exit status 1 if an element is worse than T\n"
    "      --certify       prove that the Jacobian determinant is positive everywhere\n"
    "                      in each element; exit status 1 if it is not\n";

typedef struct options {
    int output; /* the letter of what is printed; VERDICT */
    const char *histo;
    const char *plot;
    bool has_limit; /* --fail-below */
    tm_jens_request request;
} options;

static void choose(const filter *f, options *o, int output)
{
    if (o->output && o->output != output)
        filter_usage_error(f, "only one of -e, -s, -j, -a, -l and --verdict");
    o->output = output;
}

static options read_options(filter *f)
{
    options o = {0};
    int c;
    while ((c = filter_option(f)) != -1) {
        switch (c) {
        case HISTO:
            o.histo = optarg;
            break;
        case PLOT:
            o.plot = optarg;
            break;
        case FAIL_BELOW:
            o.request.threshold = filter_number(f, "--fail-below", optarg, -1, 1);
            o.has_limit = true;
            break;
        case CERTIFY:
            o.request.certify = true;
            break;
        default:
            choose(f, &o, c);
        }
    }
    filter_operands(f);
    o.output = o.output ? o.output : 'e';
    o.request.scaled_jacobian = o.output == 's' || o.plot || f->json;
    o.request.others = f->json;
    o.request.threads = f->threads;
    return o;
}

static void refuse_polyhedra(const filter *f)
{
    tm_error error;
    tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, ".cell",
               "jens-stats reads mixed elements (.mix) or tetrahedra (.ele); poly-stats "
               "reads polyhedra");
    filter_fail(f, &error);
}

/* Those of .mix or, where there are none, of .ele, which are turned if they must be. */
static tm_elements read_elements(const filter *f, tm_stream *stream)
{
    filter_read(f, stream);
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *mix = tm_stream_find(stream, ".mix");
    const tm_block *cell = tm_stream_find(stream, ".cell");
    tm_block *ele = tm_stream_find(stream, ".ele");
    const bool has_tetrahedra = ele && ele->count > 0;
    tm_elements elements = {.xyz = node ? (const double(*)[3])node->real : NULL};
    if (mix && mix->count > 0) {
        if (has_tetrahedra)
            filter_note(f, "%s: .ele is not measured, only .mix", filter_input_name(f));
        elements.count = mix->count;
        elements.start = mix->start;
        elements.item = mix->item;
    } else if (has_tetrahedra) {
        const tm_turned turned = tm_tetgen_orient(node, ele);
        if (turned.turned > 0)
            filter_note(f,
                        "%s: %zu of %zu tetrahedra were left-handed and are counted "
                        "turned",
                        filter_input_name(f), turned.turned, ele->count);
        elements.count = ele->count;
        elements.item = ele->integer;
    } else if (cell && cell->count > 0) {
        refuse_polyhedra(f);
    }
    return elements;
}

static bool all_certified(const tm_jens_statistics *s)
{
    return s->certified[TM_POSITIVE].count == s->elements;
}

/* The histogram that is printed, or would be. */
static const tm_jens_histogram *histogram(const options *o, const tm_jens_statistics *s)
{
    return o->output == 's' ? &s->scaled_jacobian : &s->jens;
}

/* What standard output or -o gets; nothing where standard output is for the JSON. */
static void write_report(filter *f, const options *o, const tm_elements *elements,
                         const tm_jens_statistics *s, unsigned base)
{
    static const int letter[] = {[JENS_LIST_ELEMENTS] = 'j',
                                 [JENS_LIST_ASPECT] = 'a',
                                 [JENS_LIST_NODES] = 'l',
                                 [JENS_LIST_VERDICT] = VERDICT};
    if (!f->output && f->json && strcmp(f->json, "-") == 0)
        return;
    tm_error error;
    tm_text text = {0};
    if (o->output == 'e' || o->output == 's') {
        tm_jens_histogram_table(&text, histogram(o, s), s->elements);
        if (o->request.certify)
            tm_jens_certified_table(&text, s, base);
    }
    for (size_t i = 0; i < sizeof letter / sizeof *letter; i++)
        if (letter[i] == o->output && jens_list(&text, (jens_list_kind)i, elements, base,
                                                f->threads, &error) != TM_OK)
            filter_fail(f, &error);
    filter_write_text(f, &text);
    tm_text_free(&text);
}

static void write_files(const filter *f, const options *o, const tm_jens_statistics *s)
{
    tm_error error;
    tm_text text = {0};
    if (o->histo) {
        tm_jens_histogram_file(&text, histogram(o, s));
        if (output_file_write(o->histo, &text, &error) != TM_OK)
            filter_fail(f, &error);
        tm_text_free(&text);
    }
    if (o->plot) {
        jens_plot_script(&text, s);
        if (gnuplot_plot(&text, o->plot, &error) != TM_OK)
            filter_fail(f, &error);
        tm_text_free(&text);
    }
}

static void write_json(filter *f, const options *o, const tm_jens_statistics *s,
                       unsigned base)
{
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_json_open(&json, NULL, '{');
    tm_jens_statistics_json(&json, s, &o->request, base);
    tm_json_close(&json, '}');
    tm_text_string(&text, "\n");
    filter_write_json(f, &text);
    tm_text_free(&text);
}

/* Whether the elements are as good as was asked for; says what is not. */
static bool is_good(const filter *f, const options *o, const tm_jens_statistics *s)
{
    const tm_jens_histogram *h = histogram(o, s);
    const bool reached = !o->has_limit || h->all.worst >= o->request.threshold;
    const bool certified = !o->request.certify || all_certified(s);
    if (!reached)
        filter_note(f, "%zu of %zu elements are worse than %g, the worst %g", h->below,
                    s->elements, o->request.threshold, h->all.worst);
    if (!certified)
        filter_note(f, "%zu of %zu elements are not certified",
                    s->elements - s->certified[TM_POSITIVE].count, s->elements);
    return reached && certified;
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "jens-stats",
        .synopsis = "[-e | -s | -j | -a | -l | --verdict] [--histo FILE] [--plot "
                    "FILE.svg] [--fail-below T] [--certify] [FILE]",
        .purpose =
            "Says how good tetrahedra, pyramids, wedges and hexahedra are: histograms "
            "of\n"
            "the element-normalised scaled Jacobian, J_ENS, and other measures; proves\n"
            "that elements are valid.",
        .help = own_help,
        .options = long_options,
        .letters = "esjal" FILTER_LETTERS_NOT_J,
        .json_is_output = true,
        .j_is_own = true,
    };
    filter_start(&f, argc, argv);
    const options o = read_options(&f);

    tm_stream stream;
    tm_error error;
    tm_jens_statistics statistics = {0};
    const tm_elements elements = read_elements(&f, &stream);
    if (tm_jens_statistics_measure(&statistics, &elements, &o.request, &error) != TM_OK)
        filter_fail(&f, &error);
    write_files(&f, &o, &statistics);
    write_report(&f, &o, &elements, &statistics, stream.base);
    if (f.json)
        write_json(&f, &o, &statistics, stream.base);
    const bool good = is_good(&f, &o, &statistics);
    tm_stream_free(&stream);
    return filter_finish(&f, good ? 0 : EXIT_GOAL);
}
