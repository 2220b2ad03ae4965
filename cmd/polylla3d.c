/* SPDX-License-Identifier: GPL-3.0-or-later */
/* polylla3d: tetrahedra in, or the elements of octants, polyhedra out. */
#include "common/app/filter.h"
#include "common/input/tet_input.h"

#include "../lib/mesh/cell_faces.h"
#include "../lib/poly/cluster/clusters.h"
#include "../lib/poly/facets.h"
#include "../lib/poly/given.h"
#include "../lib/poly/octant/join_octants.h"
#include "../lib/tet/mesh_measure.h"

#include <float.h>
#include <stdlib.h>
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

static const struct option options[] = {
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

static const char own_help[] =
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

typedef struct {
    tm_poly_options poly;
    bool partition;   /* is given, */
    size_t attribute; /* by this one, from 1; 0: the last one */
    bool merge, ignore_markers, label;
    size_t levels;  /* coarser ones */
    bool any;       /* of the other options is given */
    bool for_tets;  /* one that is for tetrahedra alone */
    double degrees; /* of --merge-coplanar */
} settings;

static const double most_degrees = 30;

static const char *const metrics[] = {"area", "inradius"};

static const filter_words option_words[] = {
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

static void set_option(filter *f, settings *o, int c)
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

static settings read_options(filter *f)
{
    settings o = {.poly = {.repair = true}};
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
    if (o.label && o.merge)
        filter_usage_error(f, "--merge-coplanar is for faces: --label writes none");
    return o;
}

/* Puts the blocks of the polyhedra in the place of others. */
static void put_blocks(filter *f, tm_stream *stream, const char *const *gone,
                       size_t count, tm_block made[2])
{
    tm_error error;
    for (size_t k = 0; k < count; k++) {
        tm_block *block = tm_stream_find(stream, gone[k]);
        if (block)
            tm_stream_remove(stream, block);
    }
    for (int k = 0; k < 2; k++)
        if (tm_stream_put(stream, &made[k], &error) != TM_OK)
            filter_fail(f, &error);
}

/* Appends the polyhedra of the tetrahedra to their attributes; order[k] is the k-th of
 * the partition. */
static void put_labels(filter *f, tm_stream *stream, const tm_partition *partition,
                       const uint32_t *order)
{
    tm_error error;
    tm_block *ele = tm_stream_find(stream, ".ele");
    if (!ele)
        return;
    double *number = malloc(ele->count * sizeof *number + 1);
    if (!number)
        filter_fail_memory(f);
    for (size_t k = 0; k < ele->count; k++)
        number[order[k]] = partition->cell[k] + stream->base;
    if (tm_block_add_attribute(ele, number, &error) != TM_OK)
        filter_fail(f, &error);
    free(number);
}

/* What was done, for the note, the history and --json. */
typedef struct {
    tm_poly_report poly;
    size_t facets, joined, lost, levels;
    size_t unfit; /* of octants: what finite volume methods mind */
    char faults[256];
} result;

static void make_facets(filter *f, const settings *o, const tm_tet_mesh *mesh,
                        const tm_partition *partition, tm_block made[2], result *r)
{
    tm_error error;
    filter_stage(f, "finding faces");
    tm_coplanar plane = {o->degrees, tm_facet_flatness(mesh), o->poly.radius,
                         o->poly.star == TM_STAR_CENTROID};
    tm_status status =
        tm_partition_facets(partition, mesh, &made[0], &made[1], &r->lost, &error);
    if (status == TM_OK && o->merge)
        status = tm_merge_coplanar(mesh, &plane, &made[0], &made[1], &r->joined, &error);
    if (status != TM_OK)
        filter_fail(f, &error);
    r->facets = made[0].count;
}

/* Takes the attribute that is the partition out of the stream; NULL where none is. */
static uint32_t *take_partition(filter *f, tm_stream *stream, const settings *o)
{
    tm_error error;
    uint32_t *label = NULL;
    tm_block *ele = tm_stream_find(stream, ".ele");
    if (o->partition && ele && ele->count > 0 &&
        tm_take_given(ele, o->attribute ? o->attribute - 1 : ele->attributes - 1, &label,
                      &error) != TM_OK)
        filter_fail(f, &error);
    return label;
}

/* Cuts a mesh, which is sorted first: order[k] is which tetrahedron the k-th was. `given`
 * are labels of the tetrahedra as they were, or NULL. */
static void cut(filter *f, const settings *o, tm_tet_mesh *mesh, const uint32_t *given,
                tm_partition *partition, uint32_t *order, result *r)
{
    tm_error error;
    tm_poly_options poly = o->poly;
    uint32_t *sorted = malloc((mesh->slots + 1) * sizeof *sorted);
    if (!sorted)
        filter_fail_memory(f);
    filter_stage(f, "sorting");
    if (tm_tet_mesh_sort(mesh, order, &error) != TM_OK)
        filter_fail(f, &error);
    if (o->ignore_markers)
        tm_ignore_markers(mesh);
    for (size_t k = 0; k < mesh->slots && given; k++)
        sorted[k] = given[order[k]];
    if (given)
        poly.given = sorted;
    if (tm_partition_make(partition, mesh, &poly, &r->poly, &error) != TM_OK)
        filter_fail(f, &error);
    free(sorted);
}

/* Gives the tetrahedra of the stream labels: they stay in their order, a copy is cut. */
static void label(filter *f, tm_stream *stream, tm_tet_mesh *mesh, const settings *o,
                  const uint32_t *given, uint32_t *order, result *r)
{
    tm_error error;
    tm_tet_mesh sorted = {0};
    tm_partition partition;
    if (tm_tet_mesh_copy(&sorted, mesh, &error) != TM_OK)
        filter_fail(f, &error);
    cut(f, o, &sorted, given, &partition, order, r);
    if (tm_tet_mesh_to_stream(mesh, stream, &error) != TM_OK)
        filter_fail(f, &error);
    put_labels(f, stream, &partition, order);
    tm_partition_free(&partition);
    tm_tet_mesh_free(&sorted);
}

/* Makes polyhedra of mixed elements: of those of each octant one. */
static void join_octants(filter *f, tm_stream *stream, bool has_options, result *r)
{
    tm_error error;
    tm_octant_join join;
    const bool has_octants = tm_stream_find(stream, ".octant");
    if (!has_octants || has_options) {
        tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                   has_octants
                       ? "has mixed elements, those of each octant are joined: the "
                         "options are for tetrahedra"
                       : "has mixed elements, but no .octant that says which to join");
        filter_fail(f, &error);
    }
    filter_stage(f, "joining octants");
    if (tm_join_octants(stream, &join, &error) != TM_OK)
        filter_fail(f, &error);
    r->unfit = tm_fit_faults_left(&join.fit);
    tm_fit_faults_say(&join.fit, r->faults, sizeof r->faults);
    r->poly.tets = join.elements;
    r->poly.regions = r->poly.cells = join.polyhedra;
    r->facets = join.facets;
    r->joined = join.joined;
}

/* Joins polyhedra, unless only levels of them are asked for. */
static void join_polyhedra(filter *f, tm_stream *stream, const settings *o, result *r)
{
    static const char *const gone[] = {".cell", ".facet"};
    tm_error error;
    tm_cell_faces faces = {0};
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *old = tm_stream_find(stream, ".cell");
    tm_block made[2] = {{.name = ".facet", .kind = TM_FACET},
                        {.name = ".cell", .kind = TM_CELL}};
    r->poly = (tm_poly_report){.tets = old->count, .cells = old->count};
    if (o->for_tets) {
        tm_fail_at(
            &error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
            "has polyhedra, which are joined by --cells, --size, --star, --levels, "
            "--ignore-markers: other options are for tetrahedra");
        filter_fail(f, &error);
    }
    if (o->levels > 0 && !o->any)
        return;
    uint32_t *label = malloc((old->count + 1) * sizeof *label);
    tm_status status =
        label ? tm_cell_faces_find(&faces, stream, &error) : tm_fail_memory(&error);
    const tm_cluster_mesh mesh = {.faces = &faces,
                                  .nodes = node->count,
                                  .xyz = (const double(*)[3])node->real,
                                  .attributes = old->attributes,
                                  .attribute = old->attribute,
                                  .ignore_markers = o->ignore_markers};
    if (status == TM_OK)
        status = tm_cluster_cells(&mesh, &o->poly, label, &r->poly, &error);
    if (status == TM_OK)
        status =
            tm_cluster_blocks(&mesh, label, r->poly.cells, &made[0], &made[1], &error);
    if (status != TM_OK)
        filter_fail(f, &error);
    r->facets = made[0].count;
    tm_cell_faces_free(&faces);
    free(label);
    put_blocks(f, stream, gone, sizeof gone / sizeof *gone, made);
}

/* Adds levels to the polyhedra of the stream. */
static void add_levels(filter *f, tm_stream *stream, const settings *o, result *r)
{
    tm_error error;
    tm_poly_options poly = o->poly;
    if (poly.star == TM_STAR_CENTROID)
        poly.star = TM_NO_STAR;
    if (o->levels > 0 && tm_cluster_levels(stream, o->levels, &poly, o->ignore_markers,
                                           &r->levels, &error) != TM_OK)
        filter_fail(f, &error);
    if (r->levels < o->levels)
        filter_note(f, "%zu levels are all: on the last one nothing can be joined",
                    r->levels);
}

/* Makes polyhedra of the stream's tetrahedra. */
static void convert(filter *f, tm_stream *stream, const settings *o, result *r)
{
    static const char *const gone[] = {".ele", ".face"};
    tm_error error;
    tm_tet_mesh mesh;
    tm_partition partition;
    const tm_block *face = tm_stream_find(stream, ".face");
    tm_block made[2] = {
        {.name = ".facet", .kind = TM_FACET, .markers = face && face->markers},
        {.name = ".cell", .kind = TM_CELL}};
    *r = (result){0};
    if (tm_stream_find(stream, ".facet") || tm_stream_find(stream, ".cell")) {
        tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                   "has .facet or .cell already, which the polyhedra would be");
        filter_fail(f, &error);
    }
    uint32_t *given = take_partition(f, stream, o);
    tet_mesh_from_stream(f, stream, &mesh);
    uint32_t *order = malloc((mesh.slots + 1) * sizeof *order);
    if (!order)
        filter_fail_memory(f);
    if (o->label) {
        label(f, stream, &mesh, o, given, order, r);
    } else {
        cut(f, o, &mesh, given, &partition, order, r);
        make_facets(f, o, &mesh, &partition, made, r);
        if (tm_tet_mesh_to_stream(&mesh, stream, &error) != TM_OK)
            filter_fail(f, &error);
        put_blocks(f, stream, gone, sizeof gone / sizeof *gone, made);
        tm_partition_free(&partition);
    }
    free(given);
    free(order);
}

static void write_json(filter *f, const result *r)
{
#define ROW(key, member) TM_REPORT_ROW(key, NULL, NULL, result, member)
    static const tm_report_row rows[] = {ROW("tets", poly.tets),
                                         ROW("regions", poly.regions),
                                         ROW("regions_taken_apart", poly.taken_apart),
                                         ROW("absorbed", poly.absorbed),
                                         ROW("single", poly.single),
                                         ROW("not_star_shaped", poly.not_star),
                                         ROW("polyhedra", poly.cells),
                                         ROW("facets", facets),
                                         ROW("facets_joined", joined),
                                         ROW("levels", levels),
                                         ROW("unfit", unfit),
                                         {0}};
    filter_write_json(f, rows, r);
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "polylla3d",
        .synopsis =
            "[--mode terminal|edge|face|terminal-face|cavity|compact] [--cells N | "
            "--size H | --partition[=K]] [--no-repair] [--star[=R|=centroid]] "
            "[--absorb] [--max-tets N] [--no-swallow] "
            "[--merge-coplanar[=DEG]] [--ignore-markers] [--label] "
            "[--levels N] "
            "[--face-metric area|inradius] [FILE]",
        .purpose =
            "Joins tetrahedra, the elements of each octant, or polyhedra to polyhedra.",
        .help = own_help,
        .options = options,
        .words = option_words,
        .letters = FILTER_LETTERS};
    filter_start(&f, argc, argv);
    settings o = read_options(&f);
    filter_operands(&f);
    tm_stream stream;
    filter_read(&f, &stream);

    result r = {0};
    const tm_content content = tm_content_of(&stream);
    if (content == TM_CONTENT_MIXED)
        join_octants(&f, &stream, o.any, &r);
    else if (content == TM_CONTENT_POLYHEDRA)
        join_polyhedra(&f, &stream, &o, &r);
    else
        convert(&f, &stream, &o, &r);
    add_levels(&f, &stream, &o, &r);
    drop_unknown_blocks(&f, &stream, "the elements are polyhedra now");
    if (r.lost > 0)
        filter_note(&f, "%zu marked faces are inside of a polyhedron and dropped",
                    r.lost);
    if (r.unfit > 0)
        filter_note(&f, "not quite fit for finite volumes: %s", r.faults);
    bool is_missed = r.poly.not_star > 0;
    if (is_missed)
        filter_note(&f, "%zu polyhedra are no stars: %s", r.poly.not_star,
                    o.poly.star == TM_STAR_RADIUS
                        ? "tetrahedra that are too flat for the radius"
                        : "flat tetrahedra");
    if (10 * r.poly.single > r.poly.cells && content != TM_CONTENT_POLYHEDRA)
        filter_note(&f,
                    "%zu polyhedra are of one tetrahedron: with any beside it they would "
                    "be no stars, or no balls",
                    r.poly.single);
    char summary[256];
    double cells = (double)r.poly.cells;
    snprintf(summary, sizeof summary, "%zu %s -> %zu polyhedra, %.2f each", r.poly.tets,
             content == TM_CONTENT_MIXED       ? "elements"
             : content == TM_CONTENT_POLYHEDRA ? "polyhedra"
                                               : "tetrahedra",
             r.poly.cells, cells > 0 ? (double)r.poly.tets / cells : 0);
    if (r.levels > 0) {
        const size_t used = strlen(summary);
        snprintf(summary + used, sizeof summary - used, ", %zu coarser levels", r.levels);
    }
    filter_note(&f, "%s", summary);
    write_json(&f, &r);
    filter_write(&f, &stream, "%s", summary);
    tm_stream_free(&stream);
    return filter_finish(&f, is_missed ? EXIT_GOAL : EXIT_SUCCESS);
}
