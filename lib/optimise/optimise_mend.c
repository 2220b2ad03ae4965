/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bad elements that touch are gathered, mended and put back, pass after pass. */
#include "optimise_parts.h"

#include "../base/array.h"
#include "../element/jens.h"
#include "../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How many bad elements that touch are one problem. */
enum { CORE_MOST = 32 };

/* One after the other: first what is cheap and mends most. */
typedef struct pass {
    unsigned rings;
    bool untangle; /* what stays inverted, by the other objective */
    double kick;   /* nodes are moved at random by so much of their size before */
} pass;

static const pass passes[] = {
    {0, false, 0}, {1, false, 0}, {0, true, 0}, {1, true, 0}, {2, false, 0}};
static const pass last_passes[] = {
    {0, true, 0.1}, {0, true, 0.3}, {1, true, 0.1}, {1, true, 0.3}, {2, true, 0.1}};
enum {
    PASSES = sizeof passes / sizeof *passes,
    LAST_PASSES = sizeof last_passes / sizeof *last_passes
};

/* The objective becomes the sharper the closer it is to its minimum. */
static const double sharpness[] = {8, 20, 60};
enum { UNTANGLE_STAGES = 12, UNTANGLE_ITERATIONS = 20, UNTANGLE_IDLE = 2 };
static const double untangle_gain = 0.9;
static const double epsilon_least = 1e-6;
enum { STAGES = sizeof sharpness / sizeof *sharpness, ITERATIONS = 25 };

/* 64 random bits: SplitMix64 (Steele, Lea, Flood, OOPSLA 2014). */
static uint64_t next_bits(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/* Moves the nodes at random, each time and in each cluster in another way. */
static void kick_nodes(tm_cluster *cluster, double kick, uint64_t seed)
{
    for (size_t v = 0; v < cluster->moving; v++) {
        double to[3];
        for (size_t i = 0; i < 3; i++) {
            const double unit = (double)(next_bits(&seed) >> 11) * 0x1p-52 - 1;
            to[i] = cluster->xyz[v][i] + kick * cluster->size[v] * unit;
        }
        tm_cluster_move(cluster, v, to);
    }
}

void tm_optimise_accept(tm_optimise_work *w)
{
    const tm_cluster *cluster = &w->cluster;
    for (size_t v = 0; v < cluster->moving; v++) {
        const uint32_t node = cluster->node[v];
        if (tm_distance2(w->mesh->xyz[node], cluster->best[v]) == 0)
            continue;
        memcpy(w->mesh->xyz[node], cluster->best[v], sizeof *cluster->best);
        w->moved[node] = true;
    }
    for (size_t e = 0; e < cluster->elements; e++)
        w->jens[cluster->element[e]] = tm_mixed_jens(w->mesh, cluster->element[e]);
}

static void sharpen(tm_cluster *cluster)
{
    for (size_t s = 0; s < STAGES && cluster->best_score.bad > 0; s++)
        tm_cluster_descend(cluster, (tm_objective){false, sharpness[s]}, ITERATIONS);
}

/* Ends also where for some stages neither fewer elements are inverted nor the worst of
 * them less. */
static void untangle(tm_cluster *cluster)
{
    double epsilon = 1, worst = -INFINITY;
    size_t least = SIZE_MAX, idle = 0;
    for (size_t s = 0;
         s < UNTANGLE_STAGES && idle < UNTANGLE_IDLE && cluster->best_score.inverted > 0;
         s++) {
        const double gain = tm_cluster_descend(cluster, (tm_objective){true, epsilon},
                                               UNTANGLE_ITERATIONS);
        epsilon = fmax(tm_untangle_next(cluster, epsilon, gain), epsilon_least);
        const size_t inverted = tm_cluster_score(cluster).inverted;
        const bool better =
            inverted < least || cluster->least_determinant > worst * untangle_gain;
        idle = better ? 0 : idle + 1;
        least = inverted < least ? inverted : least;
        worst = fmax(worst, cluster->least_determinant);
    }
}

void tm_optimise_descend(tm_optimise_work *w, bool may_untangle)
{
    tm_cluster *cluster = &w->cluster;
    sharpen(cluster);
    if (cluster->best_score.inverted == 0 || !may_untangle)
        return;
    untangle(cluster);
    if (cluster->best_score.inverted == 0)
        sharpen(cluster);
}

/* Bad elements that touch `first`, or each other: at most CORE_MOST. */
static size_t find_core(tm_optimise_work *w, uint32_t first, uint32_t core[CORE_MOST])
{
    const tm_mixed_mesh *mesh = w->mesh;
    size_t cores = 0;
    core[cores++] = first;
    w->visited[first] = true;
    for (size_t c = 0; c < cores; c++) {
        for (size_t i = mesh->start[core[c]]; i < mesh->start[core[c] + 1]; i++) {
            const uint32_t row = w->vicinity.row[mesh->item[i]];
            for (size_t j = w->vicinity.start[row]; j < w->vicinity.start[row + 1]; j++) {
                const uint32_t e = w->vicinity.element[j];
                if (cores == CORE_MOST)
                    return cores;
                if (w->visited[e] || w->jens[e] >= tm_threshold_of(w->options, e))
                    continue;
                w->visited[e] = true;
                core[cores++] = e;
            }
        }
    }
    return cores;
}

static tm_status mend_cluster(tm_optimise_work *w, uint32_t first, const pass *how,
                              uint64_t round, tm_error *error)
{
    uint32_t core[CORE_MOST];
    const size_t cores = find_core(w, first, core);
    tm_cluster *cluster = &w->cluster;
    const tm_status status =
        tm_cluster_gather(cluster, &w->source, core, cores, how->rings, error);
    if (status != TM_OK || cluster->moving == 0)
        return status;
    w->report->clusters++;
    const uint32_t *number = w->options->number;
    if (how->kick > 0)
        kick_nodes(cluster, how->kick, (number ? number[first] : first) ^ round << 32);
    tm_optimise_descend(w, how->untangle);
    if (tm_score_better(&cluster->best_score, &cluster->first))
        tm_optimise_accept(w);
    return TM_OK;
}

typedef struct ranked {
    double jens;
    uint32_t element;
} ranked;

static int compare(const void *a, const void *b)
{
    const ranked *r = a, *s = b;
    if (r->jens != s->jens)
        return r->jens < s->jens ? -1 : 1;
    return r->element < s->element ? -1 : r->element > s->element;
}

/* Leaves those that are still bad, the worst first. */
static tm_status rank_bad(tm_optimise_work *w, tm_error *error)
{
    size_t count = 0;
    ranked *list = tm_new(w->bads, sizeof *list);
    if (!list)
        return tm_fail_memory(error);
    for (size_t b = 0; b < w->bads; b++) {
        const uint32_t e = w->bad[b];
        w->visited[e] = false;
        if (w->jens[e] < tm_threshold_of(w->options, e))
            list[count++] = (ranked){w->jens[e], e};
    }
    qsort(list, count, sizeof *list, compare);
    for (size_t b = 0; b < count; b++)
        w->bad[b] = list[b].element;
    w->bads = count;
    free(list);
    return TM_OK;
}

bool tm_optimise_is_spent(const tm_optimise_work *w)
{
    const size_t most = w->options->most_measured;
    return (most > 0 && w->cluster.measured >= most) ||
           tm_stop_is_wanted(w->options->stop);
}

static tm_status make_pass(tm_optimise_work *w, const pass *how, uint64_t round,
                           tm_error *error)
{
    tm_status status = rank_bad(w, error);
    tm_progress_at at = {.what = "moving nodes",
                         .pass = ++w->passes,
                         .of = w->bads,
                         .bad = w->bads,
                         .all_bad = w->report->bad_before};
    for (size_t b = 0; status == TM_OK && b < w->bads && !tm_optimise_is_spent(w); b++) {
        const uint32_t e = w->bad[b];
        at.done = b;
        tm_progress_tell(w->options->progress, &at);
        if (!w->visited[e] && w->jens[e] < tm_threshold_of(w->options, e))
            status = mend_cluster(w, e, how, round, error);
    }
    return status;
}

unsigned tm_optimise_passes(unsigned effort)
{
    return PASSES + effort * LAST_PASSES;
}

/* The pass of that number, from 0. */
static const pass *pass_of(unsigned p)
{
    return p < PASSES ? &passes[p] : &last_passes[(p - PASSES) % LAST_PASSES];
}

unsigned tm_optimise_rings(unsigned p)
{
    return pass_of(p - 1)->rings;
}

tm_status tm_optimise_mend(tm_optimise_work *w, unsigned effort, tm_error *error)
{
    const unsigned only = w->options->pass;
    const unsigned past = only > 0 ? only : tm_optimise_passes(effort);
    tm_status status = TM_OK;
    for (unsigned p = only > 0 ? only - 1 : 0; p < past && status == TM_OK && w->bads > 0;
         p++)
        status = make_pass(w, pass_of(p), p < PASSES ? 0 : p - PASSES + 1, error);
    return status == TM_OK ? rank_bad(w, error) : status;
}
