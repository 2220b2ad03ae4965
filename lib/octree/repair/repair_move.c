/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../../optimise/optimise_surface.h"

#include <math.h>
#include <stdlib.h>

/* How often elements that are not certified are worked on, and how much better their
 * corners have to be each time. */
enum { ROUNDS = 3 };
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
        status = tm_repair_take_back(m->state, &before, threshold, score->least, error);
    if (status == TM_OK && changed)
        *score = tm_repair_measure(m->state, threshold);
    tm_repair_points_free(&before);
    return status;
}

tm_status tm_repair_move(tm_repair_state *state, const tm_surface *surface,
                         double threshold, tm_repair_effort effort,
                         tm_repair_score *score, tm_error *error)
{
    tm_boundary boundary = {0};
    if (surface)
        boundary = tm_boundary_of_surface(surface);
    const double least = fmax(threshold, effort.aim);
    mover m = {
        .state = state,
        .boundary = surface ? &boundary : NULL,
        .thresholds = tm_new(state->mesh.elements, sizeof *m.thresholds),
        .options = {.threshold = least,
                    .off_surface_threshold =
                        effort.share > 0 ? fmax(effort.share * least, TM_REPAIR_FLAT) : 0,
                    .effort = effort.effort,
                    .most_measured = effort.at_least +
                                     effort.measured * (score->bad + score->off_surface),
                    .progress = state->progress,
                    .stop = state->stop}};
    if (!m.thresholds)
        return tm_fail_memory(error);
    m.options.thresholds = m.thresholds;
    tm_status status = move(&m, 1, threshold, score, error);
    m.options.off_surface_threshold = 0;
    if (status == TM_OK && score->invalid > 0)
        status = move(&m, ROUNDS, threshold, score, error);
    free(m.thresholds);
    return status;
}
