/* SPDX-License-Identifier: GPL-3.0-or-later */
/* polylla3d: tetrahedra in, or the elements of octants, polyhedra out. */
#include "common/app/filter.h"
#include "common/input/mesh_input.h"
#include "common/input/poly_settings.h"
#include "common/input/tet_input.h"

#include "../lib/examine/poly/poly_finite_volume.h"
#include "../lib/mesh/cell_faces.h"
#include "../lib/poly/cluster/clusters.h"
#include "../lib/poly/facets.h"
#include "../lib/poly/given.h"
#include "../lib/poly/octant/join_octants.h"
#include "../lib/poly/ranks/polyhedra_ranks.h"
#include "../lib/tet/mesh_measure.h"

#include <stdlib.h>
#include <string.h>

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

enum { SUMMARY = 256 };

/* What was done, for the note, the history and --json. */
typedef struct {
    tm_poly_report poly;
    size_t facets, joined, lost, levels;
    size_t unfit; /* of octants: what finite volume methods mind */
    size_t skew;  /* facets of --star=centroid with a skewness above 4 */
    char faults[256];
} result;

static void make_facets(filter *f, const poly_settings *o, const tm_tet_mesh *mesh,
                        const tm_partition *partition, tm_block made[2], result *r)
{
    tm_error error;
    filter_stage(f, "finding faces");
    tm_coplanar plane = {o->degrees, tm_facet_flatness(mesh), o->poly.radius,
                         o->poly.star == TM_STAR_CENTROID};
    tm_status status = tm_partition_facets(partition, mesh, &made[0], &made[1], &r->lost,
                                           f->threads, &error);
    if (status == TM_OK && o->merge)
        status = tm_merge_coplanar(mesh, &plane, &made[0], &made[1], &r->joined, &error);
    if (status != TM_OK)
        filter_fail(f, &error);
    r->facets = made[0].count;
}

/* Takes the attribute that is the partition out of the stream; NULL where none is. */
static uint32_t *take_partition(filter *f, tm_stream *stream, const poly_settings *o)
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
static void cut(filter *f, const poly_settings *o, tm_tet_mesh *mesh,
                const uint32_t *given, tm_partition *partition, uint32_t *order,
                result *r)
{
    tm_error error;
    tm_poly_options poly = o->poly;
    uint32_t *sorted = malloc((mesh->slots + 1) * sizeof *sorted);
    if (!sorted)
        filter_fail_memory(f);
    filter_stage(f, "sorting");
    if (tm_tet_mesh_sort(mesh, order, f->threads, &error) != TM_OK)
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
static void label(filter *f, tm_stream *stream, tm_tet_mesh *mesh, const poly_settings *o,
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
static void join_polyhedra(filter *f, tm_stream *stream, const poly_settings *o,
                           result *r)
{
    static const char *const gone[] = {".cell", ".facet"};
    tm_error error;
    tm_cell_faces faces = {0};
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *old = tm_stream_find(stream, ".cell");
    tm_block made[2] = {{.name = ".facet", .kind = TM_FACET},
                        {.name = ".cell", .kind = TM_CELL}};
    r->poly = (tm_poly_report){.tets = old->count, .cells = old->count};
    r->facets = mesh_rows(stream, ".facet");
    if (o->for_tets) {
        tm_fail_at(
            &error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
            "has polyhedra, which are joined by --cells, --size, --star, --levels, "
            "--ignore-markers: other options are for tetrahedra");
        filter_fail(f, &error);
    }
    tm_cluster_forget_levels(stream);
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
static void add_levels(filter *f, tm_stream *stream, const poly_settings *o, result *r)
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
static void convert(filter *f, tm_stream *stream, const poly_settings *o, result *r)
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

/* Counts the facets that are skew where polyhedra are for finite volumes. */
static void count_skew(filter *f, const tm_stream *stream, result *r)
{
    tm_error error;
    tm_poly_finite_volume measures;
    const tm_poly_arrays mesh = tm_poly_arrays_of(stream);
    filter_stage(f, "measuring");
    if (tm_poly_finite_volume_check(&measures, &mesh, &error) != TM_OK)
        filter_fail(f, &error);
    r->skew = measures.skew;
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
                                         ROW("skew", skew),
                                         {0}};
    filter_write_json(f, rows, r);
}

/* What is not as it may have been meant. */
static void say_notes(const filter *f, const poly_settings *o, const result *r,
                      tm_content content)
{
    if (r->lost > 0 && filter_speaks())
        filter_leave_out(f, "%zu marked faces, which are inside of a polyhedron",
                         r->lost);
    if (r->unfit > 0)
        filter_note(f, "not quite fit for finite volumes: %s", r->faults);
    if (r->skew > 0)
        filter_note(f, "%zu facets are skew: above 4, which checkMesh minds%s", r->skew,
                    o->poly.absorb ? "; fewer without --absorb" : "");
    if (r->poly.not_star > 0)
        filter_note(f, "%zu polyhedra are no stars: %s", r->poly.not_star,
                    o->poly.star == TM_STAR_RADIUS
                        ? "tetrahedra that are too flat for the radius"
                        : "flat tetrahedra");
    if (10 * r->poly.single > r->poly.cells && content != TM_CONTENT_POLYHEDRA)
        filter_note(f,
                    "%zu polyhedra are of one tetrahedron: with any beside it they would "
                    "be no stars, or no balls",
                    r->poly.single);
}

/* What was done, in a line. */
static void summarize(const filter *f, const result *r, tm_content content,
                      char summary[SUMMARY])
{
    double cells = (double)r->poly.cells;
    snprintf(summary, SUMMARY, "%zu %s -> %zu polyhedra, %.2f each", r->poly.tets,
             content == TM_CONTENT_MIXED       ? "elements"
             : content == TM_CONTENT_POLYHEDRA ? "polyhedra"
                                               : "tetrahedra",
             r->poly.cells, cells > 0 ? (double)r->poly.tets / cells : 0);
    if (r->levels > 0) {
        const size_t used = strlen(summary);
        snprintf(summary + used, SUMMARY - used, ", %zu coarser levels", r->levels);
    }
    filter_note(f, "%s", summary);
}

static int exit_status(const result *r)
{
    return r->poly.not_star > 0 ? EXIT_GOAL : EXIT_SUCCESS;
}

/* All that one process does with a stream that it has read. */
static int convert_alone(filter *f, tm_stream *stream, const poly_settings *o)
{
    result r = {0};
    const tm_content content = tm_content_of(stream);
    if (content == TM_CONTENT_MIXED)
        join_octants(f, stream, o->any, &r);
    else if (content == TM_CONTENT_POLYHEDRA)
        join_polyhedra(f, stream, o, &r);
    else
        convert(f, stream, o, &r);
    if (o->poly.star == TM_STAR_CENTROID && !o->label)
        count_skew(f, stream, &r);
    add_levels(f, stream, o, &r);
    drop_unknown_blocks(f, stream, "the elements are polyhedra now");
    say_notes(f, o, &r, content);
    char summary[SUMMARY];
    summarize(f, &r, content, summary);
    write_json(f, &r);
    filter_write(f, stream, "%s", summary);
    tm_stream_free(stream);
    return filter_finish(f, exit_status(&r));
}

/* What all ranks can do together, if the mesh is of tetrahedra. */
static bool is_for_ranks(const poly_settings *o)
{
    const tm_poly_options *p = &o->poly;
    return p->mode == TM_POLY_TERMINAL && p->repair && p->star != TM_STAR_CENTROID &&
           !p->absorb && !o->partition && !o->merge && !o->label && o->levels == 0;
}

static bool has_only_tets(const tm_stream *stream)
{
    return tm_stream_find(stream, ".ele") && !tm_stream_find(stream, ".mix") &&
           !tm_stream_find(stream, ".facet") && !tm_stream_find(stream, ".cell");
}

/* The rest of it where rank 0 has to have all of the mesh. */
static int leave_to_first(filter *f, tm_slices *slices, const poly_settings *o)
{
    tm_error error;
    filter_agree(f, tm_slices_gather(slices, &error), &error);
    if (filter_speaks())
        return convert_alone(f, &slices->stream, o);
    filter_json_begin(f);
    filter_json_end(f);
    return filter_finish(f, EXIT_SUCCESS);
}

static void drop_unknown_slices(const filter *f, tm_slices *slices)
{
    for (size_t b = slices->stream.blocks; b > 0; b--) {
        tm_block *block = &slices->stream.block[b - 1];
        if (block->kind != TM_UNKNOWN || block->name[0] != '.')
            continue;
        if (filter_speaks()) /* for all ranks, which have the same blocks */
            filter_leave_out(f, "the block %s, as the elements are polyhedra now",
                             block->name);
        tm_slices_remove(slices, block);
    }
}

/* The same by all ranks. */
static int convert_together(filter *f, const poly_settings *o)
{
    tm_slices slices;
    tm_error error;
    tm_polyhedra_report made;
    bool odd = false;
    filter_read_slices(f, &slices);
    if (!has_only_tets(&slices.stream) ||
        tm_slices_check_coordinates(&slices, &error) != TM_OK)
        return leave_to_first(f, &slices, o);
    filter_agree(
        f, tm_polyhedra_ranks(&slices, &o->poly, o->ignore_markers, &made, &odd, &error),
        &error);
    if (odd)
        return leave_to_first(f, &slices, o);
    const result r = {.poly = made.poly, .facets = made.facets, .lost = made.lost};
    if (made.turned > 0)
        filter_note(f, "%zu tetrahedra were left-handed and are turned", made.turned);
    drop_unknown_slices(f, &slices);
    say_notes(f, o, &r, TM_CONTENT_TETRAHEDRA);
    char summary[SUMMARY];
    summarize(f, &r, TM_CONTENT_TETRAHEDRA, summary);
    write_json(f, &r);
    filter_write_slices(f, &slices, "%s", summary);
    tm_slices_free(&slices);
    return filter_finish(f, exit_status(&r));
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
        .help = poly_options_help,
        .options = poly_options,
        .words = poly_option_words,
        .letters = FILTER_LETTERS,
        .ranks = true};
    filter_start(&f, argc, argv);
    poly_settings o = poly_settings_read(&f);
    filter_operands(&f);
    if (filter_together(&f, is_for_ranks(&o)))
        return convert_together(&f, &o);
    tm_stream stream;
    filter_read(&f, &stream);
    return convert_alone(&f, &stream, &o);
}
