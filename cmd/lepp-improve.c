/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lepp-improve: tetrahedra in, better tetrahedra out. */
#include "common/app/filter.h"
#include "common/input/mesh_share.h"
#include "common/input/tet_input.h"
#include "common/input/tet_set.h"
#include "common/input/tet_share.h"
#include "common/plot/plot.h"

#include "../lib/examine/tet_statistics.h"
#include "../lib/surface/surface.h"
#include "../lib/tet/improve/improve.h"
#include "../lib/tet/improve/improve_ranks.h"
#include "../lib/tet/lepp/lepp.h"
#include "../lib/tet/mesh_set.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    OPS = FILTER_OWN,
    MAX_GROWTH,
    PATH,
    MAX_STAR,
    TOLERANCE,
    FEATURE_ANGLE,
    SET,
    UNTIL_SIZE,
    PLOT,
    WITH /* the last */
};

static const struct option options[] = {
    {"algorithm", required_argument, NULL, 'a'},
    {"factor", required_argument, NULL, 'm'},
    {"angle", required_argument, NULL, 't'},
    {"quality", required_argument, NULL, 'Q'},
    {"stop", required_argument, NULL, 's'},
    {"ops", required_argument, NULL, OPS},
    {"max-growth", required_argument, NULL, MAX_GROWTH},
    {"path", required_argument, NULL, PATH},
    {"max-star", required_argument, NULL, MAX_STAR},
    {"surface-tolerance", required_argument, NULL, TOLERANCE},
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    {"with", required_argument, NULL, WITH},
    {"set", required_argument, NULL, SET},
    {"until-size", required_argument, NULL, UNTIL_SIZE},
    {"plot", required_argument, NULL, PLOT},
    FILTER_OPTIONS};

static const char synopsis[] =
    "[-a ALGORITHM] [-t DEG] [-Q dihedral|volume] [-s original|N|converged] "
    "[--surface-tolerance [=]D] [--feature-angle DEG] [--max-growth R] [--ops LIST] "
    "[-m FACTOR] [--path simple|full|fixed] [--max-star N] [--with "
    "smooth|face-swap|both] "
    "[--set SET] [--until-size SIZE] [--plot FILE.svg] [FILE]";

static const char own_help[] =
    "  -a, --algorithm A   improve (default): all operations together; or what is done\n"
    "                      at the ends of longest-edge paths: selective, swap-centroid,\n"
    "                      centroid, wcentroid, bisection, delaunay\n"
    "  -t, --angle DEG     bad: a dihedral angle below DEG or above 180 - DEG (30)\n"
    "  -Q, --quality Q     compare tetrahedra by dihedral (default) or volume\n"
    "  -s, --stop WHEN     N: after so many passes over the bad tetrahedra; converged:\n"
    "                      when nothing is gained (default of selective; improve: when "
    "a\n"
    "                      pass gains little); original: those of the input once (the\n"
    "                      others' default)\n"
    "      --surface-tolerance D\n"
    "                      improve: how far the surface may move, and feature curves\n"
    "                      along it: a part of the diagonal of the mesh's box; =D: a\n"
    "                      length (0: it stays)\n"
    "      --feature-angle DEG\n"
    "                      with a tolerance: an edge of the surface stays an edge where\n"
    "                      the normals beside it differ by more (40; unless the surface\n"
    "                      is rough all over)\n"
    "      --max-growth R  never more than R times the input's tetrahedra\n"
    "      --ops LIST      improve: what it may do, with commas; \"list\" prints all\n"
    "  -m, --factor M      selective: change a star where that makes it so many times\n"
    "                      better, 1 or more (default 1.1)\n"
    "      --path P        simple (default): one path from each bad tetrahedron; full:\n"
    "                      all branches of it; fixed: swap-centroid changes the stars "
    "of\n"
    "                      all edges of a path; not for improve, as the rest\n"
    "      --max-star N    leave stars of more than N tetrahedra alone\n"
    "      --with SWEEP    selective: before each pass, smooth: move nodes to the mean "
    "of\n"
    "                      their neighbours; face-swap; both\n"
    "      --set SET       work on these tetrahedra, not on all bad ones (improve: on "
    "the\n"
    "                      bad ones of these): box=x0,y0,z0,x1,y1,z1; region>V, or <, "
    ">=,\n"
    "                      <=, =, and attribute_2>V; or a file of numbers, one a line.\n"
    "                      More than once: all of these together\n"
    "      --until-size H  bisection, centroid, wcentroid, delaunay: refine all\n"
    "                      tetrahedra, or those of the set, until no edge is longer "
    "than\n"
    "                      H; attribute_1: than this attribute of nodes says\n"
    "      --plot FILE.svg draw what the paths and stars were like, by gnuplot\n";

static const double default_factor = 1.1, most_factor = 100;
static const double default_angle = 30, right_angle = 90;
static const double most_tolerance = 0.1, most_feature_angle = 180;
static const double least_growth = 1e-9, most_growth = 1e9;
static const double least_size = 1e-45;

/* In the order of tm_lepp_algorithm; then the one that is none of them. */
enum { ALGORITHMS = TM_LEPP_SELECTIVE + 1, IMPROVE = ALGORITHMS };
static const char *const algorithms[] = {"bisection", "centroid",      "wcentroid",
                                         "delaunay",  "swap-centroid", "selective",
                                         "improve"};

static const char *const measures[] = {"dihedral", "volume"};
static const char *const stops[] = {"original", "converged"}; /* or a number */
static const char *const paths[] = {"simple", "full", "fixed"};
static const char *const sweeps[] = {"smooth", "face-swap", "both"};

static const filter_words option_words[] = {
    FILTER_WORDS('a', algorithms),
    FILTER_WORDS('Q', measures),
    FILTER_WORDS('s', stops),
    {OPS, tm_improve_op_name, sizeof *tm_improve_op_name, TM_IMPROVE_OPS},
    FILTER_WORDS(PATH, paths),
    FILTER_WORDS(WITH, sweeps),
    {0}};

/* What is to be done, by one of two engines. */
typedef struct {
    bool is_improve;
    bool is_length; /* the surface's tolerance is one, not a part of the diagonal */
    tm_improve_options improve;
    tm_lepp_options lepp;
    tet_set set;      /* --set; no rules: all that is bad */
    const char *plot; /* NULL: none */
} settings;

static void set_stop(const filter *f, settings *o, const char *text)
{
    const int stop = filter_find_word(f, 's', text);
    if (stop == 0) {
        o->lepp.stop = TM_LEPP_ORIGINAL;
    } else if (stop == 1) {
        o->lepp.stop = TM_LEPP_CONVERGED;
        o->improve.converge = true;
    } else {
        o->lepp.stop = TM_LEPP_PASSES;
        o->lepp.passes = (size_t)filter_integer(f, "-s", text, 1, INT32_MAX);
        o->improve.passes = o->lepp.passes;
    }
}

static unsigned find_ops(const filter *f, const char *list)
{
    unsigned ops = 0;
    char word[64];
    if (strcmp(list, "list") == 0) {
        for (int op = 0; op < TM_IMPROVE_OPS; op++)
            puts(tm_improve_op_name[op]);
        filter_exit_after_text(f);
    }
    for (;;) {
        size_t length = strcspn(list, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, list);
        ops |= 1u << filter_word(f, OPS, word);
        if (list[length] == '\0')
            return ops;
        list += length + 1;
    }
}

/* A part of the diagonal, or a length after "=". */
static void set_tolerance(const filter *f, settings *o, const char *text)
{
    o->is_length = text[0] == '=';
    o->improve.surface.tolerance =
        filter_number(f, "--surface-tolerance", text + o->is_length, 0,
                      o->is_length ? HUGE_VAL : most_tolerance);
}

static void set_size(const filter *f, settings *o, const char *text)
{
    tm_lepp_sizes *sizes = &o->lepp.sizes;
    *sizes = (tm_lepp_sizes){.attribute = tet_set_attribute(text, strlen(text))};
    if (sizes->attribute == 0)
        sizes->longest = filter_number(f, "--until-size", text, least_size, HUGE_VAL);
}

static bool has_sizes(const settings *o)
{
    return o->lepp.sizes.longest > 0 || o->lepp.sizes.attribute > 0;
}

static void set_option(filter *f, settings *o, int c)
{
    if (c == 'a') {
        int a = filter_word(f, 'a', optarg);
        o->is_improve = a == IMPROVE;
        o->lepp.algorithm = o->is_improve ? TM_LEPP_SELECTIVE : (tm_lepp_algorithm)a;
    } else if (c == 'm') {
        o->lepp.factor = filter_number(f, "-m", optarg, 1, most_factor);
    } else if (c == 't') {
        o->lepp.angle = o->improve.angle = filter_number(f, "-t", optarg, 0, right_angle);
    } else if (c == 'Q') {
        o->lepp.measure = (tm_tet_measure)filter_word(f, 'Q', optarg);
        o->improve.measure = o->lepp.measure;
    } else if (c == 's') {
        set_stop(f, o, optarg);
    } else if (c == OPS) {
        o->improve.ops = find_ops(f, optarg);
    } else if (c == MAX_GROWTH) {
        o->lepp.max_growth =
            filter_number(f, "--max-growth", optarg, least_growth, most_growth);
        o->improve.max_growth = o->lepp.max_growth;
    } else if (c == TOLERANCE) {
        set_tolerance(f, o, optarg);
    } else if (c == FEATURE_ANGLE) {
        o->improve.surface.feature_angle =
            filter_number(f, "--feature-angle", optarg, 0, most_feature_angle);
        o->improve.surface.unless_rough = false;
    } else if (c == PATH) {
        o->lepp.path = (tm_lepp_path)filter_word(f, PATH, optarg);
    } else if (c == WITH) {
        o->lepp.sweeps = 1u + (unsigned)filter_word(f, WITH, optarg);
    } else if (c == SET) {
        tet_set_add(f, &o->set, optarg);
    } else if (c == UNTIL_SIZE) {
        set_size(f, o, optarg);
    } else if (c == PLOT) {
        o->plot = optarg;
    } else if (c == MAX_STAR) {
        o->lepp.max_star = (size_t)filter_integer(f, "--max-star", optarg, 1, INT32_MAX);
    }
}

/* The same of what is about the set. */
static void check_set_options(const filter *f, const settings *o, const bool given[])
{
    const char *name = algorithms[o->is_improve ? IMPROVE : (int)o->lepp.algorithm];
    if (has_sizes(o) && (o->is_improve || o->lepp.algorithm >= TM_LEPP_SWAP_CENTROID))
        filter_usage_error(f,
                           "--until-size: %s does not make tetrahedra small: bisection, "
                           "delaunay, centroid or wcentroid would",
                           name);
    if (has_sizes(o) && given['s'])
        filter_usage_error(f, "-s and --until-size both say when to stop");
    if (o->set.rules > 0 && given[WITH])
        filter_usage_error(f, "--with sweeps over the whole mesh: not with --set");
    if (o->set.rules > 0 && o->is_improve && given[MAX_GROWTH] &&
        o->improve.max_growth < 1)
        filter_usage_error(f,
                           "--max-growth below 1 is for the whole mesh: not with --set");
    if (o->is_improve && o->plot)
        filter_usage_error(f, "--plot draws paths and stars: improve has none");
    if (o->lepp.path == TM_LEPP_FIXED &&
        (o->is_improve || o->lepp.algorithm != TM_LEPP_SWAP_CENTROID))
        filter_usage_error(f, "--path fixed is for swap-centroid: %s has no such paths",
                           name);
}

/* Refuses options that the algorithm has no use for. */
static void check_options(const filter *f, const settings *o, const bool given[])
{
    bool selective = !o->is_improve && o->lepp.algorithm == TM_LEPP_SELECTIVE;
    const char *name = algorithms[o->is_improve ? IMPROVE : (int)o->lepp.algorithm];
    if (o->is_improve && (given[PATH] || given[MAX_STAR]))
        filter_usage_error(f, "%s is for paths: %s has none",
                           given[PATH] ? "--path" : "--max-star", name);
    if (!selective && given['m'])
        filter_usage_error(f, "-m is for selective: %s does not compare so", name);
    if (!selective && given[WITH])
        filter_usage_error(f, "--with is for selective: %s has no sweeps", name);
    bool may_move = o->improve.surface.tolerance > 0;
    if (given[OPS] && o->improve.ops == 1u << TM_OP_PEELING && !may_move)
        filter_usage_error(f, "--ops peeling goes with a --surface-tolerance above 0");
    if (!o->is_improve && (may_move || given[FEATURE_ANGLE]))
        filter_usage_error(f, "%s is for improve: %s keeps the surface",
                           may_move ? "--surface-tolerance" : "--feature-angle", name);
    if (given[FEATURE_ANGLE] && !may_move)
        filter_usage_error(f, "--feature-angle goes with a --surface-tolerance above 0");
    if (!o->is_improve && given[OPS])
        filter_usage_error(f, "--ops is for improve: %s does what its name says", name);
    if (given['s'] && o->is_improve && o->lepp.stop == TM_LEPP_ORIGINAL)
        filter_usage_error(f, "improve does not stop so: -s N or -s converged");
    if (given['s'] && !o->is_improve && !selective && o->lepp.stop == TM_LEPP_CONVERGED)
        filter_usage_error(f, "%s does not converge: -s original or -s N", name);
    if (!o->is_improve && given[MAX_GROWTH] && o->lepp.max_growth < 1)
        filter_usage_error(f, "--max-growth: %s only grows: 1 or more", name);
    check_set_options(f, o, given);
}

static settings read_options(filter *f)
{
    settings o = {.is_improve = true,
                  .improve = {.angle = default_angle,
                              .measure = TM_MEASURE_DIHEDRAL,
                              .ops = TM_IMPROVE_ALL_OPS,
                              .surface = {0, TM_FEATURE_ANGLE, true}},
                  .lepp = {.algorithm = TM_LEPP_SELECTIVE,
                           .factor = default_factor,
                           .angle = default_angle,
                           .measure = TM_MEASURE_DIHEDRAL}};
    bool given[WITH + 1] = {false};
    int c;
    while ((c = filter_option(f)) != -1) {
        set_option(f, &o, c);
        given[c] = true;
    }
    check_options(f, &o, given);
    if (!given['s'])
        o.lepp.stop =
            o.lepp.algorithm == TM_LEPP_SELECTIVE ? TM_LEPP_CONVERGED : TM_LEPP_ORIGINAL;
    o.lepp.count_invalid_swaps = f->json;
    o.improve.threads = f->threads;
    o.lepp.progress = o.improve.progress = filter_progress(f);
    return o;
}

/* What --json compares; nothing where that was not asked for. */
static void measure(const filter *f, const double (*xyz)[3], size_t nodes,
                    const uint32_t (*tet)[4], size_t tets, double limit,
                    tm_tet_statistics *statistics)
{
    tm_error error;
    if (f->json)
        filter_stage(f, "measuring");
    if (f->json && tm_tet_statistics_measure(statistics, xyz, nodes, tet, tets, limit,
                                             f->threads, &error) != TM_OK)
        filter_fail(f, &error);
}

/* What was done, by the engine that did it. */
typedef struct {
    tm_improve_report improve;
    tm_lepp_report lepp;
    tm_forced forced;                /* with improve */
    tm_tet_statistics before, after; /* with --json */
    double seconds;
    size_t changes;
    size_t set_before, set_after; /* tetrahedra; with --set */
} result;

static void write_json(filter *f, const settings *o, const result *r)
{
    tm_json *json = filter_json_begin(f);
    tm_tet_statistics_object(json, "before", &r->before);
    tm_tet_statistics_object(json, "after", &r->after);
    tm_json_double(json, "seconds", r->seconds);
    if (o->is_improve) {
        tm_improve_report_json(json, &r->improve);
        tm_forced_json(json, &r->forced);
    } else {
        tm_lepp_report_json(json, &o->lepp, &r->lepp);
    }
    if (o->set.rules > 0) {
        tm_json_open(json, "set", '{');
        tm_json_integer(json, "before", (int64_t)r->set_before);
        tm_json_integer(json, "after", (int64_t)r->set_after);
        tm_json_close(json, '}');
    }
    filter_json_end(f);
}

static double cpu_seconds(void)
{
    struct timespec now;
    const double nanosecond = 1e-9;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + nanosecond * (double)now.tv_nsec;
}

/* The length that the tolerance is, in a mesh of that size. */
static double tolerance_of(const settings *o, const tm_tet_mesh *mesh)
{
    double low[3], high[3], diagonal2 = 0;
    for (int x = 0; x < 3; x++) {
        low[x] = HUGE_VAL;
        high[x] = -HUGE_VAL;
        for (size_t v = 0; v < mesh->nodes; v++) {
            low[x] = fmin(low[x], mesh->xyz[v][x]);
            high[x] = fmax(high[x], mesh->xyz[v][x]);
        }
        diagonal2 += (high[x] - low[x]) * (high[x] - low[x]);
    }
    double part = o->improve.surface.tolerance;
    return o->is_length || mesh->nodes == 0 ? part : part * sqrt(diagonal2);
}

/* The mesh of the stream, with the set that is asked for. */
static void take_mesh(const filter *f, tm_stream *stream, const settings *o, result *r,
                      tm_tet_mesh *mesh)
{
    tm_error error;
    bool *in_set = tet_set_find(f, &o->set, stream);
    if (o->lepp.sizes.attribute > 0)
        tet_set_check_sizes(f, stream, o->lepp.sizes.attribute, in_set);
    tet_mesh_from_stream(f, stream, mesh);
    if (!in_set)
        return;
    if (tm_tet_mesh_add_set(mesh, in_set, &error) != TM_OK)
        filter_fail(f, &error);
    free(in_set);
    r->set_before = tm_tet_mesh_count_set(mesh);
    if (r->set_before == 0)
        filter_note(f, "no tetrahedron is in the set");
}

/* Improves the stream's mesh in place. */
static void improve(filter *f, tm_stream *stream, settings *o, result *r)
{
    tm_error error;
    tm_tet_mesh mesh;
    take_mesh(f, stream, o, r, &mesh);
    measure(f, (const double(*)[3])mesh.xyz, mesh.nodes, (const uint32_t(*)[4])mesh.tet,
            mesh.slots, o->improve.angle, &r->before);
    o->improve.surface.tolerance = tolerance_of(o, &mesh);
    r->seconds = -cpu_seconds();
    tm_status status = o->is_improve ? tm_improve(&mesh, &o->improve, &r->improve, &error)
                                     : tm_lepp_improve(&mesh, &o->lepp, &r->lepp, &error);
    if (status != TM_OK)
        filter_fail(f, &error);
    r->seconds += cpu_seconds();
    if (o->is_improve &&
        tm_forced_find(&r->forced, &mesh, o->improve.angle, &error) != TM_OK)
        filter_fail(f, &error);
    r->changes =
        o->is_improve ? tm_improve_operations(&r->improve) : tm_lepp_changes(&r->lepp);
    r->set_after = mesh.has_set ? tm_tet_mesh_count_set(&mesh) : 0;
    tm_tet_mesh_remove_set(&mesh);
    for (size_t b = 0; b < stream->blocks; b++)
        if (tm_tet_mesh_invalidates(&mesh, &stream->block[b]))
            filter_note(f, "%s is dropped: nodes have other numbers now",
                        stream->block[b].name);
    if (tm_tet_mesh_to_stream(&mesh, stream, &error) != TM_OK)
        filter_fail(f, &error);
}

/* Text at the end of a string that is `size` bytes long. */
static void add(char *text, size_t size, const char *format, size_t count)
{
    size_t length = strlen(text);
    snprintf(text + length, size - length, format, count);
}

static void add_effects(const tm_improve_report *r, char *text, size_t size)
{
    static const char *const words[TM_IMPROVE_EFFECTS] = {"%zu edges and ",
                                                          "%zu faces removed, ",
                                                          "%zu times a node moved, ",
                                                          "%zu points inserted, ",
                                                          "%zu nodes removed",
                                                          ", %zu cavities filled anew",
                                                          ", %zu tetrahedra peeled off"};
    for (int k = 0; k < TM_IMPROVE_EFFECTS; k++)
        if (k <= TM_EFFECT_NODES_REMOVED ||
            tm_improve_effects(r, (tm_improve_effect)k) > 0)
            add(text, size, words[k], tm_improve_effects(r, (tm_improve_effect)k));
}

/* What no operation could help against. */
static void add_forced(const tm_forced *forced, char *text, size_t size)
{
    if (forced->bad == 0)
        return;
    add(text, size, "; %zu bad left, ", forced->bad);
    add(text, size, "%zu forced by the surface", forced->tets);
}

static void add_star_operations(const settings *o, const tm_lepp_report *r, char *text,
                                size_t size)
{
    add(text, size, "%zu edges removed, ", r->swaps);
    add(text, size, "%zu points inserted", tm_lepp_operations(r) - r->swaps);
    if (o->lepp.sweeps & TM_SWEEP_SMOOTH)
        add(text, size, ", %zu times a node moved", tm_lepp_swept(&r->smooth));
    if (o->lepp.sweeps & TM_SWEEP_SWAP)
        add(text, size, ", %zu faces swapped", tm_lepp_swept(&r->swap));
}

/* One line about the run. */
static void summarise(const settings *o, const result *r, size_t tets, char *text,
                      size_t size)
{
    bool is_improve = o->is_improve;
    size_t tets_before = is_improve ? r->improve.tets_before : r->lepp.tets_before;
    size_t bad_before = is_improve ? r->improve.bad_before : r->lepp.bad_before;
    size_t bad_after = is_improve ? r->improve.bad_after : r->lepp.bad_after;
    double before = tm_percent(bad_before, tets_before);
    if (r->changes == 0)
        snprintf(text, size, "%s: %zu tetrahedra, %.2f%% bad",
                 has_sizes(o)     ? "nothing to refine"
                 : bad_before > 0 ? "nothing found that helps"
                                  : "nothing to improve",
                 tets, before);
    else
        snprintf(text, size, "%zu -> %zu tetrahedra, %.2f%% -> %.2f%% bad; ", tets_before,
                 tets, before, tm_percent(bad_after, tets));
    if (r->changes > 0 && is_improve)
        add_effects(&r->improve, text, size);
    else if (r->changes > 0)
        add_star_operations(o, &r->lepp, text, size);
    if (is_improve)
        add_forced(&r->forced, text, size);
    if (r->changes > 0 && o->set.rules > 0) {
        add(text, size, "; set: %zu", r->set_before);
        add(text, size, " -> %zu tetrahedra", r->set_after);
    }
}

/* What -a delaunay promises, and where it cannot. */
static void note_delaunay(const filter *f, const tm_lepp_report *r)
{
    if (r->not_delaunay_before > 0)
        filter_note(f,
                    "the mesh is not Delaunay: a node is inside of a sphere at %zu faces",
                    r->not_delaunay_before);
    if (r->delaunay.stopped > 0)
        filter_note(f,
                    "%zu faces that stay kept a point from tetrahedra beyond, whose "
                    "spheres hold it",
                    r->delaunay.stopped);
    if (r->delaunay.refused > 0)
        filter_note(f,
                    "%zu terminal edges are left: their midpoints do not see all "
                    "tetrahedra whose spheres hold them",
                    r->delaunay.refused);
    if (r->delaunay.cut_back > 0)
        filter_note(
            f,
            "%zu points do not see, or may not take, all tetrahedra whose spheres "
            "hold them",
            r->delaunay.cut_back);
    if (r->not_delaunay_after > 0)
        filter_note(
            f, "the result is not Delaunay: a node is inside of a sphere at %zu faces",
            r->not_delaunay_after);
    if (r->abandoned > 0)
        filter_note(f, "%zu bad tetrahedra are left: their paths did not end",
                    r->abandoned);
}

/* Where --until-size could not be reached. */
static void note_larger(const filter *f, const settings *o, const result *r)
{
    const bool is_full = r->lepp.no_room > 0;
    if (r->lepp.larger_after > 0)
        filter_note(f, "%zu tetrahedra%s are still larger than --until-size says%s",
                    r->lepp.larger_after, o->set.rules > 0 ? " of the set" : "",
                    is_full ? ": --max-growth is reached" : "");
}

static void write_plot(const filter *f, const settings *o, const result *r)
{
    tm_text script = {0};
    lepp_plot_script(&script, &r->lepp);
    plot_write(f, &script, o->plot);
}

/* Whether ranks can do it together: what improve() may do in parts. */
static bool is_for_ranks(const settings *o)
{
    return o->is_improve && o->set.rules == 0 &&
           tm_improve_cuts(&o->improve, TM_TETS_MAX, TM_TETS_MAX);
}

/* measure() of slices. */
static void measure_slices(const filter *f, const tm_slices *slices, double limit,
                           tm_tet_statistics *statistics)
{
    tm_error error;
    size_t turned;
    const tm_element_slices mesh = mesh_share_tets(slices);
    if (!f->json)
        return;
    filter_stage(f, "measuring");
    filter_agree(
        f, tm_tet_statistics_ranks(statistics, &turned, &mesh, limit, f->threads, &error),
        &error);
}

/* The processor time of all ranks. */
static double seconds_of_all(void)
{
    const double million = 1e6;
    size_t microseconds = (size_t)(million * cpu_seconds());
    tm_ranks_sum(&microseconds, 1);
    return (double)microseconds / million;
}

/* Improves the mesh that ranks share; false, with nothing done, where that is better done
 * by one. */
static bool improve_share(filter *f, const settings *o, tm_slices *slices, result *r)
{
    const tm_improve_cut *cut = &tm_improve_usual_cut;
    const tm_improve_options *how = &o->improve;
    tm_tet_share share;
    tm_share_notes notes;
    tm_error error;
    size_t inner_faces;
    measure_slices(f, slices, how->angle, &r->before);
    if (!tet_share_from_slices(f, slices, cut->size, &share, &notes))
        return false;
    bool alone = !tm_improve_cuts(how, share.all_tets,
                                  tm_improve_ranks_count_bad(&share, how->angle));
    if (!alone) {
        r->seconds = -seconds_of_all();
        filter_agree(f,
                     tm_improve_ranks(&share, how, cut, f->json, &r->improve, &alone,
                                      &inner_faces, &error),
                     &error);
        r->seconds += seconds_of_all();
    }
    if (alone) {
        tm_tet_share_free(&share);
        return false;
    }
    tet_share_note(f, &notes);
    filter_agree(f, tm_improve_ranks_forced(&share, how->angle, &r->forced, &error),
                 &error);
    r->changes = tm_improve_operations(&r->improve);
    filter_agree(f, tm_tet_share_give(&share, inner_faces, slices, &error), &error);
    measure_slices(f, slices, how->angle, &r->after);
    return true;
}

/* The work of ranks together, to its end; or *stream is what rank 0 goes on with alone.
 */
static bool work_together(filter *f, const settings *o, tm_stream *stream, int *status)
{
    tm_slices slices;
    tm_slice tets = {0, 0};
    result r = {0};
    char summary[512];
    filter_read_slices(f, &slices);
    tm_slices_find(&slices, ".ele", &tets);
    if (!tm_improve_cuts(&o->improve, tets.total, tets.total) ||
        !improve_share(f, o, &slices, &r)) {
        mesh_share_leave(f, &slices, stream);
        return false;
    }
    if (r.changes > 0)
        tet_share_drop_unknown(f, &slices, "the tetrahedra have other numbers now");
    tm_slices_find(&slices, ".ele", &tets);
    summarise(o, &r, tets.total, summary, sizeof summary);
    filter_note(f, "%s", summary);
    if (f->json)
        write_json(f, o, &r);
    filter_write_slices(f, &slices, "%s", summary);
    tm_forced_free(&r.forced);
    tm_slices_free(&slices);
    *status = filter_finish(f, EXIT_SUCCESS);
    return true;
}

int main(int argc, char **argv)
{
    filter f = {.name = "lepp-improve",
                .synopsis = synopsis,
                .purpose =
                    "Improves tetrahedra; the boundary stays where it is, or near.",
                .help = own_help,
                .options = options,
                .words = option_words,
                .letters = "a:m:t:Q:s:" FILTER_LETTERS,
                .ranks = true};
    filter_start(&f, argc, argv);
    settings o = read_options(&f);
    filter_operands(&f);
    plot_check_file(&f, o.plot);
    tm_stream stream;
    int status;
    if (!filter_together(&f, is_for_ranks(&o)))
        filter_read(&f, &stream);
    else if (work_together(&f, &o, &stream, &status))
        return status;

    result r = {0};
    improve(&f, &stream, &o, &r);
    if (r.changes > 0)
        drop_unknown_blocks(&f, &stream, "the tetrahedra have other numbers now");

    const tm_block *node = tm_stream_find(&stream, ".node");
    const tm_block *ele = tm_stream_find(&stream, ".ele");
    size_t nodes = node ? node->count : 0, tets = ele ? ele->count : 0;
    measure(&f, node ? (const double(*)[3])node->real : NULL, nodes,
            ele ? (const uint32_t(*)[4])ele->integer : NULL, tets, o.improve.angle,
            &r.after);
    char summary[512];
    summarise(&o, &r, tets, summary, sizeof summary);
    if (!o.is_improve && o.lepp.algorithm == TM_LEPP_DELAUNAY)
        note_delaunay(&f, &r.lepp);
    bool too_large = o.is_improve && r.improve.too_large;
    note_larger(&f, &o, &r);
    if (too_large)
        filter_note(&f, "the mesh could not be made as small as --max-growth says");
    filter_note(&f, "%s", summary);
    if (f.json)
        write_json(&f, &o, &r);
    if (o.plot)
        write_plot(&f, &o, &r);
    filter_write(&f, &stream, "%s", summary);
    tm_forced_free(&r.forced);
    tm_stream_free(&stream);
    tet_set_free(&o.set);
    return filter_finish(&f,
                         too_large || r.lepp.larger_after > 0 ? EXIT_GOAL : EXIT_SUCCESS);
}
