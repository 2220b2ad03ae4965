/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes that are off the surface go to the boundary one by one: all of the way if the
 * nodes around can make room, or half of it, and so on; first those that it is easy for.
 */
#include "optimise_parts.h"

/* How often a node is tried, and all of them. */
enum { TRIES = 6, ROUNDS = 4, CORE_MOST = 256, RINGS = 1, FAR_RINGS = 2 };

/* The way that is left, as a factor of what there was: first none, where that fails half,
 * then three quarters. */
static const double factors[] = {0, 0.5, 0.75};
enum { FACTORS = sizeof factors / sizeof *factors };

static size_t find_local(const tm_cluster *cluster, uint32_t node)
{
    size_t v = 0;
    while (v < cluster->moving && cluster->node[v] != node)
        v++;
    return v;
}

/* Takes a node closer by that factor; *done says whether elements stayed good. */
static tm_status approach(tm_optimise_work *w, uint32_t node, double factor,
                          bool may_untangle, bool *done, tm_error *error)
{
    const tm_vicinity *vicinity = &w->vicinity;
    const uint32_t row = vicinity->row[node];
    const uint32_t *core = vicinity->element + vicinity->start[row];
    const size_t cores = vicinity->start[row + 1] - vicinity->start[row];
    tm_cluster *cluster = &w->cluster;
    const tm_status status = tm_cluster_gather(
        cluster, &w->source, core, cores < CORE_MOST ? cores : CORE_MOST,
        w->options->effort > 1 ? FAR_RINGS : RINGS, error);
    *done = false;
    if (status != TM_OK)
        return status;
    const size_t v = find_local(cluster, node);
    if (v == cluster->moving)
        return TM_OK;
    w->report->clusters++;
    tm_cluster_approach(cluster, v, factor, w->options->off_surface_threshold);
    tm_optimise_descend(w, may_untangle);
    *done = cluster->best_score.bad <= cluster->first.bad;
    if (*done)
        tm_optimise_accept(w);
    return TM_OK;
}

/* Tries one node, in the first round once and with little effort; *closer says whether it
 * is. */
static tm_status bring(tm_optimise_work *w, uint32_t node, size_t round, bool *closer,
                       tm_error *error)
{
    const size_t tries = round == 0 ? 1 : TRIES;
    size_t f = 0;
    for (size_t t = 0; t < tries && f < FACTORS && w->rule[node].off_surface &&
                       !tm_optimise_is_spent(w);
         t++) {
        bool done;
        const tm_status status = approach(w, node, factors[f], round > 0, &done, error);
        if (status != TM_OK)
            return status;
        *closer |= done;
        if (done && f == 0)
            w->rule[node].off_surface = false;
        f = done ? 0 : f + 1;
    }
    return TM_OK;
}

tm_status tm_optimise_off_surface(tm_optimise_work *w, tm_error *error)
{
    bool closer = true;
    tm_progress_at at = {.what = "bringing nodes to the surface"};
    for (size_t round = 0; round < ROUNDS && closer && !tm_optimise_is_spent(w);
         round++) {
        closer = round == 0; /* the next one tries harder */
        at.pass = round + 1;
        at.of = w->mesh->nodes;
        for (uint32_t v = 0; v < w->mesh->nodes; v++) {
            tm_progress_step(w->options->progress, &at, v);
            if (!w->rule[v].off_surface || w->rule[v].freedom == TM_MOVES_NOT ||
                w->vicinity.start[w->vicinity.row[v]] ==
                    w->vicinity.start[w->vicinity.row[v] + 1])
                continue;
            const tm_status status = bring(w, v, round, &closer, error);
            if (status != TM_OK)
                return status;
        }
    }
    return TM_OK;
}
