/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimise.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../element/jens.h"
#include "../stream/stream.h"
#include "optimise_parts.h"

#include <stdlib.h>

/* Nodes of how many rings of elements around the bad ones may move, at most. */
enum { RINGS_MOST = 2 };

static void tally_chunk(void *context, size_t first, size_t past)
{
    const tm_optimise_work *w = context;
    tm_optimise_tally t = {.worst = 1};
    for (size_t e = first; e < past; e++) {
        t.bad += w->jens[e] < tm_threshold_of(w->options, e);
        t.inverted += w->jens[e] <= 0;
        t.worst = w->jens[e] < t.worst ? w->jens[e] : t.worst;
    }
    w->tally[first / TM_CHUNK] = t;
}

static void measure_chunk(void *context, size_t first, size_t past)
{
    const tm_optimise_work *w = context;
    for (size_t e = first; e < past; e++)
        w->jens[e] = tm_mixed_jens(w->mesh, e);
    tally_chunk(context, first, past);
}

/* Of all chunks as they were counted. */
static tm_optimise_tally count_elements(const tm_optimise_work *w)
{
    tm_optimise_tally all = {.worst = 1};
    for (size_t i = 0; i < tm_parallel_chunks(w->mesh->elements, TM_CHUNK); i++) {
        all.bad += w->tally[i].bad;
        all.inverted += w->tally[i].inverted;
        all.worst = w->tally[i].worst < all.worst ? w->tally[i].worst : all.worst;
    }
    return all;
}

static size_t count_off_surface(const tm_optimise_work *w)
{
    size_t off_surface = 0;
    for (size_t v = 0; v < w->mesh->nodes; v++)
        off_surface += w->rule[v].off_surface;
    return off_surface;
}

static void list_chunk(void *context, size_t first, size_t past)
{
    const tm_optimise_work *w = context;
    size_t next = w->tally[first / TM_CHUNK].before;
    for (size_t e = first; e < past; e++)
        if (w->jens[e] < tm_threshold_of(w->options, e))
            w->bad[next++] = (uint32_t)e;
}

/* Lists the bad elements, which were counted. */
static tm_status find_bad(tm_optimise_work *w, tm_error *error)
{
    const size_t elements = w->mesh->elements;
    size_t bads = 0;
    for (size_t i = 0; i < tm_parallel_chunks(elements, TM_CHUNK); i++) {
        w->tally[i].before = bads;
        bads += w->tally[i].bad;
    }
    free(w->bad);
    w->bads = 0;
    w->bad = tm_new(bads, sizeof *w->bad);
    if (!w->bad)
        return tm_fail_memory(error);
    tm_parallel_runs(w->mesh->threads, elements, TM_CHUNK, list_chunk, w);
    w->bads = bads;
    return TM_OK;
}

static tm_status start_work(tm_optimise_work *w, tm_error *error)
{
    const size_t elements = w->mesh->elements;
    w->jens = tm_new(elements, sizeof *w->jens);
    w->tally = tm_new(tm_parallel_chunks(elements, TM_CHUNK), sizeof *w->tally);
    if (!w->jens || !w->tally)
        return tm_fail_memory(error);
    tm_parallel_runs(w->mesh->threads, elements, TM_CHUNK, measure_chunk, w);
    const tm_optimise_tally all = count_elements(w);
    w->report->bad_before = all.bad;
    w->report->inverted_before = all.inverted;
    w->report->worst_before = all.worst;
    w->report->off_surface_before = count_off_surface(w);
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
    free(w->tally);
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
    tm_parallel_runs(w->mesh->threads, w->mesh->elements, TM_CHUNK, tally_chunk, w);
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
        tm_parallel_runs(mesh->threads, mesh->elements, TM_CHUNK, tally_chunk, &w);
        const tm_optimise_tally all = count_elements(&w);
        report->bad_after = all.bad;
        report->inverted_after = all.inverted;
        report->worst_after = all.worst;
        report->off_surface_after = count_off_surface(&w);
        for (size_t v = 0; w.moved && v < mesh->nodes; v++)
            report->moved += w.moved[v];
        report->evaluations = w.cluster.evaluations;
        report->measured = w.cluster.measured;
    }
    end_work(&w);
    return status;
}
