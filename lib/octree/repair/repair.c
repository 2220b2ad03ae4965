/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair.h"

#include "../../base/array.h"
#include "repair_steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* With how much effort nodes are moved, one after the other; and by which share of the
 * threshold elements are measured that a node leaves behind that was off the surface. */
static const unsigned efforts[] = {1, 3};
static const double off_surface_shares[] = {0x1p-2,  0x1p-4,  0x1p-6,  0x1p-8, 0x1p-10,
                                            0x1p-12, 0x1p-14, 0x1p-16, 0};
enum {
    EFFORTS = sizeof efforts / sizeof *efforts,
    OFF_SURFACE_SHARES = sizeof off_surface_shares / sizeof *off_surface_shares
};

/* Where so many nodes are off the surface and such a part of them remains so, the octree
 * is too coarse for the surface. */
enum { FEW_OFF_SURFACE = 500 };
static const double hopeless = 0.9;

/* Elements become others only where so many are bad: each costs some milliseconds, and
 * where most are, the threshold is too high. */
enum { FEW_BAD = 400 };

/* What became of a step. */
typedef enum { NOT_BETTER, BETTER, TOO_LARGE } outcome;

typedef struct {
    tm_repair_state *state;
    tm_surface *surface;
    const tm_repair_options *options;
    tm_repair_report *report;
    size_t elements_at_most;
} repair;

static bool is_done(const tm_repair_score *score)
{
    return score->bad == 0 && score->off_surface == 0;
}

/* Brings nodes to the surface that leave elements of such a share of the threshold
 * behind, and nothing below a floor. */
static tm_status bring_some(const repair *r, tm_repair_state *state, double share,
                            double floor, tm_repair_score *score, tm_error *error)
{
    const double t = r->options->threshold;
    const double left = fmax(fmax(share * t, TM_REPAIR_LEAST), floor);
    tm_repair_score from = *score;
    from.floor = fmin(from.floor, left);
    tm_repair_score now = from;
    const tm_status status = tm_repair_move(state, r->surface, t, left, 1, &now, error);
    if (tm_repair_better(&now, &from))
        *score = now;
    return status;
}

static tm_status bring_all(const repair *r, tm_repair_state *state, double floor,
                           tm_repair_score *score, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0;
         i < OFF_SURFACE_SHARES && status == TM_OK && score->off_surface > 0; i++)
        status = bring_some(r, state, off_surface_shares[i], floor, score, error);
    if (status != TM_OK || score->off_surface == 0)
        return status;
    tm_repair_free_off_surface(state);
    return bring_some(r, state, 0, floor, score, error);
}

/* Brings nodes to the surface. Elements that they leave behind may fall below the floor,
 * as they often become better again when the next nodes come; where they do not, all is
 * done again so that they cannot. */
static tm_status bring(const repair *r, tm_repair_state *state, double floor,
                       tm_repair_score *score, tm_error *error)
{
    const tm_repair_score before = *score;
    tm_repair_points points = {0};
    tm_status status = tm_repair_save(&points, state, error);
    if (status == TM_OK)
        status = bring_all(r, state, 0, score, error);
    if (status == TM_OK && score->worst < floor) {
        tm_repair_restore(&points, state);
        *score = before;
        status = bring_all(r, state, floor, score, error);
    }
    tm_repair_points_free(&points);
    return status;
}

/* All that helps without other octants. */
static tm_status mend(const repair *r, tm_repair_state *state, tm_repair_score *score,
                      tm_error *error)
{
    const double t = r->options->threshold;
    tm_status status = TM_OK;
    const size_t off_surface = score->off_surface;
    const double floor = score->floor; /* of all moves together */
    for (size_t i = 0; i < EFFORTS && status == TM_OK && !is_done(score); i++) {
        status = tm_repair_move(state, r->surface, t, t, efforts[i], score, error);
        if (score->off_surface > FEW_OFF_SURFACE &&
            (double)score->off_surface > hopeless * (double)off_surface)
            return status; /* it takes long and leads to nothing */
    }
    if (status == TM_OK && score->off_surface > 0)
        status = bring(r, state, floor, score, error);
    const bool some = score->bad > 0 && score->bad <= FEW_BAD;
    if (status == TM_OK && some)
        status = tm_repair_sharp_corners(state, r->surface, t, score, &r->report->corners,
                                         error);
    if (status == TM_OK && score->bad > 0)
        status =
            tm_repair_divide(state, r->surface, t, score, &r->report->divided, error);
    return status;
}

static void replace(tm_repair_state *state, tm_repair_state *by)
{
    tm_repair_state_free(state);
    *state = *by;
    *by = (tm_repair_state){0};
}

/* Splits octants and keeps what that makes if it is better; *large says that there would
 * be more elements than allowed. */
static tm_status refine(const repair *r, const uint32_t *octant, size_t count,
                        outcome *became, tm_error *error)
{
    tm_repair_state made = {0};
    tm_repair_score *score = &r->report->after;
    *became = NOT_BETTER;
    r->report->iterations++;
    tm_status status =
        tm_repair_remake(&made, r->state, r->surface, octant, count, error);
    if (status == TM_ERROR_INPUT) { /* too deep: there is no such octree */
        tm_repair_state_free(&made);
        return TM_OK;
    }
    if (status == TM_OK && made.mesh.elements > r->elements_at_most)
        *became = TOO_LARGE;
    if (status == TM_OK && *became != TOO_LARGE) {
        tm_repair_score now = tm_repair_measure(&made, r->options->threshold);
        status = mend(r, &made, &now, error);
        if (status == TM_OK && made.mesh.elements <= r->elements_at_most &&
            tm_repair_better(&now, score)) {
            *became = BETTER;
            *score = now;
            replace(r->state, &made);
        }
    }
    tm_repair_state_free(&made);
    return status;
}

/* Splits some of the octants that hold bad elements: all of them, or, in Z order, the
 * first part of them where all are too many. With `wide` also those around them. */
static tm_status refine_some(const repair *r, bool wide, bool *better, tm_error *error)
{
    enum { HALVINGS = 5 };
    const int halvings = r->report->after.off_surface > FEW_OFF_SURFACE ? 1 : HALVINGS;
    uint32_t *octant;
    size_t count;
    outcome became = TOO_LARGE;
    tm_status status = tm_repair_bad_octants(r->state, r->options->threshold, true,
                                             &octant, &count, error);
    if (status == TM_OK && wide)
        status = tm_repair_widen(r->state, &octant, &count, error);
    for (int i = 0; status == TM_OK && became == TOO_LARGE && count > 0 && i < halvings &&
                    r->report->iterations < r->options->iterations;
         i++) {
        status = refine(r, octant, count, &became, error);
        count /= 2;
    }
    *better = became == BETTER;
    free(octant);
    return status;
}

/* Tells the caller of a state. */
static tm_status show(const repair *r, bool off_surface, size_t *count, tm_error *error)
{
    uint32_t *octant;
    tm_status status = tm_repair_bad_octants(r->state, r->options->threshold, off_surface,
                                             &octant, count, error);
    if (status == TM_OK && r->options->visit)
        status = r->options->visit(r->options->context, r->report->iterations, r->state,
                                   octant, *count, error);
    free(octant);
    return status;
}

static tm_status run_full(const repair *r, tm_error *error)
{
    tm_repair_score *score = &r->report->after;
    size_t count;
    tm_status status = show(r, true, &count, error);
    if (status == TM_OK && !is_done(score))
        status = mend(r, r->state, score, error);
    for (bool wide = false; status == TM_OK && !is_done(score) &&
                            r->state->octree.leaves > 0 &&
                            r->report->iterations < r->options->iterations;) {
        bool better;
        status = refine_some(r, wide, &better, error);
        if (status == TM_OK && better)
            status = show(r, true, &count, error);
        if (!better && wide)
            break;
        wide = !better;
    }
    return status;
}

/* Splits octants, whatever that makes of the mesh. */
static tm_status remake(const repair *r, const uint32_t *octant, size_t count,
                        tm_error *error)
{
    tm_repair_state made = {0};
    const tm_status status =
        tm_repair_remake(&made, r->state, r->surface, octant, count, error);
    if (status == TM_OK)
        replace(r->state, &made);
    tm_repair_state_free(&made);
    r->report->iterations++;
    return status;
}

/* The octants that the caller names. */
static tm_status split_given(const repair *r, tm_error *error)
{
    const tm_repair_options *o = r->options;
    tm_status status = TM_OK;
    if (o->visit)
        status = o->visit(o->context, 0, r->state, o->octant, o->octants, error);
    if (status == TM_OK)
        status = remake(r, o->octant, o->octants, error);
    r->report->after = tm_repair_measure(r->state, o->threshold);
    return status;
}

/* The loop of the thesis: there is no best state, the last one counts. */
static tm_status run_refine(const repair *r, tm_error *error)
{
    const tm_repair_options *o = r->options;
    size_t count;
    tm_status status = show(r, false, &count, error);
    while (status == TM_OK && count > 0 && r->report->iterations < o->iterations) {
        uint32_t *octant;
        status =
            tm_repair_bad_octants(r->state, o->threshold, false, &octant, &count, error);
        if (status == TM_OK)
            status = remake(r, octant, count, error);
        free(octant);
        if (status == TM_OK)
            status = show(r, false, &count, error);
    }
    r->report->after = tm_repair_measure(r->state, o->threshold);
    return status;
}

tm_status tm_repair(tm_repair_state *state, tm_surface *surface,
                    const tm_repair_options *options, tm_repair_report *report,
                    tm_error *error)
{
    *report = (tm_repair_report){.before = tm_repair_measure(state, options->threshold)};
    report->after = report->before;
    state->progress = options->progress;
    repair r = {.state = state, .surface = surface, .options = options, .report = report};
    const bool refine = options->method == TM_REPAIR_REFINE;
    if (state->octree.leaves == 0 &&
        ((refine && report->before.bad > 0) || options->octants > 0))
        return tm_fail(error, TM_ERROR_INPUT, "there are no octants to refine");
    if (options->octants > 0) {
        const tm_status status = split_given(&r, error);
        if (status != TM_OK)
            return status;
    }
    r.elements_at_most = (size_t)(options->growth * (double)state->mesh.elements);
    return refine ? run_refine(&r, error) : run_full(&r, error);
}
