/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rounds of improve_parts.c, where each rank has some of the parts. */
#include "improve_ranks.h"

#include "../../base/array.h"
#include "../../element/tet_quality.h"

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

static tm_status improve_round(tm_improve_round_of *what, tm_tet_share *share,
                               size_t size, tm_improve_report *report,
                               size_t *inner_faces, tm_error *error)
{
    const unsigned threads = what->options.threads > 1 ? what->options.threads : 1;
    tm_tet_parts parts;
    tm_status status = tm_tet_share_cut(share, &parts, size, what->round, error);
    const size_t nodes = share->mesh.nodes;
    bool *between = tm_new(nodes, sizeof *between);
    status = tm_ranks_agree(status == TM_OK && !between ? tm_fail_memory(error) : status,
                            error);
    if (status == TM_OK)
        status = improve_parts(what, share, &parts, between, report, error);
    if (status == TM_OK)
        status = tm_tet_share_join(share, &parts, threads, inner_faces, error);
    if (status == TM_OK)
        status = find_due(share, between, nodes, error);
    tm_tet_parts_free(&parts);
    free(between);
    return status;
}

tm_status tm_improve_ranks(tm_tet_share *share, const tm_improve_options *options,
                           const tm_improve_cut *cut, tm_improve_report *report,
                           bool *worse, size_t *inner_faces, tm_error *error)
{
    const tm_tet_mesh whole = {.tets = share->all_tets};
    const size_t most = tm_tet_mesh_most(&whole, options->max_growth);
    tm_status status = TM_OK;
    *report = (tm_improve_report){0};
    const size_t bad_before = tm_improve_ranks_count_bad(share, options->angle);
    for (unsigned round = 0; round < TM_IMPROVE_ROUNDS && status == TM_OK; round++) {
        tm_improve_round_of what = {
            .options = *options, .engine = cut->engine, .round = round};
        tm_improve_limit_growth(&what.options, most, share->all_tets);
        status = improve_round(&what, share, cut->size, report, inner_faces, error);
    }
    add_reports(report);
    report->tets_before = whole.tets;
    report->bad_before = bad_before;
    if (status != TM_OK)
        return status;
    report->bad_after = tm_improve_ranks_count_bad(share, options->angle);
    *worse = tm_improve_is_worse(report, share->all_tets);
    return TM_OK;
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
    return status;
}
