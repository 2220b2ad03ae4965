/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"
#include "repair_trial.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../optimise/optimise_surface.h"

#include <math.h>
#include <stdlib.h>

/* How often elements that are not certified are worked on, and how much better their
 * corners have to be each time. */
enum { ROUNDS = 3 };

/* Nodes move so many elements away from what is bad, and those behind are needed. */
enum { PART_RINGS = 4 };

static const double certified_step = 0.05;

/* What each element has to be: an element that is not certified has to be better than it
 * is. Returns how many those are. */
static size_t set_thresholds(const tm_repair_state *state, double threshold, double *to)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    size_t count = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        const double jens = tm_mixed_jens(mesh, e);
        const bool uncertified = jens >= threshold && tm_repair_is_bad(mesh, e, jens, 0);
        to[e] = uncertified ? jens + certified_step : threshold;
        count += uncertified;
    }
    return count;
}

typedef struct {
    tm_repair_state *state;
    const tm_boundary *boundary; /* NULL: nodes of it do not move */
    double *thresholds;          /* [elements] */
    tm_optimise_options options;
} mover;

/* Moves so many times, as long as there are uncertified elements, then takes back what is
 * not better. */
static tm_status move(mover *m, int rounds, double threshold, tm_repair_score *score,
                      tm_error *error)
{
    tm_repair_points before = {0};
    bool changed = false;
    tm_status status = tm_repair_save(&before, m->state, error);
    for (int round = 0; status == TM_OK && round < rounds; round++) {
        tm_optimise_report report;
        const size_t uncertified =
            set_thresholds(m->state, m->options.threshold, m->thresholds);
        if (tm_stop_is_wanted(m->options.stop) || (rounds > 1 && uncertified == 0))
            break;
        status = tm_mixed_optimise(&m->state->mesh, m->state->rule, m->boundary,
                                   &m->options, &report, error);
        changed |=
            report.moved > 0 || report.off_surface_after != report.off_surface_before;
    }
    if (status == TM_OK && changed)
        status = tm_repair_take_back(m->state, &before, threshold, score->worst, error);
    if (status == TM_OK && changed)
        *score = tm_repair_measure(m->state, threshold);
    tm_repair_points_free(&before);
    return status;
}

/* Measurements of elements: by how much is bad, and no more than a threshold that most
 * elements are below is worth. */
static size_t most_measured(const tm_repair_state *state, const tm_repair_effort *effort,
                            size_t bad)
{
    const size_t most = 2500000 + 40 * state->mesh.elements;
    const size_t wanted = effort->at_least + effort->measured * bad;
    return wanted < most ? wanted : most;
}

/* Moves nodes of a mesh, all of it or a part: `worst` is that of the whole. */
static tm_status move_in(tm_repair_state *state, const tm_surface *surface,
                         double threshold, tm_repair_effort effort, double worst,
                         tm_error *error)
{
    tm_boundary boundary = {0};
    if (surface)
        boundary = tm_boundary_of_surface(surface);
    tm_repair_score score = tm_repair_measure(state, threshold);
    score.worst = worst;
    const double aim = fmax(threshold, effort.aim);
    mover m = {
        .state = state,
        .boundary = surface ? &boundary : NULL,
        .thresholds = tm_new(state->mesh.elements, sizeof *m.thresholds),
        .options = {.threshold = aim,
                    .off_surface_threshold =
                        effort.share > 0 ? fmax(effort.share * aim, TM_REPAIR_FLAT) : 0,
                    .effort = effort.effort,
                    .most_measured =
                        most_measured(state, &effort, score.bad + score.off_surface),
                    .progress = state->progress,
                    .stop = state->stop}};
    if (!m.thresholds)
        return tm_fail_memory(error);
    m.options.thresholds = m.thresholds;
    tm_status status = move(&m, 1, threshold, &score, error);
    m.options.off_surface_threshold = 0;
    if (status == TM_OK && score.invalid > 0)
        status = move(&m, ROUNDS, threshold, &score, error);
    free(m.thresholds);
    return status;
}

typedef struct {
    const tm_repair_state *state;
    double threshold;
    bool *is; /* [elements] */
} core_finder;

static void find_core_chunk(void *context, size_t first, size_t past)
{
    const core_finder *f = context;
    const tm_mixed_mesh *mesh = &f->state->mesh;
    for (size_t e = first; e < past; e++) {
        bool is = tm_repair_is_bad(mesh, e, tm_mixed_jens(mesh, e), f->threshold);
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            is |= f->state->rule[mesh->item[i]].off_surface;
        f->is[e] = is;
    }
}

/* The elements that are to become better, and those at nodes off the surface; malloc'ed.
 */
static uint32_t *find_core(const tm_repair_state *state, double threshold, size_t *count)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    core_finder f = {state, threshold, tm_new(mesh->elements, sizeof *f.is)};
    uint32_t *core = tm_new(mesh->elements, sizeof *core);
    *count = 0;
    if (f.is && core)
        tm_parallel_runs(mesh->threads, mesh->elements, TM_CHUNK, find_core_chunk, &f);
    for (uint32_t e = 0; f.is && core && e < mesh->elements; e++)
        if (f.is[e])
            core[(*count)++] = e;
    if (!f.is) {
        free(core);
        core = NULL;
    }
    free(f.is);
    return core;
}

/* Where little is bad the mesh around it is enough. */
static tm_status move_part(tm_repair_state *state, const tm_surface *surface,
                           double threshold, tm_repair_effort effort,
                           const uint32_t *core, size_t cores, double worst,
                           tm_error *error)
{
    tm_node_elements around = {0};
    tm_trial trial = {.whole = state, .around = &around};
    tm_status status = tm_node_elements_find(&around, &state->mesh, error);
    if (status == TM_OK)
        status = tm_trial_gather(&trial, core, cores, PART_RINGS, error);
    trial.part.progress = state->progress;
    trial.part.stop = state->stop;
    trial.part.mesh.threads = state->mesh.threads;
    if (status == TM_OK)
        status = move_in(&trial.part, surface, threshold, effort, worst, error);
    if (status == TM_OK)
        tm_trial_commit(&trial);
    tm_trial_free(&trial);
    tm_node_elements_free(&around);
    return status;
}

tm_status tm_repair_move(tm_repair_state *state, const tm_surface *surface,
                         double threshold, tm_repair_effort effort,
                         tm_repair_score *score, tm_error *error)
{
    size_t cores;
    uint32_t *core = find_core(state, fmax(threshold, effort.aim), &cores);
    if (!core)
        return tm_fail_memory(error);
    tm_repair_rest *rest = state->rest;
    const size_t elements = state->mesh.elements + (rest ? rest->elements : 0);
    tm_status status = TM_OK;
    if (cores > 0 && cores < elements / TM_REPAIR_PART_LESS)
        status = move_part(state, surface, threshold, effort, core, cores, score->worst,
                           error);
    else if (cores > 0 && rest)
        status = tm_repair_fail_part(&rest->whole, error);
    else if (cores > 0)
        status = move_in(state, surface, threshold, effort, score->worst, error);
    free(core);
    if (status == TM_OK && cores > 0)
        *score = tm_repair_measure(state, threshold);
    return status;
}
