/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shared_optimise.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/parallel.h"
#include "../../element/jens.h"
#include "../../ranks/ranks.h"
#include "shared_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nodes of so many rings around bad elements may move (optimise.c), and all elements at
 * these are looked at. */
enum { RINGS = 2 };

static void measure_chunk(void *context, size_t first, size_t past)
{
    const tm_shared_work *s = context;
    for (size_t e = first; e < past; e++)
        s->jens[e] = tm_mixed_jens(&s->mesh->assembly.mesh, s->share->elements.first + e);
}

static size_t own_elements(const tm_shared_work *s)
{
    return s->share->elements.past - s->share->elements.first;
}

static bool is_bad(const tm_shared_work *s, size_t e)
{
    return s->jens[e - s->share->elements.first] < s->options->threshold;
}

/* Marks the nodes of candidates that are bad, of any rank, then so many rings around. */
static void mark_near(const tm_shared_work *s, unsigned rings)
{
    const tm_mesh_ghosts *ghosts = &s->share->ghosts;
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    const size_t nodes = mesh->nodes;
    memset(s->near, false, nodes);
    for (size_t c = 0; c < s->candidates; c++)
        if (is_bad(s, s->candidate[c]))
            tm_mixed_mark_nodes(mesh, s->candidate[c], s->near);
    tm_mesh_ghosts_mark(ghosts, s->near);
    for (unsigned ring = 0; ring < rings; ring++) {
        memcpy(s->mark, s->near, nodes);
        for (size_t c = 0; c < s->candidates; c++)
            if (tm_shared_is_near(s, s->candidate[c]))
                tm_mixed_mark_nodes(mesh, s->candidate[c], s->mark);
        tm_mesh_ghosts_mark(ghosts, s->mark);
        memcpy(s->near, s->mark, nodes);
    }
}

/* At first all own elements are candidates; then those within the most rings. */
static tm_status find_candidates(tm_shared_work *s, tm_error *error)
{
    size_t count = 0;
    s->candidate = tm_new(own_elements(s), sizeof *s->candidate);
    const tm_status status = tm_ranks_enough(s->candidate, error);
    if (status != TM_OK)
        return status;
    s->candidates = own_elements(s);
    for (size_t e = 0; e < s->candidates; e++)
        s->candidate[e] = (uint32_t)(s->share->elements.first + e);
    mark_near(s, RINGS);
    for (size_t c = 0; c < s->candidates; c++)
        if (tm_shared_is_near(s, s->candidate[c]))
            s->candidate[count++] = s->candidate[c];
    s->candidates = count;
    uint32_t *fewer = realloc(s->candidate, (count + 1) * sizeof *fewer);
    s->candidate = fewer ? fewer : s->candidate;
    return TM_OK;
}

/* Joins the near nodes of each element: what is of different sets has nothing to do with
 * each other. */
static void join_near(const tm_shared_work *s)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    for (size_t c = 0; c < s->candidates; c++) {
        const size_t e = s->candidate[c];
        const uint32_t first = tm_shared_near_node(s, e);
        if (first == TM_NONE)
            continue;
        const uint32_t with = tm_shared_stand_in(s, first);
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            if (s->near[mesh->item[i]])
                tm_set_unite(s->label, with, tm_shared_stand_in(s, mesh->item[i]));
    }
}

/* Finds the sets. */
static tm_status find_sets(const tm_shared_work *s, tm_error *error)
{
    for (size_t n = 0; n < s->share->of->octree.nodes; n++)
        s->label[n] = (uint32_t)n;
    join_near(s);
    return tm_share_join_sets(s->share->of, s->label, error);
}

/* How many candidates of all ranks are bad. */
static size_t count_bad(const tm_shared_work *s)
{
    size_t bad = 0;
    for (size_t c = 0; c < s->candidates; c++)
        bad += is_bad(s, s->candidate[c]);
    tm_ranks_sum(&bad, 1);
    return bad;
}

/* Mends by one pass, or by all, what is bad and puts it where it is then. */
static tm_status make_pass(const tm_shared_work *s, unsigned pass, size_t *measured,
                           tm_error *error)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    tm_sent_node *moved = NULL;
    size_t listed = 0, here = 0;
    mark_near(s, pass == 0 ? RINGS : tm_optimise_rings(pass));
    tm_status status = pass > 0 ? find_sets(s, error) : TM_OK;
    if (status == TM_OK)
        status = tm_shared_mend(s, pass, &moved, &listed, &here, error);
    if (status == TM_OK)
        status = tm_shared_put(s, moved, listed, error);
    for (size_t c = 0; status == TM_OK && c < s->candidates; c++)
        if (tm_shared_is_near(s, s->candidate[c]))
            s->jens[s->candidate[c] - s->share->elements.first] =
                tm_mixed_jens(mesh, s->candidate[c]);
    tm_ranks_sum(&here, 1);
    *measured += here;
    free(moved);
    return status;
}

/* Makes the passes, each of which all ranks make together. Where they measure so much
 * that one process would have ended before, all goes to rank 0, from where it was:
 * `kept`. */
static tm_status make_passes(const tm_shared_work *s, const double (*kept)[3],
                             tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    const unsigned passes = tm_optimise_passes(s->options->effort);
    tm_status status = TM_OK;
    size_t measured = 0;
    for (unsigned p = 1; p <= passes && status == TM_OK && count_bad(s) > 0; p++) {
        status = make_pass(s, p, &measured, error);
        if (measured >= s->options->most_measured)
            break;
    }
    if (status != TM_OK || measured < s->options->most_measured)
        return status;
    memcpy(mesh->xyz, kept, mesh->nodes * sizeof *kept);
    for (size_t c = 0; c < s->candidates; c++)
        s->jens[s->candidate[c] - s->share->elements.first] =
            tm_mixed_jens(mesh, s->candidate[c]);
    return make_pass(s, 0, &measured, error);
}

static double find_worst(const tm_shared_work *s)
{
    double worst = 1;
    for (size_t e = 0; e < own_elements(s); e++)
        worst = fmin(worst, s->jens[e]);
    tm_ranks_least(&worst, 1);
    return worst;
}

static tm_status optimise(tm_shared_work *s, tm_optimise_report *report, tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    tm_parallel_runs(mesh->threads, own_elements(s), TM_CHUNK, measure_chunk, s);
    report->worst_after = find_worst(s);
    if (report->worst_after >= s->options->threshold)
        return TM_OK;
    tm_status status = find_candidates(s, error);
    double(*kept)[3] = tm_new(mesh->nodes, sizeof *kept);
    if (status == TM_OK)
        status = tm_ranks_enough(kept, error);
    if (status == TM_OK) {
        memcpy(kept, mesh->xyz, mesh->nodes * sizeof *kept);
        status = make_passes(s, (const double(*)[3])kept, error);
    }
    free(kept);
    report->worst_after = find_worst(s);
    return status;
}

tm_status tm_shared_optimise(tm_octree_mesh *mesh, tm_node_rule *rule,
                             const tm_boundary *boundary,
                             const tm_optimise_options *options,
                             tm_optimise_report *report, tm_error *error)
{
    const tm_mesh_share *share = mesh->share;
    tm_mixed_mesh *elements = &mesh->assembly.mesh;
    if (!share)
        return tm_mixed_optimise(elements, rule, boundary, options, report, error);
    *report = (tm_optimise_report){0};
    tm_shared_work s = {
        .mesh = mesh,
        .share = share,
        .rule = rule,
        .boundary = boundary,
        .options = options,
        .jens = tm_new(share->elements.past - share->elements.first, sizeof *s.jens),
        .near = tm_new(elements->nodes, sizeof *s.near),
        .mark = tm_new(elements->nodes, sizeof *s.mark),
        .label = tm_new(share->of->octree.nodes, sizeof *s.label)};
    tm_status status =
        s.jens && s.near && s.mark && s.label ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = optimise(&s, report, error);
    free(s.jens);
    free(s.near);
    free(s.mark);
    free(s.label);
    free(s.candidate);
    return status;
}
