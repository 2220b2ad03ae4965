/* SPDX-License-Identifier: GPL-3.0-or-later */
/* octree-repair: a mesh with its octants and its surface in, the same with valid elements
 * out. */
#include "common/app/filter.h"
#include "common/app/repair_files.h"
#include "common/input/surface_input.h"
#include "common/process/mpi_environment.h"

#include "../lib/base/json.h"
#include "../lib/octree/repair/repair.h"
#include "../lib/octree/repair/repair_stream.h"

#include <stdlib.h>
#include <time.h>

enum { METHOD = FILTER_OWN, MAX_GROWTH, TRACE, FEATURE_ANGLE };

static const struct option long_options[] = {
    {"threshold", required_argument, NULL, 't'},
    {"iterations", required_argument, NULL, 'i'},
    {"method", required_argument, NULL, METHOD},
    {"max-growth", required_argument, NULL, MAX_GROWTH},
    {"trace", required_argument, NULL, TRACE},
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    FILTER_OPTIONS};

static const char synopsis[] = "[-t THRESHOLD] [-i MAX] [--method refine|full] "
                               "[--max-growth R] [--trace BASE] [--feature-angle DEG] "
                               "[FILE]";

static const char own_help[] =
    "  -t, --threshold T   elements whose J_ENS is below T are bad, as are those that\n"
    "                      are not valid all over (default 0)\n"
    "  -i, --iterations N  split octants and mesh again N times at most (default 100)\n"
    "      --method M      full (default): nodes are moved, then elements divided, and\n"
    "                      octants split only where that does not do; refine: octants\n"
    "                      that hold a bad element are split, and all is meshed again,\n"
    "                      until there is none\n"
    "      --max-growth R  full: at most R times as many elements (default 1.1)\n"
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
    bool has_surface;
    tm_surface boundary;
} program;

static void read_option(program *p, int c)
{
    static const char *const methods[] = {"refine", "full"};
    switch (c) {
    case 't':
        p->repair.threshold = filter_number(&p->f, "--threshold", optarg, 0, 1);
        break;
    case 'i':
        p->repair.iterations =
            (unsigned)filter_integer(&p->f, "--iterations", optarg, 0, MOST_ITERATIONS);
        break;
    case METHOD:
        p->repair.method =
            (tm_repair_method)filter_word(&p->f, "--method", methods, 2, optarg);
        break;
    case MAX_GROWTH:
        p->repair.growth = filter_number(&p->f, "--max-growth", optarg, 1, most_growth);
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

/* What --method refine says on standard error, and the files of --trace. */
static tm_status visit(void *context, unsigned iteration, const tm_repair_state *state,
                       const uint32_t *bad, size_t count, tm_error *error)
{
    program *p = context;
    if (p->repair.method == TM_REPAIR_REFINE) {
        if (p->f.verbosity >= 0 && count > 0)
            fprintf(stderr, "Octants to improve in iteration %u: %zu\n", iteration,
                    count);
        else if (p->f.verbosity >= 0)
            fprintf(stderr, "No more Octants to improve in iteration %u.\n", iteration);
    } else {
        filter_verbose(&p->f, "octants to improve in iteration %u: %zu", iteration,
                       count);
    }
    if (!p->trace)
        return TM_OK;
    return repair_files_write(p->trace, iteration, state,
                              p->has_surface ? &p->boundary : NULL, bad, count,
                              p->f.threads, error);
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
        left->bad, left->invalid, left->worst, left->held);
}

static void score_json(tm_json *json, const char *key, const tm_repair_score *score,
                       size_t elements, size_t octants)
{
    tm_json_open(json, key, '{');
    tm_json_integer(json, "bad", (int64_t)score->bad);
    tm_json_integer(json, "invalid", (int64_t)score->invalid);
    tm_json_integer(json, "held", (int64_t)score->held);
    tm_json_double(json, "worst", score->worst);
    tm_json_double(json, "average", score->average);
    tm_json_integer(json, "elements", (int64_t)elements);
    tm_json_integer(json, "octants", (int64_t)octants);
    tm_json_close(json, '}');
}

typedef struct {
    size_t elements, octants;
} size;

static void write_json(program *p, const tm_repair_report *report, size before,
                       size after, double seconds)
{
    tm_text text = {0};
    tm_json json = {.text = &text};
    tm_json_open(&json, NULL, '{');
    score_json(&json, "before", &report->before, before.elements, before.octants);
    score_json(&json, "after", &report->after, after.elements, after.octants);
    tm_json_integer(&json, "iterations", (int64_t)report->iterations);
    tm_json_integer(&json, "tips", (int64_t)report->corners);
    tm_json_integer(&json, "divided", (int64_t)report->divided);
    tm_json_double(&json, "seconds", seconds);
    tm_json_close(&json, '}');
    tm_text_string(&text, "\n");
    filter_write_json(&p->f, &text);
    tm_text_free(&text);
}

static size size_of(const tm_repair_state *state, const tm_stream *stream)
{
    const tm_block *octant = tm_stream_find(stream, ".octant");
    const size_t octants = octant ? octant->count : 0;
    return (size){state->mesh.elements, state->remade ? state->octree.leaves : octants};
}

/* Finds the surface, what nodes may do, and the octree. */
static void prepare(program *p, const tm_stream *stream, tm_repair_state *state,
                    tm_repair_notes *notes)
{
    tm_error error;
    build_surface(p, stream);
    mpi_environment_set(&p->f);
    if (tm_repair_prepare(state, stream, p->has_surface ? &p->boundary : NULL, notes,
                          &error) != TM_OK)
        fail(p, &error);
    if (!notes->no_octree.what[0])
        return;
    if (p->repair.method == TM_REPAIR_REFINE)
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
    if (tm_repair_from_stream(&state, stream, &error) != TM_OK)
        fail(p, &error);
    if (tm_repair_is_needed(&state, stream, p->repair.threshold) || p->trace)
        prepare(p, stream, &state, &notes);
    tm_surface *surface = p->has_surface ? &p->boundary : NULL;
    const size before = size_of(&state, stream);
    p->repair.visit = visit;
    p->repair.context = p;
    if (tm_repair(&state, surface, &p->repair, &report, &error) != TM_OK)
        fail(p, &error);
    const size after = size_of(&state, stream);
    const bool done = report.after.bad == 0 && report.after.held == 0;
    if (!done)
        note_left(p, &state, &report.after, stream->base);
    if (tm_repair_to_stream(&state, stream, surface, &notes, &error) != TM_OK)
        filter_fail(&p->f, &error);
    if (notes.dropped[0])
        filter_note(&p->f, "dropped, as they refer to what is no more: %s",
                    notes.dropped);
    filter_write(&p->f, stream, "%zu elements of %zu, bad %zu of %zu", after.elements,
                 before.elements, report.after.bad, report.before.bad);
    if (p->f.json)
        write_json(p, &report, before, after, (double)(clock() - start) / CLOCKS_PER_SEC);
    tm_repair_state_free(&state);
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
    filter_operands(&p.f);
    filter_read(&p.f, &stream);
    const bool done = run(&p, &stream);
    tm_surface_free(&p.boundary);
    tm_stream_free(&stream);
    return filter_finish(&p.f, done ? EXIT_SUCCESS : EXIT_GOAL);
}
