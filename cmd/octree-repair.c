/* SPDX-License-Identifier: GPL-3.0-or-later */
/* octree-repair: a mesh with its octants and its surface in, the same with valid elements
 * out. */
#include "common/input/mesh_input.h"
#include "common/input/octant_list.h"
#include "common/input/surface_input.h"
#include "common/process/mpi_environment.h"

#include "../lib/examine/jens_statistics.h"
#include "../lib/format/mesh_format.h"
#include "../lib/format/oct.h"
#include "../lib/format/vtk/vtk.h"
#include "../lib/octree/repair/repair.h"
#include "../lib/octree/repair/repair_stream.h"
#include "../lib/octree/repair/repair_trace.h"

#include <stdlib.h>
#include <time.h>

enum { METHOD = FILTER_OWN, MAX_GROWTH, OCTANTS, TRACE, FEATURE_ANGLE };

static const struct option long_options[] = {
    {"threshold", required_argument, NULL, 't'},
    {"iterations", required_argument, NULL, 'i'},
    {"method", required_argument, NULL, METHOD},
    {"max-growth", required_argument, NULL, MAX_GROWTH},
    {"octants", required_argument, NULL, OCTANTS},
    {"trace", required_argument, NULL, TRACE},
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    FILTER_OPTIONS};

static const char synopsis[] = "[-t THRESHOLD] [-i MAX] [--method refine|full] "
                               "[--max-growth R] [--octants FILE.ref] [--trace BASE] "
                               "[--feature-angle DEG] [FILE]";

static const char own_help[] =
    "  -t, --threshold T   elements whose J_ENS is below T are bad, as are those that\n"
    "                      are not valid all over (default 0)\n"
    "  -i, --iterations N  split octants and mesh again N times at most (default 100)\n"
    "      --method M      full (default): nodes are moved, then elements divided, and\n"
    "                      octants split only where that does not do; refine: octants\n"
    "                      that hold a bad element are split, and all is meshed again,\n"
    "                      until there is none\n"
    "      --max-growth R  full: at most R times as many elements (default 1.1)\n"
    "      --octants FILE.ref\n"
    "                      first split the octants with these ids once and mesh again:\n"
    "                      one of the N iterations\n"
    "      --trace BASE    write BASE_i.histo, .ref, .oct, .m3d and .vtk of each\n"
    "                      iteration\n"
    "      --feature-angle DEG\n"
    "                      an edge is kept where it is sharper: as for octree-mesh\n"
    "                      (default 40, and none if the surface is rough all over)\n";

static const double default_growth = 1.1, most_growth = 1000, straight_angle = 180;
enum { DEFAULT_ITERATIONS = 100, MOST_ITERATIONS = 1000000 };

typedef struct {
    filter f;
    tm_repair_options repair;
    tm_surface_options surface;
    const char *trace;
    const char *octants; /* the file, and the rows that it lists */
    uint32_t *listed;
    bool has_surface;
    tm_surface boundary;
} program;

static const char *const methods[] = {"refine", "full"};
static const filter_words option_words[] = {FILTER_WORDS(METHOD, methods), {0}};

static void read_option(program *p, int c)
{
    switch (c) {
    case 't':
        p->repair.threshold = filter_number(&p->f, "--threshold", optarg, 0, 1);
        break;
    case 'i':
        p->repair.iterations =
            (unsigned)filter_integer(&p->f, "--iterations", optarg, 0, MOST_ITERATIONS);
        break;
    case METHOD:
        p->repair.method = (tm_repair_method)filter_word(&p->f, METHOD, optarg);
        break;
    case MAX_GROWTH:
        p->repair.growth = filter_number(&p->f, "--max-growth", optarg, 1, most_growth);
        break;
    case OCTANTS:
        p->octants = optarg;
        break;
    case TRACE:
        p->trace = optarg;
        break;
    default:
        p->surface.feature_angle =
            filter_number(&p->f, "--feature-angle", optarg, 0, straight_angle);
        p->surface.unless_rough = false;
    }
}

static void fail(const program *p, tm_error *error)
{
    if (!error->file[0])
        snprintf(error->file, sizeof error->file, "%s", filter_input_name(&p->f));
    filter_fail(&p->f, error);
}

static void build_surface(program *p, const tm_stream *stream)
{
    tm_error error;
    tm_polygon_surface polygons;
    p->has_surface = tm_stream_find(stream, "surface.node") != NULL;
    if (!p->has_surface) {
        filter_note(&p->f,
                    "%s: there is no surface (surface.node and surface.face): "
                    "nodes of the boundary stay where they are, and no octant is "
                    "split",
                    filter_input_name(&p->f));
        return;
    }
    tm_polygon_surface_init(&polygons);
    if (surface_input_of_stream(stream, filter_input_name(&p->f), &polygons, &error) !=
            TM_OK ||
        tm_surface_build(&p->boundary, &polygons, &p->surface, &error) != TM_OK)
        fail(p, &error);
    tm_polygon_surface_free(&polygons);
}

/* The files of --trace ------------------------------------------------------------- */

typedef struct {
    const char *base;
    unsigned iteration, threads;
    const tm_stream *stream;
} writer;

/* Writes the text as BASE_i.SUFFIX and frees it. */
static tm_status put(const writer *w, const char *suffix, tm_text *text, tm_error *error)
{
    tm_text name = {0};
    tm_text_format(&name, "%s_%u.%s", w->base, w->iteration, suffix);
    tm_status status = name.failed || text->failed
                           ? tm_fail_memory(error)
                           : output_file_write(name.byte, text, error);
    tm_text_free(&name);
    tm_text_free(text);
    return status;
}

static tm_status write_histogram(const writer *w, tm_error *error)
{
    const tm_block *node = tm_stream_find(w->stream, ".node");
    const tm_block *mix = tm_stream_find(w->stream, ".mix");
    const tm_elements elements = {(const double(*)[3])node->real, mix->count, mix->start,
                                  mix->item};
    const tm_jens_request request = {.threads = w->threads};
    tm_jens_statistics statistics = {0};
    tm_text text = {0};
    const tm_status status =
        tm_jens_statistics_measure(&statistics, &elements, &request, error);
    if (status != TM_OK)
        return status;
    tm_jens_histogram_file(&text, &statistics.jens);
    return put(w, "histo", &text, error);
}

static tm_status write_octants(const writer *w, const uint32_t *id,
                               const uint32_t *octant, size_t count, tm_error *error)
{
    tm_text text = {0};
    for (size_t i = 0; i < count; i++)
        tm_text_format(&text, "%u\n", id ? id[octant[i]] : octant[i]);
    return put(w, "ref", &text, error);
}

static tm_status write_mesh(const writer *w, const char *suffix, mesh_writer *write,
                            tm_error *error)
{
    tm_text text = {0};
    const tm_status status = write(&text, w->stream, w->threads, error);
    if (status == TM_OK)
        return put(w, suffix, &text, error);
    tm_text_free(&text);
    return status;
}

/* With the ids by which .ref names octants. */
static tm_status write_oct(tm_text *text, const tm_stream *stream, unsigned threads,
                           tm_error *error)
{
    return tm_oct_write(text, stream, true, threads, error);
}

/* Of the elements nothing but their shape. */
static tm_status write_vtk(tm_text *text, const tm_stream *stream, unsigned threads,
                           tm_error *error)
{
    const tm_vtk_options elements = {.boundary = false};
    return tm_vtk_write(text, stream, &elements, threads, error);
}

/* Writes BASE_i.histo, .m3d, .vtk, and, where there are octants, .oct; BASE_i.ref, with
 * the ids of `count` octants, a line each, where there are some. Each is whole
 * or not there. */
static tm_status write_trace(const program *p, unsigned iteration,
                             const tm_repair_state *state, const uint32_t *octant,
                             size_t count, tm_error *error)
{
    tm_stream stream;
    tm_stream_init(&stream);
    const writer w = {p->trace, iteration, p->f.threads, &stream};
    tm_status status =
        tm_repair_trace(state, p->has_surface ? &p->boundary : NULL, &stream, error);
    if (status == TM_OK)
        status = write_histogram(&w, error);
    if (status == TM_OK && count > 0)
        status = write_octants(&w, state->id, octant, count, error);
    if (status == TM_OK)
        status = write_mesh(&w, "m3d", tm_m3d_write, error);
    if (status == TM_OK)
        status = write_mesh(&w, "vtk", write_vtk, error);
    if (status == TM_OK && state->octree.leaves > 0)
        status = write_mesh(&w, "oct", write_oct, error);
    tm_stream_free(&stream);
    return status;
}

/* What --method refine says on standard error, and the files of --trace. */
static tm_status visit(void *context, unsigned iteration, const tm_repair_state *state,
                       const uint32_t *bad, size_t count, tm_error *error)
{
    program *p = context;
    if (p->repair.method == TM_REPAIR_REFINE) {
        if (p->f.verbosity >= 0 && count > 0)
            filter_print(&p->f, "Octants to improve in iteration %u: %zu", iteration,
                         count);
        else if (p->f.verbosity >= 0)
            filter_print(&p->f, "No more Octants to improve in iteration %u.", iteration);
    } else {
        filter_verbose(&p->f, "octants to improve in iteration %u: %zu", iteration,
                       count);
    }
    return p->trace ? write_trace(p, iteration, state, bad, count, error) : TM_OK;
}

/* What is left to do: a line for each octant, and one for all. */
static void note_left(const program *p, const tm_repair_state *state,
                      const tm_repair_score *left, unsigned base)
{
    tm_error error;
    uint32_t *octant;
    size_t count;
    if (tm_repair_bad_octants(state, p->repair.threshold, true, &octant, &count,
                              &error) != TM_OK)
        filter_fail(&p->f, &error);
    for (size_t i = 0; i < count; i++)
        filter_note(&p->f, "octant %zu is left to improve", octant[i] + (size_t)base);
    free(octant);
    filter_note(
        &p->f,
        "%zu elements are still bad (%zu of them invalid, the worst J_ENS %g) and "
        "%zu nodes not on the surface",
        left->bad, left->invalid, left->worst, left->off_surface);
}

/* Before the repair, or after it. */
typedef struct {
    tm_repair_score score;
    size_t elements, octants;
} mesh_state;

static mesh_state state_of(const tm_repair_state *state, const tm_stream *stream)
{
    const size_t octants =
        state->remade ? state->octree.leaves : mesh_rows(stream, ".octant");
    return (mesh_state){.elements = state->mesh.elements, .octants = octants};
}

static void write_json(filter *f, const mesh_state *before, const mesh_state *after,
                       const tm_repair_report *report, double seconds)
{
    static const tm_report_row rows[] = {
        TM_REPORT_ROW("bad", NULL, NULL, mesh_state, score.bad),
        TM_REPORT_ROW("invalid", NULL, NULL, mesh_state, score.invalid),
        TM_REPORT_ROW("held", NULL, NULL, mesh_state, score.off_surface),
        TM_REPORT_ROW("worst", NULL, NULL, mesh_state, score.worst),
        TM_REPORT_ROW("average", NULL, NULL, mesh_state, score.average),
        TM_REPORT_ROW("elements", NULL, NULL, mesh_state, elements),
        TM_REPORT_ROW("octants", NULL, NULL, mesh_state, octants),
        {0}};
    static const tm_report_row done[] = {
        TM_REPORT_ROW("iterations", NULL, NULL, tm_repair_report, iterations),
        TM_REPORT_ROW("tips", NULL, NULL, tm_repair_report, corners),
        TM_REPORT_ROW("divided", NULL, NULL, tm_repair_report, divided),
        {0}};
    tm_json *json = filter_json_begin(f);
    tm_report_object(json, "before", rows, before);
    tm_report_object(json, "after", rows, after);
    tm_report_json(json, done, report);
    tm_json_double(json, "seconds", seconds);
    filter_json_end(f);
}

/* Finds the surface, what nodes may do, and the octree. */
static void prepare(program *p, const tm_stream *stream, tm_repair_state *state,
                    tm_repair_notes *notes)
{
    tm_error error;
    filter_stage(&p->f, "preparing");
    if (p->octants)
        p->listed = octant_list_read(&p->f, p->octants, stream, &p->repair.octants);
    p->repair.octant = p->listed;
    build_surface(p, stream);
    mpi_environment_set(&p->f);
    if (tm_repair_prepare(state, stream, p->has_surface ? &p->boundary : NULL, notes,
                          &error) != TM_OK)
        fail(p, &error);
    if (!notes->no_octree.what[0])
        return;
    if (p->repair.method == TM_REPAIR_REFINE || p->repair.octants > 0)
        fail(p, &notes->no_octree);
    filter_note(&p->f, "%s: no octant is split: %s", filter_input_name(&p->f),
                notes->no_octree.what);
}

/* Repairs the mesh in the stream; returns whether nothing is left to do. */
static bool run(program *p, tm_stream *stream)
{
    tm_error error;
    tm_repair_state state;
    tm_repair_notes notes = {0};
    tm_repair_report report;
    const clock_t start = clock();
    filter_stage(&p->f, "examining");
    if (tm_repair_from_stream(&state, stream, &error) != TM_OK)
        fail(p, &error);
    if (tm_repair_is_needed(&state, stream, p->repair.threshold) || p->trace ||
        p->octants)
        prepare(p, stream, &state, &notes);
    tm_surface *surface = p->has_surface ? &p->boundary : NULL;
    mesh_state before = state_of(&state, stream);
    p->repair.visit = visit;
    p->repair.context = p;
    p->repair.progress = filter_progress(&p->f);
    if (tm_repair(&state, surface, &p->repair, &report, &error) != TM_OK)
        fail(p, &error);
    mesh_state after = state_of(&state, stream);
    before.score = report.before;
    after.score = report.after;
    const bool done = report.after.bad == 0 && report.after.off_surface == 0;
    if (!done)
        note_left(p, &state, &report.after, stream->base);
    if (tm_repair_to_stream(&state, stream, surface, &notes, &error) != TM_OK)
        filter_fail(&p->f, &error);
    if (notes.dropped[0])
        filter_leave_out(&p->f, "what refers to elements that are no more (%s)",
                         notes.dropped);
    write_json(&p->f, &before, &after, &report,
               (double)(clock() - start) / CLOCKS_PER_SEC);
    filter_write(&p->f, stream, "%zu elements of %zu, bad %zu of %zu", after.elements,
                 before.elements, report.after.bad, report.before.bad);
    tm_repair_state_free(&state);
    free(p->listed);
    return done;
}

int main(int argc, char **argv)
{
    program p = {
        .f = {.name = "octree-repair",
              .synopsis = synopsis,
              .purpose = "Makes the elements of an octree's mesh valid and good: "
                         "moves nodes,\n"
                         "divides elements, and refines octants.",
              .help = own_help,
              .options = long_options,
              .words = option_words,
              .letters = "t:i:" FILTER_LETTERS},
        .repair = {.method = TM_REPAIR_FULL,
                   .iterations = DEFAULT_ITERATIONS,
                   .growth = default_growth},
        .surface = {
            .feature_angle = TM_FEATURE_ANGLE, .unless_rough = true, .lenient = true}};
    tm_stream stream;
    int c;
    filter_start(&p.f, argc, argv);
    while ((c = filter_option(&p.f)) != -1)
        read_option(&p, c);
    if (p.octants && p.repair.iterations == 0)
        filter_usage_error(&p.f, "--octants is an iteration, but -i allows none");
    filter_operands(&p.f);
    filter_read(&p.f, &stream);
    const bool done = run(&p, &stream);
    tm_surface_free(&p.boundary);
    tm_stream_free(&stream);
    return filter_finish(&p.f, done ? EXIT_SUCCESS : EXIT_GOAL);
}
