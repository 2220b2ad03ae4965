/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rounds of improve_parts.c, where each rank has some of the parts. */
#include "improve_ranks.h"

#include "../../base/array.h"
#include "../../element/tet_quality.h"
#include "../../ranks/post.h"
#include "../mesh_measure.h"
#include "../operation/features.h"

#include <math.h>
#include <stdlib.h>

size_t tm_improve_ranks_count_bad(const tm_tet_share *share, double degrees)
{
    const tm_tet_mesh *mesh = &share->mesh;
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    const double limit = tm_bad_sine2(degrees);
    size_t bad = 0;
    for (size_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        bad += (!share->own || share->own[t]) &&
               tm_tet_sine2(x[n[0]], x[n[1]], x[n[2]], x[n[3]]) < limit;
    }
    tm_ranks_sum(&bad, 1);
    return bad;
}

/* What all ranks have done. */
static void add_reports(tm_improve_report *report)
{
    tm_improve_report *r = report;
    double passes = (double)r->passes;
    size_t *counts[] = {&r->kicks, &r->done.edge_splits, &r->done.swallowed};
    for (int k = 0; k < 3; k++)
        tm_ranks_sum(counts[k], 1);
    tm_ranks_sum(r->done.op, TM_IMPROVE_OPS);
    tm_ranks_sum(r->tried, TM_IMPROVE_OPS);
    tm_ranks_largest(&passes, 1);
    r->passes = (size_t)passes;
}

/* Nodes that may move -------------------------------------------------------------- */

static double flatness_of_all(const tm_tet_share *share)
{
    double flatness =
        fmax(tm_facet_flatness(&share->mesh), tm_facet_flatness(&share->loose_nodes));
    tm_ranks_largest(&flatness, 1);
    return flatness;
}

/* Of tetrahedra that this rank has, not of those around. */
static void find_used(const tm_tet_share *share, bool *used)
{
    for (size_t t = 0; t < share->mesh.slots; t++)
        for (int i = 0; i < 4 && (!share->own || share->own[t]); i++)
            used[share->mesh.tet[t][i]] = true;
}

/* Whether nodes of a face that stays have different markers. */
static bool markers_differ(const tm_tet_mesh *mesh, const bool *used)
{
    const int32_t *marker = mesh->node_marker;
    for (size_t f = 0; f < mesh->faces && marker; f++) {
        const uint32_t *n = mesh->face[f].node;
        if (used[n[0]] && used[n[1]] && used[n[2]] &&
            (marker[n[0]] != marker[n[1]] || marker[n[0]] != marker[n[2]]))
            return true;
    }
    return false;
}

/* Counts each node where its home is, which hears of it from all ranks that use it. */
static tm_status count_at_home(const tm_tet_share *share, const size_t *home,
                               const bool *used, const uint8_t *dimension,
                               size_t nodes_free[4], tm_error *error)
{
    const size_t first = home[tm_rank()], past = home[tm_rank() + 1];
    tm_post post = {0};
    uint32_t *got;
    size_t words;
    for (size_t v = 0; v < share->mesh.nodes; v++) {
        const uint32_t letter[2] = {share->number[v], dimension[v]};
        if (used[v])
            tm_post_put(&post, tm_rank_of(home, letter[0]), letter, 2);
    }
    tm_status status = tm_post_deliver(&post, &got, &words, error);
    bool *known = calloc(past - first + 1, sizeof *known);
    if (status == TM_OK)
        status = tm_ranks_enough(known, error);
    for (size_t i = 0; i < words && status == TM_OK; i += 2) {
        nodes_free[got[i + 1]] += !known[got[i] - first];
        known[got[i] - first] = true;
    }
    tm_ranks_sum(nodes_free, 4);
    free(known);
    free(got);
    return status;
}

/* Makes no way lead out of what is around this rank's tetrahedra. */
static void close_rim(tm_tet_share *around)
{
    const uint32_t out = 4 * around->beyond;
    tm_tet_mesh *mesh = &around->mesh;
    for (uint32_t h = 0; h < 4 * mesh->slots; h++)
        if (mesh->neighbour[h / 4][h % 4] == out)
            mesh->neighbour[h / 4][h % 4] = h;
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 2; i++)
            if (mesh->face[f].side[i] == out)
                mesh->face[f].side[i] = TM_NONE;
}

static tm_status count_free_of(const tm_tet_share *around, const size_t *home,
                               double flatness, bool *odd, size_t nodes_free[4],
                               tm_error *error)
{
    const tm_tet_mesh *mesh = &around->mesh;
    tm_features features;
    tm_tet_marks marks = {0};
    bool *used = calloc(mesh->nodes + 1, sizeof *used);
    tm_status status = tm_features_find_in_part(&features, mesh, flatness, &marks, error);
    status =
        tm_ranks_agree(status == TM_OK && !used ? tm_fail_memory(error) : status, error);
    if (status == TM_OK) {
        find_used(around, used);
        *odd = tm_ranks_any(markers_differ(mesh, used));
        status = count_at_home(around, home, used, features.dimension, nodes_free, error);
    }
    free(used);
    tm_tet_marks_free(&marks);
    tm_features_free(&features);
    return status;
}

/* What one process says of nodes that may move; *odd: that only it can. */
static tm_status count_free_nodes(tm_tet_share *share, bool *odd, size_t nodes_free[4],
                                  tm_error *error)
{
    const double flatness = flatness_of_all(share);
    tm_tet_share around = {0};
    tm_status status = tm_tet_share_widen(share, NULL, &around, error);
    if (status == TM_OK) {
        close_rim(&around);
        status = count_free_of(&around, share->home, flatness, odd, nodes_free, error);
    }
    tm_tet_share_free(&around);
    return status;
}

/* Rounds --------------------------------------------------------------------------- */

/* What is due in the share becomes what is due after the round. */
static tm_status find_due(tm_tet_share *share, const bool *between, size_t nodes,
                          tm_error *error)
{
    const bool done = tm_improve_find_due(&share->mesh, &share->due, between, nodes);
    const tm_status status = tm_ranks_enough(done, error);
    return status == TM_OK ? tm_tet_share_any(share, share->due, nodes, error) : status;
}

/* Improves this rank's parts. */
static tm_status improve_parts(tm_improve_round_of *what, tm_tet_share *share,
                               const tm_tet_parts *parts, bool *between,
                               tm_improve_report *report, tm_error *error)
{
    tm_tet_parts_between(parts, &share->mesh, between);
    tm_status status = tm_tet_share_any(share, between, share->mesh.nodes, error);
    what->mesh = &share->mesh;
    what->due = share->due;
    what->between = between;
    if (status == TM_OK)
        status = tm_improve_round(what, parts, report, error);
    return tm_ranks_agree(status, error);
}

/* What is known of all rounds. */
typedef struct rounds {
    tm_tet_share *share;
    const tm_improve_options *options;
    const tm_improve_cut *cut;
    tm_improve_report *report;
    size_t most;      /* tetrahedra */
    bool count_nodes; /* in the first round */
    bool *alone;      /* they cannot be counted */
    size_t *inner_faces;
} rounds;

static tm_status improve_round(const rounds *all, unsigned round, tm_error *error)
{
    tm_tet_share *share = all->share;
    tm_improve_round_of what = {
        .options = *all->options, .engine = all->cut->engine, .round = round};
    const unsigned threads = what.options.threads > 1 ? what.options.threads : 1;
    tm_tet_parts parts;
    tm_improve_limit_growth(&what.options, all->most, share->all_tets);
    tm_status status = tm_tet_share_cut(share, &parts, all->cut->size, round, error);
    const size_t nodes = share->mesh.nodes;
    bool *between = tm_new(nodes, sizeof *between);
    status = tm_ranks_agree(status == TM_OK && !between ? tm_fail_memory(error) : status,
                            error);
    if (status == TM_OK && all->count_nodes && round == 0)
        status = count_free_nodes(share, all->alone, all->report->nodes_free, error);
    const bool goes_on = status == TM_OK && !*all->alone;
    if (goes_on)
        status = improve_parts(&what, share, &parts, between, all->report, error);
    if (goes_on && status == TM_OK)
        status = tm_tet_share_join(share, &parts, threads, all->inner_faces, error);
    if (goes_on && status == TM_OK)
        status = find_due(share, between, nodes, error);
    tm_tet_parts_free(&parts);
    free(between);
    return status;
}

tm_status tm_improve_ranks(tm_tet_share *share, const tm_improve_options *options,
                           const tm_improve_cut *cut, bool count_nodes,
                           tm_improve_report *report, bool *alone, size_t *inner_faces,
                           tm_error *error)
{
    const tm_tet_mesh whole = {.tets = share->all_tets};
    const rounds all = {share,
                        options,
                        cut,
                        report,
                        tm_tet_mesh_most(&whole, options->max_growth),
                        count_nodes,
                        alone,
                        inner_faces};
    tm_status status = TM_OK;
    *report = (tm_improve_report){0};
    *alone = false;
    const size_t bad_before = tm_improve_ranks_count_bad(share, options->angle);
    for (unsigned round = 0; round < TM_IMPROVE_ROUNDS && status == TM_OK && !*alone;
         round++)
        status = improve_round(&all, round, error);
    if (status != TM_OK || *alone)
        return status;
    add_reports(report);
    report->tets_before = whole.tets;
    report->bad_before = bad_before;
    report->bad_after = tm_improve_ranks_count_bad(share, options->angle);
    *alone = tm_improve_is_worse(report, share->all_tets);
    return TM_OK;
}

/* Rank 0 gets all sectors, in the order of ranks, which is that of their tetrahedra. */
static tm_status gather_sectors(tm_forced *forced, tm_error *error)
{
    void *all;
    size_t sectors;
    const tm_status status = tm_ranks_gather(
        forced->sector, forced->sectors, sizeof *forced->sector, &all, &sectors, error);
    free(forced->sector);
    forced->sector = all;
    forced->sectors = forced->room = all ? sectors : 0;
    return status;
}

tm_status tm_improve_ranks_forced(tm_tet_share *share, double degrees, tm_forced *forced,
                                  tm_error *error)
{
    tm_tet_share around = {0};
    *forced = (tm_forced){0};
    tm_status status = tm_tet_share_widen(share, NULL, &around, error);
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_forced_find_in(forced, &around.mesh, around.own, degrees, error), error);
    tm_ranks_sum(&forced->bad, 1);
    tm_ranks_sum(&forced->tets, 1);
    tm_tet_share_free(&around);
    return status == TM_OK ? gather_sectors(forced, error) : status;
}
