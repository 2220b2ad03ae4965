/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../../optimise/optimise_surface.h"

#include <math.h>
#include <stdlib.h>

/* How often elements that became uncertified are worked on, and how much better their
 * corners have to be. */
enum { ROUNDS = 3 };
static const double certified_step = 0.05;

/* What each element has to be: an element that is not certified has to be better than it
 * is. */
static void set_thresholds(const tm_repair_state *state, double threshold, double *to)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    const double least = fmax(threshold, TM_REPAIR_LEAST);
    for (size_t e = 0; e < mesh->elements; e++) {
        const double jens = tm_mixed_jens(mesh, e);
        const bool uncertified = jens >= least && tm_repair_is_bad(mesh, e, jens, 0);
        to[e] = uncertified ? jens + certified_step : least;
    }
}

static tm_status move(tm_repair_state *state, const tm_boundary *boundary,
                      const tm_optimise_options *options, tm_error *error)
{
    tm_optimise_report report;
    return tm_mixed_optimise(&state->mesh, state->rule, boundary, options, &report,
                             error);
}

tm_status tm_repair_move(tm_repair_state *state, const tm_surface *surface,
                         double threshold, double off_surface_threshold, unsigned effort,
                         tm_repair_score *score, tm_error *error)
{
    tm_boundary boundary = {0};
    if (surface)
        boundary = tm_boundary_of_surface(surface);
    tm_repair_points best = {0};
    double *thresholds = tm_new(state->mesh.elements, sizeof *thresholds);
    tm_status status =
        thresholds ? tm_repair_save(&best, state, error) : tm_fail_memory(error);
    tm_optimise_options options = {.thresholds = thresholds,
                                   .threshold = threshold,
                                   .off_surface_threshold =
                                       fmax(off_surface_threshold, TM_REPAIR_LEAST),
                                   .effort = effort,
                                   .progress = state->progress};
    bool is_best = true;
    for (int round = 0; status == TM_OK && round < ROUNDS; round++) {
        set_thresholds(state, threshold, thresholds);
        status = move(state, surface ? &boundary : NULL, &options, error);
        if (status != TM_OK)
            break;
        const tm_repair_score now = tm_repair_measure(state, threshold);
        is_best = tm_repair_better(&now, score);
        if (is_best) {
            *score = now;
            tm_repair_points_free(&best);
            status = tm_repair_save(&best, state, error);
        }
        if (now.invalid == 0)
            break;
    }
    if (status == TM_OK && !is_best)
        tm_repair_restore(&best, state);
    tm_repair_points_free(&best);
    free(thresholds);
    return status;
}
