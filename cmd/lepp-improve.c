/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lepp-improve: tetrahedra in, better tetrahedra out. */
#include "common/app/filter.h"
#include "common/input/tet_input.h"

#include "../lib/examine/tet_statistics.h"
#include "../lib/tet/improve/improve.h"
#include "../lib/tet/lepp/lepp.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { OPS = FILTER_OWN, MAX_GROWTH, PATH, MAX_STAR, WITH };

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
    {"with", required_argument, NULL, WITH},
    FILTER_OPTIONS};

static const char synopsis[] =
    "[-a ALGORITHM] [-t DEG] [-Q dihedral|volume] [-s original|N|converged] "
    "[--max-growth R] [--ops LIST] [-m FACTOR] [--path simple|full] [--max-star N] "
    "[--with smooth|face-swap|both] [FILE]";

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
    "      --max-growth R  never more than R times the input's tetrahedra\n"
    "      --ops LIST      improve: what it may do, with commas; \"list\" prints all\n"
    "  -m, --factor M      selective: change a star where that makes it so many times\n"
    "                      better, 1 or more (default 1.1)\n"
    "      --path P        simple (default): one path from each bad tetrahedron; full:\n"
    "                      all branches of it; not for improve, as the rest\n"
    "      --max-star N    leave stars of more than N tetrahedra alone\n"
    "      --with SWEEP    selective: before each pass, smooth: move nodes to the mean "
    "of\n"
    "                      their neighbours; face-swap; both\n";

static const double default_factor = 1.1, most_factor = 100;
static const double default_angle = 30, right_angle = 90;
static const double least_growth = 1e-9, most_growth = 1e9;

/* In the order of tm_lepp_algorithm; then the one that is none of them. */
enum { ALGORITHMS = TM_LEPP_SELECTIVE + 1, IMPROVE = ALGORITHMS };
static const char *const algorithms[] = {"bisection", "centroid",      "wcentroid",
                                         "delaunay",  "swap-centroid", "selective",
                                         "improve"};

static const char *const measures[] = {"dihedral", "volume"};
static const char *const stops[] = {"original", "converged"}; /* or a number */
static const char *const paths[] = {"simple", "full"};
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
    tm_improve_options improve;
    tm_lepp_options lepp;
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
    } else if (c == PATH) {
        o->lepp.path = (tm_lepp_path)filter_word(f, PATH, optarg);
    } else if (c == WITH) {
        o->lepp.sweeps = 1u + (unsigned)filter_word(f, WITH, optarg);
    } else if (c == MAX_STAR) {
        o->lepp.max_star = (size_t)filter_integer(f, "--max-star", optarg, 1, INT32_MAX);
    }
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
    if (!o->is_improve && given[OPS])
        filter_usage_error(f, "--ops is for improve: %s does what its name says", name);
    if (given['s'] && o->is_improve && o->lepp.stop == TM_LEPP_ORIGINAL)
        filter_usage_error(f, "improve does not stop so: -s N or -s converged");
    if (given['s'] && !o->is_improve && !selective && o->lepp.stop == TM_LEPP_CONVERGED)
        filter_usage_error(f, "%s does not converge: -s original or -s N", name);
    if (!o->is_improve && given[MAX_GROWTH] && o->lepp.max_growth < 1)
        filter_usage_error(f, "--max-growth: %s only grows: 1 or more", name);
}

static settings read_options(filter *f)
{
    settings o = {.is_improve = true,
                  .improve = {.angle = default_angle,
                              .measure = TM_MEASURE_DIHEDRAL,
                              .ops = TM_IMPROVE_ALL_OPS},
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
    tm_tet_statistics before, after; /* with --json */
    double seconds;
    size_t changes;
} result;

static void write_json(filter *f, const settings *o, const result *r)
{
    tm_json *json = filter_json_begin(f);
    tm_tet_statistics_object(json, "before", &r->before);
    tm_tet_statistics_object(json, "after", &r->after);
    tm_json_double(json, "seconds", r->seconds);
    if (o->is_improve)
        tm_improve_report_json(json, &r->improve);
    else
        tm_lepp_report_json(json, &o->lepp, &r->lepp);
    filter_json_end(f);
}

static double cpu_seconds(void)
{
    struct timespec now;
    const double nanosecond = 1e-9;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + nanosecond * (double)now.tv_nsec;
}

/* Improves the stream's mesh in place. */
static void improve(filter *f, tm_stream *stream, const settings *o, result *r)
{
    tm_error error;
    tm_tet_mesh mesh;
    tet_mesh_from_stream(f, stream, &mesh);
    measure(f, (const double(*)[3])mesh.xyz, mesh.nodes, (const uint32_t(*)[4])mesh.tet,
            mesh.slots, o->improve.angle, &r->before);
    r->seconds = -cpu_seconds();
    tm_status status = o->is_improve ? tm_improve(&mesh, &o->improve, &r->improve, &error)
                                     : tm_lepp_improve(&mesh, &o->lepp, &r->lepp, &error);
    if (status != TM_OK)
        filter_fail(f, &error);
    r->seconds += cpu_seconds();
    r->changes =
        o->is_improve ? tm_improve_operations(&r->improve) : tm_lepp_changes(&r->lepp);
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
    static const char *const words[TM_IMPROVE_EFFECTS] = {
        "%zu edges and ", "%zu faces removed, ", "%zu times a node moved, ",
        "%zu points inserted, ", "%zu nodes removed"};
    for (int k = 0; k < TM_IMPROVE_EFFECTS; k++)
        add(text, size, words[k], tm_improve_effects(r, (tm_improve_effect)k));
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
    if (r->changes == 0) {
        snprintf(text, size, "%s: %zu tetrahedra, %.2f%% bad",
                 bad_before > 0 ? "nothing found that helps" : "nothing to improve", tets,
                 before);
        return;
    }
    snprintf(text, size, "%zu -> %zu tetrahedra, %.2f%% -> %.2f%% bad; ", tets_before,
             tets, before, tm_percent(bad_after, tets));
    if (is_improve)
        add_effects(&r->improve, text, size);
    else
        add_star_operations(o, &r->lepp, text, size);
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

int main(int argc, char **argv)
{
    filter f = {.name = "lepp-improve",
                .synopsis = synopsis,
                .purpose = "Improves tetrahedra; the boundary stays where it is.",
                .help = own_help,
                .options = options,
                .words = option_words,
                .letters = "a:m:t:Q:s:" FILTER_LETTERS};
    filter_start(&f, argc, argv);
    settings o = read_options(&f);
    filter_operands(&f);
    tm_stream stream;
    filter_read(&f, &stream);

    result r;
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
    if (too_large)
        filter_note(&f, "the mesh could not be made as small as --max-growth says");
    filter_note(&f, "%s", summary);
    if (f.json)
        write_json(&f, &o, &r);
    filter_write(&f, &stream, "%s", summary);
    tm_stream_free(&stream);
    return filter_finish(&f, too_large ? EXIT_GOAL : EXIT_SUCCESS);
}
