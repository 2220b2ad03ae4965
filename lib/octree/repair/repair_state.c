/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_state.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../element/certify.h"
#include "../../stream/stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_certified(const tm_mixed_mesh *mesh, size_t e)
{
    const size_t k = mesh->start[e + 1] - mesh->start[e];
    return tm_certify(k, (const double(*)[3])mesh->xyz, mesh->item + mesh->start[e]) ==
           TM_POSITIVE;
}

bool tm_repair_is_bad(const tm_mixed_mesh *mesh, size_t e, double jens, double threshold)
{
    return jens < fmax(threshold, TM_REPAIR_LEAST) || !is_certified(mesh, e);
}

double tm_repair_quality(const tm_mixed_mesh *mesh, size_t e, double jens)
{
    return jens <= 0 || is_certified(mesh, e) ? jens : 0;
}

/* Elements are measured in so many parts at most, which depend on their number alone. */
enum { PARTS_MOST = 512 };

typedef struct {
    const tm_repair_state *state;
    double threshold;
    size_t size; /* elements of a part */
    tm_repair_score part[PARTS_MOST];
    double sum[PARTS_MOST];
} measuring;

static void measure_part(void *context, size_t first, size_t past)
{
    measuring *m = context;
    const tm_mixed_mesh *mesh = &m->state->mesh;
    tm_repair_score score = {.worst = 1, .least = 1};
    double sum = 0;
    for (size_t e = first; e < past; e++) {
        const double jens = tm_mixed_jens(mesh, e);
        const double quality = tm_repair_quality(mesh, e, jens);
        const bool invalid = quality < TM_REPAIR_LEAST;
        score.invalid += invalid;
        score.bad += invalid || jens < m->threshold;
        score.worst = fmin(score.worst, jens);
        score.least = fmin(score.least, quality);
        sum += jens;
    }
    m->part[first / m->size] = score;
    m->sum[first / m->size] = sum;
}

tm_repair_score tm_repair_measure(const tm_repair_state *state, double threshold)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    tm_repair_score score = {.worst = 1,
                             .least = 1,
                             .good = fmax(threshold, TM_REPAIR_GOOD),
                             .valid = state->lenient ? TM_REPAIR_FLAT : TM_REPAIR_GOOD};
    double sum = 0;
    for (size_t v = 0; v < mesh->nodes; v++)
        score.off_surface += state->rule[v].off_surface;
    measuring m = {.state = state, .threshold = threshold, .size = TM_CHUNK};
    while (tm_parallel_chunks(mesh->elements, m.size) > PARTS_MOST)
        m.size *= 2;
    tm_parallel_runs(mesh->threads, mesh->elements, m.size, measure_part, &m);
    for (size_t i = 0; i < tm_parallel_chunks(mesh->elements, m.size); i++) {
        score.invalid += m.part[i].invalid;
        score.bad += m.part[i].bad;
        score.worst = fmin(score.worst, m.part[i].worst);
        score.least = fmin(score.least, m.part[i].least);
        sum += m.sum[i];
    }
    if (mesh->elements > 0)
        score.average = sum / (double)mesh->elements;
    if (state->rest) {
        score.worst = fmin(score.worst, state->rest->worst);
        score.least = fmin(score.least, state->rest->least);
    }
    return score;
}

tm_status tm_repair_fail_part(bool *why, tm_error *error)
{
    *why = true;
    return tm_fail(error, TM_ERROR_INTERNAL, "a part of the mesh is not enough");
}

bool tm_repair_better(const tm_repair_score *a, const tm_repair_score *b)
{
    const double good = a->invalid < b->invalid ? fmin(b->good, b->valid) : b->good;
    if (a->invalid > b->invalid || a->off_surface > b->off_surface ||
        (a->bad > b->bad && a->invalid == b->invalid) ||
        a->least < fmin(b->least, good) || a->worst < fmin(b->worst, good))
        return false;
    return a->invalid < b->invalid || a->off_surface < b->off_surface ||
           a->bad < b->bad || a->least > b->least;
}

/* Sorts octants and drops repeats; returns how many are left. */
static size_t sort_once(uint32_t *octant, size_t count)
{
    size_t kept = 0;
    if (count > 0)
        qsort(octant, count, sizeof *octant, tm_compare_numbers);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || octant[i] != octant[i - 1])
            octant[kept++] = octant[i];
    return kept;
}

static bool has_off_surface(const tm_repair_state *state, size_t e)
{
    for (size_t i = state->mesh.start[e]; i < state->mesh.start[e + 1]; i++)
        if (state->rule[state->mesh.item[i]].off_surface)
            return true;
    return false;
}

typedef struct {
    const tm_repair_state *state;
    double threshold;
    bool off_surface;
    const bool *except;
    bool *bad; /* [elements]: its octant is listed */
} lister;

static void find_bad(void *context, size_t first, size_t past)
{
    const lister *l = context;
    const tm_repair_state *state = l->state;
    for (size_t e = first; e < past; e++) {
        const double jens = tm_mixed_jens(&state->mesh, e);
        const bool bad = tm_repair_is_bad(&state->mesh, e, jens, l->threshold) &&
                         !(l->except && l->except[e]);
        l->bad[e] = state->octant[e] != TM_NONE &&
                    (bad || (l->off_surface && has_off_surface(state, e)));
    }
}

tm_status tm_repair_bad_octants(const tm_repair_state *state, double threshold,
                                bool off_surface, const bool *except, uint32_t **octant,
                                size_t *count, tm_error *error)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    size_t room = 0;
    *octant = NULL;
    *count = 0;
    lister l = {state, threshold, off_surface, except,
                tm_new(mesh->elements, sizeof *l.bad)};
    bool done = l.bad != NULL;
    if (done)
        tm_parallel_runs(mesh->threads, mesh->elements, TM_CHUNK, find_bad, &l);
    for (size_t e = 0; done && e < mesh->elements; e++)
        if (l.bad[e])
            done = tm_append(octant, count, &room, state->octant[e]);
    free(l.bad);
    if (!done)
        return tm_fail_memory(error);
    *count = sort_once(*octant, *count);
    return TM_OK;
}

tm_status tm_repair_widen(const tm_repair_state *state, uint32_t **octant, size_t *count,
                          tm_error *error)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    const size_t old = *count;
    size_t room = old;
    bool *marked = calloc(mesh->nodes + 1, sizeof *marked);
    if (!marked)
        return tm_fail_memory(error);
    for (size_t e = 0; e < mesh->elements; e++)
        if (bsearch(&state->octant[e], *octant, old, sizeof **octant, tm_compare_numbers))
            tm_mixed_mark_nodes(mesh, e, marked);
    for (size_t e = 0; e < mesh->elements; e++) {
        if (!tm_mixed_has_marked(mesh, e, marked) || state->octant[e] == TM_NONE)
            continue;
        uint32_t *grown = tm_grow(*octant, &room, *count + 1, sizeof *grown);
        if (!grown) {
            free(marked);
            return tm_fail_memory(error);
        }
        *octant = grown;
        grown[(*count)++] = state->octant[e];
    }
    free(marked);
    *count = sort_once(*octant, *count);
    return TM_OK;
}

void tm_repair_free_off_surface(tm_repair_state *state)
{
    for (size_t v = 0; v < state->mesh.nodes; v++)
        if (state->rule[v].off_surface && state->rule[v].freedom == TM_MOVES_ON_SURFACE)
            state->rule[v].where = TM_NONE;
}

tm_status tm_repair_save(tm_repair_points *places, const tm_repair_state *state,
                         tm_error *error)
{
    const size_t nodes = state->mesh.nodes;
    places->xyz = tm_new(nodes, sizeof *places->xyz);
    places->rule = tm_new(nodes, sizeof *places->rule);
    if (!places->xyz || !places->rule)
        return tm_fail_memory(error);
    memcpy(places->xyz, state->mesh.xyz, nodes * sizeof *places->xyz);
    memcpy(places->rule, state->rule, nodes * sizeof *places->rule);
    return TM_OK;
}

void tm_repair_restore(const tm_repair_points *places, tm_repair_state *state)
{
    const size_t nodes = state->mesh.nodes;
    memcpy(state->mesh.xyz, places->xyz, nodes * sizeof *places->xyz);
    memcpy(state->rule, places->rule, nodes * sizeof *places->rule);
}

void tm_repair_points_free(tm_repair_points *places)
{
    free(places->xyz);
    free(places->rule);
    *places = (tm_repair_points){0};
}

void tm_repair_state_free(tm_repair_state *state)
{
    free(state->mesh.xyz);
    free(state->mesh.start);
    free(state->mesh.item);
    free(state->rule);
    free(state->on);
    free(state->octant);
    free(state->origin);
    tm_octree_free(&state->octree);
    free(state->row);
    free(state->id);
    *state = (tm_repair_state){0};
}
