/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "improve_settings.h"

#include "../../../lib/surface/surface.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

const struct option improve_options[] = {
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

const char improve_letters[] = "a:m:t:Q:s:" FILTER_LETTERS;

const char improve_synopsis[] =
    "[-a ALGORITHM] [-t DEG] [-Q dihedral|volume] [-s original|N|converged] "
    "[--surface-tolerance [=]D] [--feature-angle DEG] [--max-growth R] [--ops LIST] "
    "[-m FACTOR] [--path simple|full|fixed] [--max-star N] [--with "
    "smooth|face-swap|both] "
    "[--set SET] [--until-size SIZE] [--plot FILE.svg] [FILE]";

const char improve_help[] =
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

const filter_words improve_words[] = {
    FILTER_WORDS('a', algorithms),
    FILTER_WORDS('Q', measures),
    FILTER_WORDS('s', stops),
    {OPS, tm_improve_op_name, sizeof *tm_improve_op_name, TM_IMPROVE_OPS},
    FILTER_WORDS(PATH, paths),
    FILTER_WORDS(WITH, sweeps),
    {0}};

static void set_stop(const filter *f, improve_settings *o, const char *text)
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
static void set_tolerance(const filter *f, improve_settings *o, const char *text)
{
    o->is_length = text[0] == '=';
    o->improve.surface.tolerance =
        filter_number(f, "--surface-tolerance", text + o->is_length, 0,
                      o->is_length ? HUGE_VAL : most_tolerance);
}

static void set_size(const filter *f, improve_settings *o, const char *text)
{
    tm_lepp_sizes *sizes = &o->lepp.sizes;
    *sizes = (tm_lepp_sizes){.attribute = tet_set_attribute(text, strlen(text))};
    if (sizes->attribute == 0)
        sizes->longest = filter_number(f, "--until-size", text, least_size, HUGE_VAL);
}

bool improve_has_sizes(const improve_settings *o)
{
    return o->lepp.sizes.longest > 0 || o->lepp.sizes.attribute > 0;
}

static void set_option(filter *f, improve_settings *o, int c)
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
static void check_set_options(const filter *f, const improve_settings *o,
                              const bool given[])
{
    const char *name = algorithms[o->is_improve ? IMPROVE : (int)o->lepp.algorithm];
    if (improve_has_sizes(o) &&
        (o->is_improve || o->lepp.algorithm >= TM_LEPP_SWAP_CENTROID))
        filter_usage_error(f,
                           "--until-size: %s does not make tetrahedra small: bisection, "
                           "delaunay, centroid or wcentroid would",
                           name);
    if (improve_has_sizes(o) && given['s'])
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
static void check_options(const filter *f, const improve_settings *o, const bool given[])
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

improve_settings improve_settings_read(filter *f)
{
    improve_settings o = {.is_improve = true,
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
