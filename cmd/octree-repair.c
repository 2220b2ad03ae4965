/* SPDX-License-Identifier: GPL-3.0-or-later */
/* octree-repair: a mesh with its octants and its surface in, the same with valid elements
 * out. */
#include "common/input/mesh_input.h"
#include "common/input/mesh_share.h"
#include "common/input/octant_list.h"
#include "common/input/surface_input.h"
#include "common/process/early_end.h"
#include "common/process/mpi_environment.h"
#include "common/repair/repair_trace_files.h"

#include "../lib/octree/forest/mpi_start.h"
#include "../lib/octree/shared_repair/repair_share.h"
#include "../lib/ranks/ranks.h"
#include "../lib/octree/repair/repair.h"
#include "../lib/octree/repair/repair_forced.h"
#include "../lib/octree/repair/repair_shape.h"
#include "../lib/octree/repair/repair_stream.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

enum { METHOD = FILTER_OWN, MAX_GROWTH, OCTANTS, TIME, TRACE, FEATURE_ANGLE };

static const struct option long_options[] = {
    {"threshold", required_argument, NULL, 't'},
    {"iterations", required_argument, NULL, 'i'},
    {"method", required_argument, NULL, METHOD},
    {"max-growth", required_argument, NULL, MAX_GROWTH},
    {"octants", required_argument, NULL, OCTANTS},
    {"time", required_argument, NULL, TIME},
    {"trace", required_argument, NULL, TRACE},
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    FILTER_OPTIONS};

static const char synopsis[] =
    "[-t THRESHOLD] [-i MAX] [--method refine|full] "
    "[--max-growth R] [--octants FILE.ref] [--time S] [--trace BASE] "
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
    "      --time S        begin nothing more after S seconds, and write what is best\n"
    "                      then, as after SIGINT or SIGTERM\n"
    "      --trace BASE    write BASE_i.histo, .ref, .oct, .m3d and .vtk of each\n"
    "                      iteration\n"
    "      --feature-angle DEG\n"
    "                      an edge is kept where it is sharper: as for octree-mesh\n"
    "                      (default 40, and none if the surface is rough all over)\n";

static const double default_growth = 1.1, most_growth = 1000, most_time = 1e9,
                    straight_angle = 180;
enum { DEFAULT_ITERATIONS = 100, MOST_ITERATIONS = 1000000 };

typedef struct {
    filter f;
    tm_repair_options repair;
    tm_surface_options surface;
    double time; /* seconds; 0: no limit */
    const char *trace;
    const char *octants; /* the file, and the rows that it lists */
    uint32_t *listed;
    bool has_surface, has_regions; /* nodes between regions have places, too */
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
    case TIME:
        p->time = filter_number(&p->f, "--time", optarg, 0, most_time);
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

/* The surface of a stream that has one. */
static tm_status build_surface(program *p, const tm_stream *stream, tm_error *error)
{
    tm_polygon_surface polygons;
    tm_polygon_surface_init(&polygons);
    tm_status status =
        surface_input_of_stream(stream, filter_input_name(&p->f), &polygons, error);
    p->surface.walls = true;
    p->surface.threads = p->f.threads;
    while (status == TM_OK) {
        status = tm_surface_build(&p->boundary, &polygons, &p->surface, error);
        if (status != TM_ERROR_INPUT || !p->boundary.walls)
            break;
        tm_surface_free(&p->boundary); /* not what walls are: edges to be cut open */
        p->surface.walls = false;
        status = TM_OK;
    }
    tm_polygon_surface_free(&polygons);
    return status;
}

static void find_surface(program *p, const tm_stream *stream)
{
    tm_error error;
    p->has_surface = tm_stream_find(stream, "surface.node") != NULL;
    if (!p->has_surface) {
        filter_note(&p->f,
                    "%s: there is no surface (surface.node and surface.face): "
                    "nodes of the boundary stay where they are, and no octant is "
                    "split",
                    filter_input_name(&p->f));
        return;
    }
    if (build_surface(p, stream, &error) != TM_OK)
        fail(p, &error);
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
    const repair_trace to = {p->trace, iteration, p->f.threads};
    const tm_surface *surface = p->has_surface ? &p->boundary : NULL;
    return p->trace ? repair_trace_write(&to, state, surface, bad, count, error) : TM_OK;
}

/* Before the repair, or after it. */
typedef struct {
    tm_repair_score score;
    size_t forced; /* of those that are bad by the score: repair_forced.h */
    size_t elements, octants;
    tm_repair_shape shape;
    tm_surface_comparison apart;
} mesh_state;

/* What is left to do. */
typedef struct {
    uint32_t *octant; /* ascending */
    size_t octants;
} remainder_list;

/* Marks elements that are below the threshold only because the surface is as sharp;
 * malloc'ed. */
static bool *find_forced(const program *p, const tm_repair_state *state, size_t *count)
{
    tm_error error;
    bool *forced = calloc(state->mesh.elements + 1, sizeof *forced);
    if ((forced ? tm_repair_find_forced(state, p->repair.threshold, forced, count, &error)
                : tm_fail_memory(&error)) != TM_OK)
        filter_fail(&p->f, &error);
    return forced;
}

static remainder_list find_left(const program *p, const tm_repair_state *state)
{
    tm_error error;
    remainder_list left;
    size_t count;
    bool *forced = find_forced(p, state, &count);
    if (tm_repair_bad_octants(state, p->repair.threshold, true, forced, &left.octant,
                              &left.octants, &error) != TM_OK)
        filter_fail(&p->f, &error);
    free(forced);
    return left;
}

/* A line for each of the first octants, and one for all. */
static void note_left(const program *p, const remainder_list *left,
                      const tm_repair_score *score, unsigned base)
{
    enum { NAMED = 6 };
    for (size_t i = 0; i < left->octants && i < NAMED; i++)
        filter_note(&p->f, "octant %zu is left to improve",
                    left->octant[i] + (size_t)base);
    if (left->octants > NAMED)
        filter_note(&p->f,
                    "%zu more octants are left to improve (--json and --trace list all)",
                    left->octants - NAMED);
    filter_note(
        &p->f,
        "%zu elements are still bad (%zu of them invalid, the worst J_ENS %g) and "
        "%zu nodes not on the surface",
        score->bad, score->invalid, score->worst, score->off_surface);
}

/* What regions elements are in, where nodes between these have places. */
static tm_mixed_regions regions_of(const program *p, const tm_repair_state *state,
                                   const tm_stream *stream)
{
    const tm_block *mix = tm_stream_find(stream, ".mix");
    if (!p->has_regions || state->remade)
        return (tm_mixed_regions){0};
    return (tm_mixed_regions){mix->attribute, mix->attributes, state->origin};
}

static mesh_state state_of(const program *p, const tm_repair_state *state,
                           const tm_stream *stream, const tm_repair_score *score)
{
    const size_t octants =
        state->remade ? state->octree.leaves : mesh_rows(stream, ".octant");
    const tm_mixed_regions regions = regions_of(p, state, stream);
    mesh_state m = {
        .score = *score, .elements = state->mesh.elements, .octants = octants};
    tm_error error;
    if (score->bad > 0)
        free(find_forced(p, state, &m.forced));
    m.score.bad -= m.forced;
    if (!p->f.json || !p->has_surface)
        return m;
    filter_stage(&p->f, "measuring");
    if (tm_repair_shape_measure(&m.shape, state, &p->boundary, &error) != TM_OK ||
        tm_repair_shape_compare(&m.apart, state, &regions, &p->boundary,
                                p->surface.feature_angle, &error) != TM_OK)
        filter_fail(&p->f, &error);
    for (int to = 0; to < 2; to++) /* there may be no sharp edge to measure from or to */
        if (!isfinite(m.apart.curve[to].most))
            m.apart.curve[to].most = 0;
    return m;
}

/* Which octants are left, in the numbers of the output. */
static void write_left(tm_json *json, const remainder_list *left, unsigned base)
{
    tm_json_open(json, "left", '[');
    for (size_t i = 0; i < left->octants; i++)
        tm_json_integer(json, NULL, left->octant[i] + (int64_t)base);
    tm_json_close(json, ']');
}

static void write_json(program *p, const mesh_state *before, const mesh_state *after,
                       const tm_repair_report *report, const remainder_list *left,
                       unsigned base, double seconds)
{
#define ROW(key, member) TM_REPORT_ROW(key, NULL, NULL, mesh_state, member)
#define SCORE_ROWS                                                                       \
    ROW("bad", score.bad), ROW("forced", forced), ROW("invalid", score.invalid),         \
        ROW("held", score.off_surface), ROW("worst", score.worst),                       \
        ROW("average", score.average), ROW("elements", elements),                        \
        ROW("octants", octants)
    static const tm_report_row alone[] = {SCORE_ROWS, {0}};
    static const tm_report_row all[] = {SCORE_ROWS,
                                        ROW("corners", shape.corners),
                                        ROW("sharp_length", shape.curves),
                                        ROW("defects", shape.defects),
                                        ROW("components", shape.components),
                                        ROW("euler", shape.euler),
                                        ROW("volume", shape.volume),
                                        ROW("to_surface", apart.surface[TM_THERE].most),
                                        ROW("from_surface", apart.surface[TM_BACK].most),
                                        ROW("to_sharp", apart.curve[TM_THERE].most),
                                        ROW("from_sharp", apart.curve[TM_BACK].most),
                                        {0}};
#undef ROW
#undef SCORE_ROWS
    static const tm_report_row done[] = {
        TM_REPORT_ROW("iterations", NULL, NULL, tm_repair_report, iterations),
        TM_REPORT_ROW("tips", NULL, NULL, tm_repair_report, corners),
        TM_REPORT_ROW("divided", NULL, NULL, tm_repair_report, divided),
        {0}};
    const tm_report_row *rows = p->has_surface ? all : alone;
    tm_json *json = filter_json_begin(&p->f);
    tm_report_object(json, "before", rows, before);
    tm_report_object(json, "after", rows, after);
    tm_report_json(json, done, report);
    write_left(json, left, base);
    tm_json_double(json, "seconds", seconds);
    filter_json_end(&p->f);
}

static bool is_done(const mesh_state *m)
{
    return m->score.bad == 0 && m->score.off_surface == 0;
}

/* Finds the surface, what nodes may do, and the octree, of which nothing is said where
 * nothing is to be done. */
static void prepare(program *p, const tm_stream *stream, bool needed,
                    tm_repair_state *state, tm_repair_notes *notes)
{
    tm_error error;
    filter_stage(&p->f, "preparing");
    if (p->octants)
        p->listed = octant_list_read(&p->f, p->octants, stream, &p->repair.octants);
    p->repair.octant = p->listed;
    find_surface(p, stream);
    mpi_environment_set(&p->f);
    if (tm_repair_prepare(state, stream, p->has_surface ? &p->boundary : NULL, notes,
                          &error) != TM_OK)
        fail(p, &error);
    if (!needed || !notes->no_octree.what[0])
        return;
    if (p->repair.method == TM_REPAIR_REFINE || p->repair.octants > 0)
        fail(p, &notes->no_octree);
    filter_note(&p->f, "%s: no octant is split: %s", filter_input_name(&p->f),
                notes->no_octree.what);
}

/* Repairs the state, with the measures before and after. */
static void repair(program *p, const tm_stream *stream, tm_repair_state *state,
                   tm_repair_report *report, mesh_state *before, mesh_state *after)
{
    tm_error error;
    tm_repair_score score = tm_repair_measure(state, p->repair.threshold);
    *before = state_of(p, state, stream, &score);
    p->repair.visit = visit;
    p->repair.context = p;
    p->repair.progress = filter_progress(&p->f);
    p->repair.stop = early_end_stop();
    early_end_begin(p->time);
    if (tm_repair(state, p->has_surface ? &p->boundary : NULL, &p->repair, report,
                  &error) != TM_OK)
        fail(p, &error);
    early_end_finish();
    *after = state_of(p, state, stream, &report->after);
    if (early_end_by_signal() || (early_end_by_time() && !is_done(after)))
        filter_note(&p->f, "ended early, by %s: the mesh is the best until then",
                    early_end_by_signal() ? "a signal" : "--time");
    if (after->forced > 0)
        filter_note(&p->f,
                    "%zu elements are below the threshold because the surface is as "
                    "sharp there: they are not bad",
                    after->forced);
}

/* Repairs the mesh in the stream; returns whether nothing is left to do. */
static bool run(program *p, tm_stream *stream)
{
    tm_error error;
    tm_repair_state state;
    tm_repair_notes notes = {0};
    tm_repair_report report;
    mesh_state before, after;
    const clock_t start = clock();
    filter_stage(&p->f, "examining");
    if (tm_repair_from_stream(&state, stream, &error) != TM_OK)
        fail(p, &error);
    state.mesh.threads = p->f.threads;
    const bool needed =
        p->octants || tm_repair_is_needed(&state, stream, p->repair.threshold);
    const bool measured = p->f.json && tm_stream_find(stream, "surface.node");
    if (needed || p->trace || measured)
        prepare(p, stream, needed, &state, &notes);
    p->has_regions = notes.regions;
    repair(p, stream, &state, &report, &before, &after);
    remainder_list left = {0};
    if (!is_done(&after))
        left = find_left(p, &state);
    const bool done = is_done(&after) && !early_end_by_signal();
    if (!is_done(&after))
        note_left(p, &left, &after.score, stream->base);
    const unsigned base = stream->base;
    if (tm_repair_to_stream(&state, stream, p->has_surface ? &p->boundary : NULL, &notes,
                            &error) != TM_OK)
        filter_fail(&p->f, &error);
    if (notes.dropped[0])
        filter_leave_out(&p->f, "what refers to elements that are no more (%s)",
                         notes.dropped);
    write_json(p, &before, &after, &report, &left, base,
               (double)(clock() - start) / CLOCKS_PER_SEC);
    free(left.octant);
    filter_write(&p->f, stream, "%zu elements of %zu, bad %zu of %zu", after.elements,
                 before.elements, after.score.bad, before.score.bad);
    tm_repair_state_free(&state);
    free(p->listed);
    return done;
}

/* What ranks do together --------------------------------------------------------------
 */

static bool can_share(const program *p)
{
    return p->repair.method == TM_REPAIR_FULL && !p->f.json && !p->trace && !p->octants &&
           p->time == 0;
}

/* The surface, on all ranks; false where there is none that is good. */
static bool share_surface(program *p, const tm_slices *slices)
{
    static const char *const names[] = {"surface.node", "surface.face"};
    tm_error error;
    tm_stream stream;
    tm_stream_init(&stream);
    stream.base = slices->stream.base;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        filter_agree(&p->f, tm_slices_share(slices, names[i], &stream, &error), &error);
    p->has_surface = tm_stream_find(&stream, "surface.node") != NULL;
    const bool built = p->has_surface && build_surface(p, &stream, &error) == TM_OK;
    tm_stream_free(&stream);
    if (!tm_ranks_any(!built))
        return true;
    tm_surface_free(&p->boundary);
    return false;
}

/* Repairs what needs it; false where that is for rank 0 alone. */
static bool repair_share(program *p, tm_repair_share *share, size_t *forced)
{
    tm_error error;
    bool can = true;
    *forced = 0;
    if (!tm_repair_share_is_needed(share))
        return true;
    filter_stage(&p->f, "preparing");
    if (!share_surface(p, share->slices))
        return false;
    filter_agree(&p->f, tm_repair_share_prepare(share, &p->boundary, &can, &error),
                 &error);
    p->repair.progress = filter_progress(&p->f);
    if (can)
        filter_agree(
            &p->f,
            tm_repair_share_mend(share, &p->boundary, &p->repair, forced, &can, &error),
            &error);
    if (!can)
        tm_surface_free(&p->boundary);
    return can;
}

/* Rank 0 goes on alone; p4est starts as long as there is MPI. */
static void leave(const program *p, tm_slices *slices, tm_stream *stream)
{
    tm_error error;
    filter_agree(&p->f, tm_mpi_start(&error), &error);
    mesh_share_leave(&p->f, slices, stream);
}

/* The work of ranks together, to its end; or *stream is what rank 0 goes on with alone.
 */
static bool work_together(program *p, tm_stream *stream)
{
    tm_slices slices;
    tm_repair_share share;
    tm_error error;
    size_t forced;
    bool can;
    mesh_share_read(&p->f, &slices);
    filter_stage(&p->f, "examining");
    filter_agree(&p->f,
                 tm_repair_share_take(&share, &slices, p->repair.threshold, p->f.threads,
                                      &can, &error),
                 &error);
    can = can && repair_share(p, &share, &forced);
    const size_t elements = share.elements, bad = share.score.bad;
    tm_repair_share_free(&share);
    if (!can) {
        leave(p, &slices, stream);
        return false;
    }
    filter_write_slices(&p->f, &slices, "%zu elements of %zu, bad 0 of %zu", elements,
                        elements, bad - forced);
    tm_slices_free(&slices);
    return true;
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
              .letters = "t:i:" FILTER_LETTERS,
              .ranks = true},
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
    const bool together = filter_together(&p.f, can_share(&p));
    tm_stream_init(&stream);
    bool done = together && work_together(&p, &stream);
    if (!together)
        filter_read(&p.f, &stream);
    if (!done)
        done = run(&p, &stream);
    tm_surface_free(&p.boundary);
    tm_stream_free(&stream);
    return filter_finish(&p.f, done ? EXIT_SUCCESS : EXIT_GOAL);
}
