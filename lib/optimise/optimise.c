/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimise.h"

#include "../base/array.h"
#include "../element/jens.h"
#include "../stream/stream.h"
#include "optimise_parts.h"

#include <stdlib.h>

/* Nodes of how many rings of elements around the bad ones may move, at most. */
enum { RINGS_MOST = 2 };

static void count_elements(const tm_optimise_work *w, size_t *bad, size_t *inverted,
                           double *worst)
{
    *bad = *inverted = 0;
    *worst = 1;
    for (size_t e = 0; e < w->mesh->elements; e++) {
        *bad += w->jens[e] < tm_threshold_of(w->options, e);
        *inverted += w->jens[e] <= 0;
        *worst = w->jens[e] < *worst ? w->jens[e] : *worst;
    }
}

static size_t count_off_surface(const tm_optimise_work *w)
{
    size_t off_surface = 0;
    for (size_t v = 0; v < w->mesh->nodes; v++)
        off_surface += w->rule[v].off_surface;
    return off_surface;
}

/* Lists the bad elements. */
static tm_status find_bad(tm_optimise_work *w, tm_error *error)
{
    const size_t elements = w->mesh->elements;
    size_t bads = 0;
    for (size_t e = 0; e < elements; e++)
        bads += w->jens[e] < tm_threshold_of(w->options, e);
    free(w->bad);
    w->bads = 0;
    w->bad = tm_new(bads, sizeof *w->bad);
    if (!w->bad)
        return tm_fail_memory(error);
    for (size_t e = 0; e < elements; e++)
        if (w->jens[e] < tm_threshold_of(w->options, e))
            w->bad[w->bads++] = (uint32_t)e;
    return TM_OK;
}

static tm_status start_work(tm_optimise_work *w, tm_error *error)
{
    const size_t elements = w->mesh->elements;
    w->jens = tm_new(elements, sizeof *w->jens);
    if (!w->jens)
        return tm_fail_memory(error);
    for (size_t e = 0; e < elements; e++)
        w->jens[e] = tm_mixed_jens(w->mesh, e);
    tm_optimise_report *report = w->report;
    count_elements(w, &report->bad_before, &report->inverted_before,
                   &report->worst_before);
    report->off_surface_before = count_off_surface(w);
    return find_bad(w, error);
}

/* What is needed only where there is something to do. */
static tm_status start_moving(tm_optimise_work *w, const tm_boundary *boundary,
                              tm_error *error)
{
    const tm_mixed_mesh *mesh = w->mesh;
    tm_status status =
        tm_vicinity_find(&w->vicinity, mesh, w->bad, w->bads, w->rule, RINGS_MOST, error);
    if (status != TM_OK)
        return status;
    w->visited = calloc(mesh->elements + 1, sizeof *w->visited);
    w->moved = calloc(mesh->nodes + 1, sizeof *w->moved);
    uint32_t *local = tm_new(mesh->nodes, sizeof *local);
    bool *taken = calloc(mesh->elements + 1, sizeof *taken);
    w->source = (tm_cluster_source){mesh,    w->rule,      boundary, w->options,
                                    w->jens, &w->vicinity, local,    taken};
    if (!w->visited || !w->moved || !local || !taken)
        return tm_fail_memory(error);
    for (size_t v = 0; v < mesh->nodes; v++)
        local[v] = TM_NONE;
    return TM_OK;
}

static void end_work(tm_optimise_work *w)
{
    free(w->jens);
    free(w->bad);
    free(w->visited);
    free(w->moved);
    free(w->source.local);
    free(w->source.taken);
    tm_vicinity_free(&w->vicinity);
    tm_cluster_free(&w->cluster);
}

/* What nodes that were off the surface have left bad. */
static tm_status mend_again(tm_optimise_work *w, tm_error *error)
{
    tm_status status = find_bad(w, error);
    if (status != TM_OK || w->bads == 0)
        return status;
    tm_vicinity_free(&w->vicinity);
    status = tm_vicinity_find(&w->vicinity, w->mesh, w->bad, w->bads, w->rule, RINGS_MOST,
                              error);
    return status == TM_OK ? tm_optimise_mend(w, w->options->effort, error) : status;
}

tm_status tm_mixed_optimise(tm_mixed_mesh *mesh, tm_node_rule *rule,
                            const tm_boundary *boundary,
                            const tm_optimise_options *options,
                            tm_optimise_report *report, tm_error *error)
{
    *report = (tm_optimise_report){0};
    tm_optimise_work w = {
        .mesh = mesh, .rule = rule, .options = options, .report = report};
    tm_status status = start_work(&w, error);
    const bool bring =
        report->off_surface_before > 0 && options->off_surface_threshold > 0;
    if (status == TM_OK && (w.bads > 0 || bring)) {
        status = start_moving(&w, boundary, error);
        if (status == TM_OK)
            status = tm_optimise_mend(
                &w, options->release_threshold > 0 ? 0 : options->effort, error);
        if (status == TM_OK && options->release_threshold > 0)
            status = tm_optimise_release(&w, error);
        if (status == TM_OK && bring)
            status = tm_optimise_off_surface(&w, error);
        if (status == TM_OK && bring)
            status = mend_again(&w, error);
    }
    if (w.bad) {
        count_elements(&w, &report->bad_after, &report->inverted_after,
                       &report->worst_after);
        report->off_surface_after = count_off_surface(&w);
        for (size_t v = 0; w.moved && v < mesh->nodes; v++)
            report->moved += w.moved[v];
        report->evaluations = w.cluster.evaluations;
        report->measured = w.cluster.measured;
    }
    end_work(&w);
    return status;
}
