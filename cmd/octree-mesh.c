/* SPDX-License-Identifier: GPL-3.0-or-later */
/* octree-mesh: a closed surface in, hexahedra, wedges, pyramids and tetrahedra out. */
#include "common/app/filter.h"
#include "common/input/octree_rules.h"
#include "common/input/surface_input.h"
#include "common/octree/octree_notes.h"
#include "common/process/mpi_environment.h"

#include "../lib/octree/forest/octree_estimate.h"
#include "../lib/octree/layer/octree_mesh_stream.h"
#include "../lib/octree/layer/mesh_choice.h"
#include "../lib/octree/layer/octree_mesh_ranks.h"
#include "../lib/element/jens.h"
#include "../lib/poly/octant/join_octants.h"
#include "../lib/ranks/ranks.h"
#include "../lib/surface/measure/surface_curvature.h"

#include <math.h>
#include <stdlib.h>

enum {
    FEATURE_ANGLE = FILTER_OWN,
    RESOLVE,
    LENIENT,
    CAVITIES,
    CURVATURE,
    SIZE,
    INNER_SIZE,
    MOST,
    POLYHEDRA
};

static const struct option options[] = {
    {"all", required_argument, NULL, 'a'},
    {"surface", required_argument, NULL, 's'},
    {"boxes", required_argument, NULL, 'b'},
    {"region", required_argument, NULL, 'r'},
    {"leaves", required_argument, NULL, 'l'},
    {"levels", no_argument, NULL, 'u'},
    {"size", required_argument, NULL, SIZE},
    {"inner-size", required_argument, NULL, INNER_SIZE},
    {"curvature", required_argument, NULL, CURVATURE},
    {"most", required_argument, NULL, MOST},
    {"feature-angle", required_argument, NULL, FEATURE_ANGLE},
    {"resolve", required_argument, NULL, RESOLVE},
    {"cavities", no_argument, NULL, CAVITIES},
    {"polyhedra", no_argument, NULL, POLYHEDRA},
    {"lenient", no_argument, NULL, LENIENT},
    FILTER_OPTIONS};

static const char synopsis[] =
    "[-a L] [-s L] [--size H] [--inner-size H] [--curvature DEG] [-b FILE.reg] [-r "
    "SURFACE L] [-l FILE] "
    "[-u] [--most N] [--feature-angle DEG] [--resolve N] [--cavities] "
    "[--polyhedra] [--lenient] [SURFACE]";

static const char own_help[] =
    "  -a, --all L         octants of level L everywhere\n"
    "  -s, --surface L     of level L where the surface is (default 5, if no other "
    "rule\n"
    "                      is given)\n"
    "      --size H        of side H where the surface is, in its unit of length\n"
    "      --inner-size H  of side H or less everywhere\n"
    "      --curvature DEG where the surface is flatter, larger ones: across one it "
    "turns by\n"
    "                      no more than this\n"
    "  -b, --boxes FILE    of the levels of the boxes in FILE (.reg)\n"
    "  -r, --region S L    of level L on and in the closed surface in file S\n"
    "  -l, --leaves FILE   split the octants whose numbers are in FILE once more\n"
    "  -u, --levels        elements have the level of their octant as attribute\n"
    "      --feature-angle DEG\n"
    "                      an edge is kept where it is sharper (default 40, and none "
    "of\n"
    "                      a body that is rough all over)\n"
    "      --most N        refuse what would be more than about N elements (default\n"
    "                      50000000)\n"
    "      --resolve N     up to N levels more where a thin part or a gap of the "
    "surface\n"
    "                      would be lost (default 1); where it is given, also "
    "where\n"
    "                      the surface is closer to itself than two octants\n"
    "      --cavities      a surface inside of another one bounds a hole, not a region\n"
    "      --polyhedra     one polyhedron for each octant, with several facets where "
    "smaller\n"
    "                      ones are beside it, as polylla3d makes them\n"
    "      --lenient       take surfaces that are open or cross themselves\n";

static const double default_angle = TM_FEATURE_ANGLE, straight_angle = 180;
static const double pi = 3.14159265358979323846;

typedef struct {
    octree_rules rules;
    tm_surface_options surface;
    tm_mesh_plan plan;
    double most;      /* elements */
    double curvature; /* degrees; 0: not asked */
    bool levels, polyhedra;
} settings;

/* A rule with a size: of the surface, or of everything. */
static void add_size(const filter *f, settings *o, const char *option,
                     tm_octree_rule_kind kind)
{
    const double least = 1e-45, most = 1e45;
    tm_error error;
    const tm_octree_rule rule = {.kind = kind,
                                 .size = filter_number(f, option, optarg, least, most)};
    if (tm_octree_rules_add(&o->rules.rules, &rule, &error) != TM_OK)
        filter_fail(f, &error);
}

static settings read_options(filter *f)
{
    const double most_default = 5e7, most_ids = 4e9, least_turn = 0.1, most_turn = 90;
    settings o = {.surface = {.feature_angle = default_angle,
                              .unless_rough = true,
                              .regions = true},
                  .plan.levels = 1,
                  .most = most_default};
    const unsigned default_level = 5;
    int c;
    while ((c = filter_option(f)) != -1) {
        if (c == 'u')
            o.levels = true;
        else if (c == FEATURE_ANGLE) {
            o.surface.feature_angle =
                filter_number(f, "--feature-angle", optarg, 0, straight_angle);
            o.surface.unless_rough = false;
        } else if (c == RESOLVE) {
            o.plan.levels =
                (unsigned)filter_integer(f, "--resolve", optarg, 0, TM_OCTREE_LEVEL_MAX);
            o.plan.deeper = true;
        } else if (c == CAVITIES)
            o.surface.regions = false;
        else if (c == POLYHEDRA)
            o.polyhedra = true;
        else if (c == LENIENT)
            o.surface.lenient = true;
        else if (c == SIZE)
            add_size(f, &o, "--size", TM_RULE_SURFACE);
        else if (c == INNER_SIZE)
            add_size(f, &o, "--inner-size", TM_RULE_EVERYTHING);
        else if (c == CURVATURE)
            o.curvature = filter_number(f, "--curvature", optarg, least_turn, most_turn);
        else if (c == MOST)
            o.most = filter_number(f, "--most", optarg, 1, most_ids);
        else
            octree_rules_option(f, &o.rules, c);
    }
    o.surface.walls = o.surface.regions && !o.surface.lenient;
    if (o.rules.rules.count == 0)
        octree_rules_add_level(f, &o.rules, TM_RULE_SURFACE, default_level);
    o.plan.rule = o.rules.rules.rule;
    o.plan.rules = o.rules.rules.count;
    tm_mesh_plan_set_levels(&o.plan, o.plan.levels);
    return o;
}

/* Gives the rules for the surface the largest octants that its curvature leaves; the
 * array that they have then. */
static double *follow_curvature(const filter *f, settings *o, const tm_surface *s)
{
    const unsigned levels = 3; /* a plane has octants of so many less */
    if (o->curvature == 0)
        return NULL;
    double *largest = malloc((s->triangles + 1) * sizeof *largest);
    if (!largest)
        filter_fail_memory(f);
    tm_surface_find_curvature(s, largest);
    for (size_t t = 0; t < s->triangles; t++)
        largest[t] = o->curvature / straight_angle * pi / largest[t];
    for (size_t r = 0; r < o->rules.rules.count; r++)
        if (o->rules.rules.rule[r].kind == TM_RULE_SURFACE) {
            o->rules.rules.rule[r].largest = largest;
            o->rules.rules.rule[r].spread = levels;
        }
    return largest;
}

/* How many elements would be made if all octants were `coarser` times as large, and the
 * side of the smallest. */
static double estimate(const filter *f, const settings *o, const tm_surface *s,
                       double coarser, double *side)
{
    const tm_octree_rules *rules = &o->rules.rules;
    double elements;
    tm_error error;
    if (tm_octree_estimate(s, rules->rule, rules->count, coarser, &elements, side,
                           &error) != TM_OK)
        filter_fail(f, &error);
    return elements;
}

/* How many levels less would fit, and which side of the smallest octants. */
static unsigned find_fit(const filter *f, const settings *o, const tm_surface *s,
                         double *side)
{
    const int halves = 6;
    unsigned levels = 1;
    while (estimate(f, o, s, ldexp(1, (int)levels), side) > o->most)
        levels++;
    double none = ldexp(1, (int)levels - 1), fits = 2 * none;
    for (int i = 0; i < halves; i++) {
        const double between = (none + fits) / 2;
        if (estimate(f, o, s, between, side) > o->most)
            none = between;
        else
            fits = between;
    }
    estimate(f, o, s, fits, side);
    return levels;
}

/* Refuses what would take too much time and memory, with what would not. */
static void refuse_many(const filter *f, const settings *o, const tm_surface *s)
{
    double finest, side;
    const double elements = estimate(f, o, s, 1, &finest);
    filter_verbose(f, "about %.2g elements are to be expected", elements);
    if (elements <= o->most)
        return;
    tm_error error;
    const unsigned levels = find_fit(f, o, s, &side);
    tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
               "about %.2g elements would be made, with octants down to %.3g, more than "
               "%.3g (--most); levels that are lower by %u would fit, or octants of %.3g "
               "(--size)",
               elements, finest, o->most, levels, side);
    filter_fail(f, &error);
}

/* Whether several ranks can make the mesh: not where regions are within others, or meet
 * in walls. */
static bool can_share(const settings *o, const tm_surface *s)
{
    if (s->walls || s->region || s->by_winding || o->polyhedra)
        return false;
    for (size_t r = 0; r < o->rules.rules.count; r++)
        if (o->rules.rules.rule[r].kind == TM_RULE_LEAVES)
            return false;
    return true;
}

/* The octree, and its mesh. */
static void make_mesh(filter *f, settings *o, tm_surface *surface, tm_octree *octree,
                      tm_octree_mesh *mesh)
{
    const unsigned most = o->plan.levels;
    tm_error error;
    o->plan.progress = filter_progress(f);
    if (tm_octree_mesh_choose(mesh, octree, surface, &o->plan, &error) != TM_OK)
        filter_fail(f, &error);
    if (o->plan.levels < most)
        filter_note(f,
                    "octants are split up to %u times more, not %u (--resolve): with "
                    "more levels more nodes would be held back",
                    o->plan.levels, most);
    if (!o->plan.laid_out)
        filter_verbose(f, "octants have the regions of their centres also where walls "
                          "meet sharply: else more nodes would be held back");
}

typedef struct {
    tm_octree_mesh_report mesh;
    size_t octants, nodes, boundary_nodes;
    size_t kind[TM_ELEMENT_NODES + 1]; /* elements by their nodes */
    size_t polyhedra, facets, unfit;   /* 0 where there are elements */
} report;

static report report_of(const tm_octree *octree, const tm_octree_mesh *mesh)
{
    const tm_mixed_mesh *m = &mesh->assembly.mesh;
    const tm_mesh_share *s = mesh->share;
    report r = {.mesh = mesh->report,
                .octants = s ? s->of->all_leaves : octree->leaves,
                .nodes = s ? s->nodes : m->nodes,
                .boundary_nodes = s ? s->outer.all : mesh->boundary.nodes};
    const size_t first = s ? s->elements.first : 0;
    const size_t past = s ? s->elements.past : m->elements;
    for (size_t e = first; e < past; e++)
        r.kind[m->start[e + 1] - m->start[e]]++;
    tm_ranks_sum(r.kind, sizeof r.kind / sizeof *r.kind);
    return r;
}

static void write_json(filter *f, const report *r)
{
#define ROW(key, member) TM_REPORT_ROW(key, NULL, NULL, report, member)
    static const tm_report_row rows[] = {ROW("octants", octants),
                                         ROW("nodes", nodes),
                                         TM_REPORT_OPEN_ROW("elements"),
                                         ROW("tet", kind[4]),
                                         ROW("pyramid", kind[5]),
                                         ROW("wedge", kind[6]),
                                         ROW("hex", kind[8]),
                                         TM_REPORT_CLOSE_ROW,
                                         ROW("polyhedra", polyhedra),
                                         ROW("facets", facets),
                                         ROW("unfit", unfit),
                                         ROW("boundary_nodes", boundary_nodes),
                                         ROW("held_back", mesh.off_surface),
                                         ROW("inverted", mesh.invalid),
                                         ROW("not_positive", mesh.not_positive),
                                         ROW("lost_octants", mesh.lost),
                                         ROW("rounded_tips", mesh.rounded),
                                         ROW("dropped_pieces", mesh.dropped),
                                         ROW("lost_corners", mesh.corners_lost),
                                         ROW("lost_edges", mesh.curves_lost),
                                         ROW("regions", mesh.regions),
                                         ROW("lost_regions", mesh.regions_lost),
                                         ROW("components", mesh.outer_components),
                                         ROW("euler", mesh.outer_euler),
                                         {0}};
    filter_write_json(f, rows, r);
}

/* Joins the elements of each octant, in the stream. */
static void join_octants(filter *f, tm_stream *stream, report *r)
{
    char faults[256];
    tm_octant_join join;
    tm_error error;
    filter_stage(f, "joining octants");
    if (tm_join_octants(stream, &join, &error) != TM_OK)
        filter_fail(f, &error);
    r->polyhedra = join.polyhedra;
    r->facets = join.facets;
    r->unfit = tm_fit_faults_left(&join.fit);
    tm_fit_faults_say(&join.fit, faults, sizeof faults);
    if (r->unfit > 0)
        filter_note(f, "not quite fit for finite volumes: %s", faults);
}

/* The mesh by this process alone; its report. */
static report make_alone(filter *f, settings *o, tm_surface *surface, tm_stream *stream)
{
    tm_octree octree;
    tm_octree_mesh mesh;
    tm_error error;
    make_mesh(f, o, surface, &octree, &mesh);
    octree_note_losses(f, surface, &mesh.report,
                       ldexp(octree.side, -(int)tm_octree_deepest(&octree)));
    report r = report_of(&octree, &mesh);
    const size_t elements = mesh.assembly.mesh.elements;
    filter_stage(f, "numbering");
    if (tm_octree_mesh_to_stream(&mesh, &octree, surface, o->levels, stream, &error) !=
        TM_OK)
        filter_fail(f, &error);
    if (o->polyhedra)
        join_octants(f, stream, &r);
    if (f->json)
        write_json(f, &r);
    filter_write(f, stream, "%zu octants, %zu nodes, %zu %s", r.octants, r.nodes,
                 o->polyhedra ? r.polyhedra : elements,
                 o->polyhedra ? "polyhedra" : "elements");
    tm_octree_mesh_free(&mesh);
    tm_octree_free(&octree);
    return r;
}

/* Says how many octants ranks have of others, at their borders. */
static void say_ghosts(const filter *f, const tm_octree_share *share)
{
    size_t count = share->octree.leaves - (share->own_past - share->own_first);
    double most = (double)count;
    tm_ranks_sum(&count, 1);
    tm_ranks_largest(&most, 1);
    filter_verbose(f, "of others each rank has %.0f octants, %.0f at most",
                   (double)count / tm_ranks_count(), most);
}

/* Writes what ranks have made together. */
static report write_together(filter *f, const settings *o, tm_surface *surface,
                             const tm_octree_share *share, tm_octree_mesh *mesh,
                             tm_slices *slices)
{
    tm_error error;
    const unsigned finest = tm_octree_share_deepest(share);
    octree_note_losses(f, surface, &mesh->report,
                       ldexp(share->octree.side, -(int)finest));
    const report r = report_of(&share->octree, mesh);
    say_ghosts(f, share);
    filter_stage(f, "numbering");
    filter_agree(
        f,
        tm_octree_mesh_to_slices(mesh, share, finest, surface, o->levels, slices, &error),
        &error);
    if (f->json)
        write_json(f, &r);
    filter_write_slices(f, slices, "%zu octants, %zu nodes, %zu elements", r.octants,
                        r.nodes, mesh->share->elements.all);
    return r;
}

/* The mesh by all ranks; false where that is for rank 0 alone. */
static bool make_together(filter *f, settings *o, tm_surface *surface, tm_slices *slices,
                          report *r)
{
    tm_octree_share share = {0};
    tm_octree_mesh mesh;
    tm_error error;
    bool alone;
    o->plan.progress = filter_progress(f);
    filter_agree(
        f,
        tm_octree_mesh_choose_on_ranks(&mesh, &share, surface, &o->plan, &alone, &error),
        &error);
    if (!alone)
        *r = write_together(f, o, surface, &share, &mesh, slices);
    tm_octree_mesh_free(&mesh);
    tm_octree_share_free(&share);
    if (alone)
        filter_verbose(f, "the octants have hollows, which may be regions: "
                          "rank 0 goes on alone");
    const bool first = tm_rank() == 0;
    if (alone)
        tm_ranks_leave();
    if (!first && alone)
        exit(EXIT_SUCCESS);
    return !alone;
}

int main(int argc, char **argv)
{
    filter f = {.name = "octree-mesh",
                .synopsis = synopsis,
                .purpose =
                    "Fills a closed surface with hexahedra, and with wedges, pyramids\n"
                    "and tetrahedra where octants of different size meet.",
                .help = own_help,
                .options = options,
                .letters = "a:s:b:r:l:u" FILTER_LETTERS,
                .ranks = true};
    filter_start(&f, argc, argv);
    settings o = read_options(&f);
    filter_operands(&f);
    o.surface.threads = f.threads;
    tm_surface surface;
    tm_slices slices = {0};
    report r;
    if (!f.input)
        filter_together(&f, false);
    surface_input_build(&f, &o.surface, &surface, &slices.stream);
    const bool together = filter_together(&f, can_share(&o, &surface));
    double *largest = follow_curvature(&f, &o, &surface);
    refuse_many(&f, &o, &surface);
    octree_note_outside(&f, &o.rules, &surface);
    mpi_environment_set(&f);
    if (!together || !make_together(&f, &o, &surface, &slices, &r))
        r = make_alone(&f, &o, &surface, &slices.stream);
    octree_rules_free(&o.rules);
    free(largest);
    tm_slices_free(&slices);
    tm_surface_free(&surface);
    const bool done = r.mesh.invalid == 0 || tm_rank() > 0;
    return filter_finish(&f, done ? EXIT_SUCCESS : EXIT_GOAL);
}
