/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_settings.h"

#include <float.h>
#include <string.h>

enum {
    MODE = FILTER_OWN,
    FACE_METRIC,
    CELLS,
    SIZE,
    PARTITION,
    LEVELS,
    NO_REPAIR,
    STAR,
    ABSORB,
    MAX_TETS,
    NO_SWALLOW,
    MERGE_COPLANAR,
    IGNORE_MARKERS,
    LABEL
};

const struct option poly_options[] = {
    {"mode", required_argument, NULL, MODE},
    {"face-metric", required_argument, NULL, FACE_METRIC},
    {"cells", required_argument, NULL, CELLS},
    {"size", required_argument, NULL, SIZE},
    {"partition", optional_argument, NULL, PARTITION},
    {"levels", required_argument, NULL, LEVELS},
    {"no-repair", no_argument, NULL, NO_REPAIR},
    {"star", optional_argument, NULL, STAR},
    {"absorb", no_argument, NULL, ABSORB},
    {"max-tets", required_argument, NULL, MAX_TETS},
    {"no-swallow", no_argument, NULL, NO_SWALLOW},
    {"merge-coplanar", optional_argument, NULL, MERGE_COPLANAR},
    {"ignore-markers", no_argument, NULL, IGNORE_MARKERS},
    {"label", no_argument, NULL, LABEL},
    FILTER_OPTIONS};

const char poly_options_help[] =
    "      --mode MODE     how tetrahedra are joined: terminal (default), one "
    "polyhedron\n"
    "                      for each terminal edge; edge, by their longest edge; face,\n"
    "                      across their best face; terminal-face, the same with\n"
    "                      what comes near again; cavity, by their circumcentres;\n"
    "                      compact, to round cells of even size\n"
    "      --face-metric M the best face of these: area (default) or inradius\n"
    "      --cells N       compact: about N of them\n"
    "      --size H        compact: about as large as cubes of side H\n"
    "      --partition[=K] those with one value of attribute K, from 1; the last one\n"
    "      --star[=R]      each star-shaped with respect to a ball, of R times its\n"
    "                      extent; or =centroid: seen from there, for finite volumes\n"
    "      --absorb        those of a few tetrahedra join others beside them\n"
    "      --max-tets N    of N tetrahedra at most\n"
    "      --no-swallow    no node inside of a polyhedron\n"
    "      --no-repair     leave what is no ball as it is\n"
    "      --merge-coplanar[=DEG]  join faces between the same polyhedra that are in "
    "one\n"
    "                      plane, or whose normals differ by DEG at most\n"
    "      --levels N      N coarser levels, each of an eighth of the polyhedra or so\n"
    "      --ignore-markers  join across marked faces inside\n"
    "      --label         write the tetrahedra, with their polyhedron as attribute\n";

static const double most_degrees = 30;

static const char *const metrics[] = {"area", "inradius"};

const filter_words poly_option_words[] = {
    {MODE, &tm_poly_modes[0].name, sizeof tm_poly_modes[0], TM_POLY_MODES},
    FILTER_WORDS(FACE_METRIC, metrics),
    {0}};

/* A ball in another one has half of its diameter as its radius at most. */
static const double most_radius = 0.5;

static void set_star(filter *f, tm_poly_options *p)
{
    p->star = TM_STAR_BALL;
    if (optarg && strcmp(optarg, "centroid") == 0) {
        p->star = TM_STAR_CENTROID;
    } else if (optarg) {
        p->star = TM_STAR_RADIUS;
        p->radius = filter_number(f, "--star", optarg, 0, most_radius);
    }
}

enum { most_levels = 30 }; /* of a half each there would be 2^30 */

/* Whether an option is for polyhedra, too. */
static bool is_for_polyhedra(int c)
{
    return c == CELLS || c == SIZE || c == MODE || c == NO_REPAIR || c == STAR ||
           c == LEVELS || c == IGNORE_MARKERS;
}

static void set_option(filter *f, poly_settings *o, int c)
{
    tm_poly_options *p = &o->poly;
    if (c == MODE)
        p->mode = (tm_poly_mode)filter_word(f, MODE, optarg);
    else if (c == FACE_METRIC)
        p->face_metric = (tm_face_metric)filter_word(f, FACE_METRIC, optarg);
    else if (c == CELLS)
        p->cells = (size_t)filter_integer(f, "--cells", optarg, 1, INT32_MAX);
    else if (c == SIZE)
        p->size = filter_number(f, "--size", optarg, DBL_MIN, DBL_MAX);
    else if (c == LEVELS)
        o->levels = (size_t)filter_integer(f, "--levels", optarg, 1, most_levels);
    else if (c == PARTITION) {
        o->partition = true;
        if (optarg)
            o->attribute = (size_t)filter_integer(f, "--partition", optarg, 1, INT32_MAX);
    } else if (c == NO_REPAIR)
        p->repair = false;
    else if (c == STAR)
        set_star(f, p);
    else if (c == ABSORB)
        p->absorb = true;
    else if (c == NO_SWALLOW)
        p->no_swallow = true;
    else if (c == MAX_TETS)
        p->max_tets = (size_t)filter_integer(f, "--max-tets", optarg, 1, INT32_MAX);
    else if (c == IGNORE_MARKERS)
        o->ignore_markers = true;
    else if (c == LABEL)
        o->label = true;
    else if (c == MERGE_COPLANAR) {
        o->merge = true;
        if (optarg)
            o->degrees = filter_number(f, "--merge-coplanar", optarg, 0, most_degrees);
    }
}

poly_settings poly_settings_read(filter *f)
{
    poly_settings o = {.poly = {.repair = true}};
    bool has_metric = false, has_mode = false;
    int c;
    while ((c = filter_option(f)) != -1) {
        set_option(f, &o, c);
        o.any |= c != LEVELS;
        o.for_tets |= !is_for_polyhedra(c);
        has_metric |= c == FACE_METRIC;
        has_mode |= c == MODE;
    }
    tm_poly_options *p = &o.poly;
    const bool is_sized = p->cells > 0 || p->size > 0;
    if (is_sized && !has_mode)
        p->mode = TM_POLY_COMPACT;
    if (o.partition && (has_mode || is_sized || has_metric || !p->repair))
        filter_usage_error(f, "--partition says which tetrahedra are joined, and is for "
                              "the repair: not with --mode, --cells, --size and "
                              "--no-repair");
    if (is_sized != (p->mode == TM_POLY_COMPACT) || (p->cells > 0 && p->size > 0))
        filter_usage_error(f, "--mode compact needs one of --cells and --size, which are "
                              "for it alone");
    if (has_metric && p->mode != TM_POLY_FACE && p->mode != TM_POLY_TERMINAL_FACE)
        filter_usage_error(f, "--face-metric is for the modes face and terminal-face");
    if (!p->repair && (p->star || p->absorb || p->no_swallow || p->max_tets || o.merge))
        filter_usage_error(f, "--star, --absorb, --no-swallow, --max-tets and "
                              "--merge-coplanar are of the repair: not with --no-repair");
    if (o.label && o.levels > 0)
        filter_usage_error(f, "--levels is of polyhedra: --label writes none");
    o.for_tets |= (has_mode && p->mode != TM_POLY_COMPACT) || p->star == TM_STAR_CENTROID;
    o.poly.progress = filter_progress(f);
    o.poly.threads = f->threads;
    if (o.label && o.merge)
        filter_usage_error(f, "--merge-coplanar is for faces: --label writes none");
    return o;
}
