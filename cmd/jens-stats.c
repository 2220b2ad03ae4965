/* SPDX-License-Identifier: GPL-3.0-or-later */
/* jens-stats: how good tetrahedra, pyramids, wedges and hexahedra are, by J_ENS and other
 * measures, and whether they are proved to be valid. */
#include "common/input/mesh_input.h"
#include "common/input/mesh_share.h"
#include "common/plot/plot.h"

#include "../lib/base/parallel.h"
#include "../lib/element/aspect_ratio.h"
#include "../lib/element/jens.h"
#include "../lib/element/verdict.h"

#include <stdlib.h>

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
    bool together;  /* with other ranks */
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
    plot_check_file(f, o.plot);
    filter_other_file(f, "--histo", o.histo);
    o.output = o.output ? o.output : 'e';
    o.request.scaled_jacobian = o.output == 's' || o.plot || f->json;
    o.request.others = f->json;
    o.request.threads = f->threads;
    o.together = filter_together(f, true);
    return o;
}

/* Those of .mix or, where there are none, of .ele, which are turned if they must be. */
static tm_elements read_elements(const filter *f, tm_stream *stream)
{
    mesh_input_read_to_compute(f, stream);
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *mix = tm_stream_find(stream, ".mix");
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
        mesh_input_turn(f, stream, ele, "are counted turned");
        elements.count = ele->count;
        elements.item = ele->integer;
    }
    return elements;
}

/* What is measured, on one rank or, of ranks that work together, its share. */
typedef struct mesh {
    tm_stream stream;
    tm_slices slices;
    mesh_share share;
    tm_elements elements;
    unsigned base; /* the index base of the stream */
    size_t before; /* elements that other ranks have before them */
} mesh;

static void read_mesh(const filter *f, mesh *m)
{
    *m = (mesh){0};
    m->elements = read_elements(f, &m->stream);
    m->base = m->stream.base;
}

/* The same of ranks. */
static void read_share(const filter *f, mesh *m)
{
    tm_slice mix = {0, 0}, ele = {0, 0};
    *m = (mesh){0};
    mesh_share_read(f, &m->slices);
    tm_slices_find(&m->slices, ".mix", &mix);
    tm_slices_find(&m->slices, ".ele", &ele);
    if (mix.total > 0 && ele.total > 0)
        filter_note(f, "%s: .ele is not measured, only .mix", filter_input_name(f));
    mesh_share_take(f, &m->share, &m->slices, mix.total > 0 ? ".mix" : ".ele");
    const tm_block *block = m->share.block;
    m->base = m->slices.stream.base;
    m->before = m->share.slice.before;
    if (mix.total == 0 && ele.total > 0)
        mesh_share_turn(f, &m->share, "are counted turned");
    if (block)
        m->elements =
            (tm_elements){(const double(*)[3])m->share.xyz, block->count, block->start,
                          block->start ? block->item : block->integer};
}

static void measure(const filter *f, const options *o, mesh *m, tm_jens_statistics *s)
{
    tm_error error;
    tm_jens_request request = o->request;
    void *chunk;
    size_t chunks;
    request.before = m->before;
    filter_stage(f, "measuring");
    filter_agree(f,
                 tm_jens_statistics_chunks((tm_jens_statistics **)&chunk, &chunks,
                                           &m->elements, &request, &error),
                 &error);
    if (o->together)
        mesh_share_gather(f, &chunk, &chunks, sizeof *s);
    tm_jens_statistics_join(s, chunk, chunks, &request);
    free(chunk);
}

/* Lists ---------------------------------------------------------------------------- */

/* Appends the values of one element. */
typedef void list_element(tm_text *text, size_t nodes, const double (*xyz)[3],
                          const uint32_t *item);

static void value(tm_text *text, double number)
{
    tm_text_append(text, " ", 1);
    tm_text_double(text, number);
}

static void list_jens(tm_text *text, size_t nodes, const double (*xyz)[3],
                      const uint32_t *item)
{
    value(text, tm_jens(nodes, xyz, item));
    value(text, tm_least_scaled_jacobian(nodes, xyz, item));
}

static void list_aspect(tm_text *text, size_t nodes, const double (*xyz)[3],
                        const uint32_t *item)
{
    value(text, tm_aspect_ratio(nodes, xyz, item));
}

static void list_verdict(tm_text *text, size_t nodes, const double (*xyz)[3],
                         const uint32_t *item)
{
    value(text, tm_verdict_scaled_jacobian(nodes, xyz, item));
    value(text, tm_verdict_shape(nodes, xyz, item));
}

/* J_ENS of each node. A node may be of several corners, as the apex of a pyramid: it has
 * the least of them.
 */
static void list_nodes(tm_text *text, size_t nodes, const double (*xyz)[3],
                       const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    double jacobian[TM_ELEMENT_CORNERS], least[TM_ELEMENT_NODES];
    tm_scaled_jacobians(shape, xyz, item, jacobian);
    for (size_t v = 0; v < nodes; v++)
        least[v] = 1;
    for (size_t i = 0; i < shape->corners; i++) {
        const double jens = tm_jens_of(jacobian[i], shape->k[i]);
        double *node = &least[shape->corner[i][0]];
        *node = jens < *node ? jens : *node;
    }
    for (size_t v = 0; v < nodes; v++)
        value(text, least[v]);
}

/* By the options. */
static const struct {
    int output;
    list_element *list;
} lists[] = {
    {'j', list_jens}, {'a', list_aspect}, {'l', list_nodes}, {VERDICT, list_verdict}};

enum { CHUNK = 8192 }; /* elements that one thread lists at a time */

typedef struct listing {
    list_element *list;
    const tm_elements *elements;
    size_t base;
    tm_text *chunk;
} listing;

static void list_chunk(void *context, size_t chunk)
{
    const listing *l = context;
    const tm_elements *elements = l->elements;
    const size_t first = chunk * CHUNK;
    const size_t end = elements->count - first < CHUNK ? elements->count : first + CHUNK;
    tm_text *text = &l->chunk[chunk];
    for (size_t e = first; e < end; e++) {
        size_t nodes;
        const uint32_t *item = tm_element_at(elements, e, &nodes);
        tm_text_integer(text, (int64_t)(e + l->base));
        l->list(text, nodes, elements->xyz, item);
        tm_text_append(text, "\n", 1);
    }
}

/* A line for each element: its number, from base, and its values, in the shortest form
 * that reads back to the same double; the same for every number of threads. */
static tm_status list_elements(tm_text *text, list_element *list,
                               const tm_elements *elements, size_t base, unsigned threads,
                               tm_error *error)
{
    const size_t chunks = elements->count / CHUNK + (elements->count % CHUNK != 0);
    tm_text *chunk = calloc(chunks + 1, sizeof *chunk);
    if (!chunk)
        return tm_fail_memory(error);
    listing l = {list, elements, base, chunk};
    tm_parallel(threads, chunks, list_chunk, &l);
    for (size_t i = 0; i < chunks; i++) {
        tm_text_append(text, chunk[i].byte, chunk[i].size);
        text->failed |= chunk[i].failed;
        tm_text_free(&chunk[i]);
    }
    free(chunk);
    return text->failed ? tm_fail_memory(error) : TM_OK;
}

/* Output --------------------------------------------------------------------------- */

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
static void write_report(filter *f, const options *o, const mesh *m,
                         const tm_jens_statistics *s)
{
    if (!filter_has_report(f))
        return;
    tm_error error;
    tm_text text = {0};
    if (o->output == 'e' || o->output == 's') {
        tm_jens_histogram_table(&text, histogram(o, s), s->elements);
        if (o->request.certify)
            tm_jens_certified_table(&text, s, m->base);
    }
    tm_status status = TM_OK;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        if (lists[i].output == o->output)
            status = list_elements(&text, lists[i].list, &m->elements,
                                   m->base + m->before, f->threads, &error);
    filter_agree(f, status, &error);
    if (o->together && o->output != 'e' && o->output != 's')
        filter_write_texts(f, &text);
    else
        filter_write_text(f, &text);
    tm_text_free(&text);
}

static void write_files(const filter *f, const options *o, const tm_jens_statistics *s)
{
    tm_error error;
    tm_text text = {0};
    if (!filter_speaks())
        return;
    if (o->histo) {
        tm_jens_histogram_file(&text, histogram(o, s));
        if (output_files_write(f->files, o->histo, &text, &error) != TM_OK)
            filter_fail(f, &error);
        tm_text_free(&text);
    }
    if (o->plot) {
        jens_plot_script(&text, s);
        plot_write(f, &text, o->plot);
    }
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
        .ranks = true,
    };
    filter_start(&f, argc, argv);
    const options o = read_options(&f);

    mesh m;
    tm_jens_statistics statistics = {0};
    if (o.together)
        read_share(&f, &m);
    else
        read_mesh(&f, &m);
    measure(&f, &o, &m, &statistics);
    if (f.json) {
        tm_jens_statistics_json(filter_json_begin(&f), &statistics, &o.request, m.base);
        filter_json_end(&f);
    }
    write_files(&f, &o, &statistics);
    write_report(&f, &o, &m, &statistics);
    const bool good = is_good(&f, &o, &statistics);
    mesh_share_free(&m.share);
    tm_slices_free(&m.slices);
    tm_stream_free(&m.stream);
    return filter_finish(&f, good ? 0 : EXIT_GOAL);
}
