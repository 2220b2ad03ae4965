/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair.h"

#include "../../base/array.h"
#include "repair_shape.h"
#include "repair_steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* With how much effort nodes are moved, one after the other; what is bad after three is
 * left. */
static const tm_repair_effort efforts[] = {{0, TM_REPAIR_GOOD, 1, 3000, 1000000},
                                           {1, TM_REPAIR_GOOD, 0x1p-2, 6000, 1000000},
                                           {3, TM_REPAIR_GOOD, 0x1p-4, 12000, 1000000}};
enum { EFFORTS = sizeof efforts / sizeof *efforts };

/* Meshes made of split octants have so many elements all in all, or a large one is made
 * once; and no more are made after so many that were not better. */
enum { REMADE_MOST = 300000, FAILURES = 2 };

/* A mesh that has so many times the nodes off the surface after the first effort that
 * another one has, and some, will not be better than that. */
enum { HELD_TIMES = 2, HELD_MORE = 10 };

/* What became of a step. */
typedef enum { NOT_BETTER, BETTER, TOO_LARGE } outcome;

typedef struct {
    tm_repair_state *state;
    tm_surface *surface;
    const tm_repair_options *options;
    tm_repair_report *report;
    size_t elements_at_most;
    size_t remade, remade_at_most; /* elements */
} repair;

static bool is_done(const tm_repair_score *score)
{
    return score->bad == 0 && score->off_surface == 0;
}

static bool is_stopped(const repair *r)
{
    return tm_stop_is_wanted(r->options->stop);
}

/* Makes elements valid, whatever the threshold is: nothing else moves for it. */
static tm_status make_valid(const repair *r, tm_repair_state *state, tm_error *error)
{
    tm_repair_score score = tm_repair_measure(state, 0);
    tm_status status = TM_OK;
    for (size_t i = 0; i < EFFORTS && status == TM_OK && score.invalid > 0; i++) {
        tm_repair_effort effort = efforts[i];
        effort.share = 0;
        status = tm_repair_move(state, r->surface, 0, effort, &score, error);
    }
    if (status == TM_OK && score.invalid > 0 && !is_stopped(r))
        status =
            tm_repair_divide(state, r->surface, 0, &score, &r->report->divided, error);
    return status;
}

/* Makes elements anew at tips, if that keeps the shape and there is room. */
static tm_status make_tips(const repair *r, tm_repair_state *state, double threshold,
                           tm_repair_score *score, tm_error *error)
{
    tm_repair_state before = {0};
    tm_repair_shape was, is;
    size_t *count = &r->report->corners, old = *count;
    bool keeps = true;
    tm_status status = tm_repair_copy_mesh(&before, state, error);
    if (status == TM_OK)
        status =
            tm_repair_sharp_corners(state, r->surface, threshold, score, count, error);
    const bool made = status == TM_OK && *count > old;
    if (made && state->rest)
        status = tm_repair_fail_part(&state->rest->whole, error);
    if (status == TM_OK && made && r->surface) {
        status = tm_repair_shape_measure(&was, &before, r->surface, error);
        if (status == TM_OK)
            status = tm_repair_shape_measure(&is, state, r->surface, error);
        keeps = status == TM_OK && tm_repair_shape_keeps(&is, &was, r->surface);
    }
    if (status == TM_OK && made &&
        (!keeps || state->mesh.elements > r->elements_at_most)) {
        tm_repair_take_mesh(state, &before);
        *score = tm_repair_measure(state, threshold);
        *count = old;
    }
    tm_repair_state_free(&before);
    return status;
}

/* Makes elements anew at tips, and divides elements: those that are bad, and where nodes
 * are off the surface all that are not good, to make room. */
static tm_status make_others(const repair *r, tm_repair_state *state, double threshold,
                             bool tips, tm_repair_score *score, tm_error *error)
{
    const double to =
        score->off_surface > 0 ? fmax(threshold, TM_REPAIR_GOOD) : threshold;
    tm_status status = TM_OK;
    *score = tm_repair_measure(state, to);
    if (score->bad > 0 && tips && !is_stopped(r))
        status = make_tips(r, state, to, score, error);
    if (status == TM_OK && score->bad > 0 && !is_stopped(r))
        status =
            tm_repair_divide(state, r->surface, to, score, &r->report->divided, error);
    *score = tm_repair_measure(state, threshold);
    return status;
}

/* All that helps without other octants, for a threshold; less of it once there are more
 * than `held` nodes off the surface all the same. */
static tm_status mend_to(const repair *r, tm_repair_state *state, double threshold,
                         size_t held, tm_repair_score *score, tm_error *error)
{
    tm_status status = TM_OK;
    if (score->invalid > 0) {
        status = make_valid(r, state, error);
        *score = tm_repair_measure(state, threshold);
    }
    for (size_t i = 0;
         i < EFFORTS && status == TM_OK && !is_done(score) && !is_stopped(r); i++) {
        if (i + 1 == EFFORTS)
            tm_repair_free_off_surface(state);
        status = tm_repair_move(state, r->surface, threshold, efforts[i], score, error);
        if (held < SIZE_MAX && score->off_surface / HELD_TIMES > held + HELD_MORE)
            return status;
        if (status == TM_OK && i > 0 && !is_done(score) && score->off_surface <= held)
            status = make_others(r, state, threshold, i == 1 || score->off_surface > 0,
                                 score, error);
    }
    return status;
}

/* The same for the threshold of the options. Where elements are invalid, first all is
 * done that would be without one, so that it never leaves more of them; and before more
 * than what is good is asked for, that is. If in the end nothing is better, it begins
 * again from what there was. */
static tm_status mend(const repair *r, tm_repair_state *state, size_t held,
                      tm_repair_score *score, tm_error *error)
{
    const double t = r->options->threshold, good = fmin(t, TM_REPAIR_GOOD);
    const double stage[] = {score->invalid > 0 ? 0 : good, good, t};
    enum { STAGES = sizeof stage / sizeof *stage };
    if (stage[0] == t)
        return mend_to(r, state, t, held, score, error);
    tm_repair_state before = {0};
    tm_repair_score now = *score;
    tm_status status = tm_repair_copy_mesh(&before, state, error);
    for (size_t i = 0; i < STAGES && status == TM_OK; i++) {
        if (i > 0 && stage[i] == stage[i - 1])
            continue;
        now = tm_repair_measure(state, stage[i]);
        status = mend_to(r, state, stage[i], held, &now, error);
    }
    if (status == TM_OK && !tm_repair_better(&now, score)) {
        tm_repair_take_mesh(state, &before);
        status = mend_to(r, state, t, held, score, error);
    } else {
        *score = now;
    }
    tm_repair_state_free(&before);
    return status;
}

static void replace(tm_repair_state *state, tm_repair_state *by)
{
    tm_repair_state_free(state);
    *state = *by;
    *by = (tm_repair_state){0};
}

/* Whether a state that was made anew is to be kept: also of the surface it has to keep
 * what there was. */
static tm_status compare(const repair *r, const tm_repair_state *made,
                         const tm_repair_score *now, bool *better, tm_error *error)
{
    tm_repair_shape was, is;
    *better = tm_repair_better(now, &r->report->after);
    if (!*better)
        return TM_OK;
    tm_status status = tm_repair_shape_measure(&was, r->state, r->surface, error);
    if (status == TM_OK)
        status = tm_repair_shape_measure(&is, made, r->surface, error);
    *better = status == TM_OK && tm_repair_shape_keeps(&is, &was, r->surface);
    return status;
}

/* Splits octants and keeps what that makes if it is better. *elements is how many it
 * makes. */
static tm_status refine(repair *r, const uint32_t *octant, size_t count, outcome *became,
                        size_t *elements, tm_error *error)
{
    tm_repair_state made = {0};
    *became = NOT_BETTER;
    r->report->iterations++;
    tm_status status =
        tm_repair_remake(&made, r->state, r->surface, octant, count, true, error);
    if (status == TM_ERROR_INPUT) { /* too deep: there is no such octree */
        tm_repair_state_free(&made);
        r->remade = r->remade_at_most;
        return TM_OK;
    }
    *elements = made.mesh.elements;
    r->remade += *elements;
    if (status == TM_OK && *elements > r->elements_at_most)
        *became = TOO_LARGE;
    if (status == TM_OK && *became != TOO_LARGE) {
        bool better;
        tm_repair_score now = tm_repair_measure(&made, r->options->threshold);
        status = mend(r, &made, r->report->after.off_surface, &now, error);
        if (status == TM_OK)
            status = compare(r, &made, &now, &better, error);
        if (status == TM_OK && made.mesh.elements <= r->elements_at_most && better) {
            *became = BETTER;
            r->report->after = now;
            replace(r->state, &made);
        }
    }
    tm_repair_state_free(&made);
    return status;
}

/* Where so much is bad that a small part of it would be all that there is room for, the
 * threshold is too high. */
static bool may_refine(const repair *r)
{
    return 2 * r->report->after.bad + r->state->mesh.elements <= r->elements_at_most &&
           r->report->iterations < r->options->iterations &&
           r->remade + r->state->mesh.elements <= r->remade_at_most && !is_stopped(r);
}

/* Splits some of the octants that hold bad elements, or, where some are not valid, such:
 * all of them, or, in Z order, the first part of them where all are too many. With `wide`
 * also those around them. */
static tm_status refine_some(repair *r, bool wide, bool *better, tm_error *error)
{
    const double share = 0.8; /* of what would just not be too many */
    const size_t old = r->state->mesh.elements;
    uint32_t *octant;
    size_t count, elements = 0;
    outcome became = TOO_LARGE;
    tm_status status = tm_repair_bad_octants(
        r->state, r->report->after.invalid > 0 ? 0 : r->options->threshold,
        r->report->after.invalid == 0, NULL, &octant, &count, error);
    if (status == TM_OK && wide)
        status = tm_repair_widen(r->state, &octant, &count, error);
    while (status == TM_OK && became == TOO_LARGE && count > 0 && may_refine(r)) {
        status = refine(r, octant, count, &became, &elements, error);
        if (status == TM_OK && became == TOO_LARGE)
            count = (size_t)(share * (double)count *
                             ((double)r->elements_at_most - (double)old) /
                             ((double)elements - (double)old));
    }
    *better = became == BETTER;
    free(octant);
    return status;
}

/* Tells the caller of a state; with off_surface its score is known: of one that is done
 * no element has to be measured. */
static tm_status show(const repair *r, bool off_surface, size_t *count, tm_error *error)
{
    uint32_t *octant = NULL;
    tm_status status = TM_OK;
    *count = 0;
    if (!off_surface || !is_done(&r->report->after))
        status = tm_repair_bad_octants(r->state, r->options->threshold, off_surface, NULL,
                                       &octant, count, error);
    if (status == TM_OK && r->options->visit)
        status = r->options->visit(r->options->context, r->report->iterations, r->state,
                                   octant, *count, error);
    free(octant);
    return status;
}

/* What makes fewer elements invalid counts more than the worst J_ENS, but is tried last.
 */
static tm_status make_valid_leniently(const repair *r, tm_error *error)
{
    const double threshold = r->options->threshold;
    tm_repair_state made = {0};
    tm_status status = tm_repair_copy_mesh(&made, r->state, error);
    if (status == TM_OK) {
        made.lenient = true;
        const tm_repair_score before = tm_repair_measure(&made, threshold);
        tm_repair_score now = before;
        status = mend(r, &made, SIZE_MAX, &now, error);
        made.lenient = false;
        if (status == TM_OK && tm_repair_better(&now, &before)) {
            tm_repair_take_mesh(r->state, &made);
            r->report->after = tm_repair_measure(r->state, threshold);
        }
    }
    tm_repair_state_free(&made);
    return status;
}

static tm_status run_full(repair *r, tm_error *error)
{
    tm_repair_score *score = &r->report->after;
    size_t count;
    bool wide = false;
    tm_status status = show(r, true, &count, error);
    if (status == TM_OK && !is_done(score))
        status = mend(r, r->state, SIZE_MAX, score, error);
    for (int failures = 0; status == TM_OK && !is_done(score) &&
                           r->state->octree.leaves > 0 && failures < FAILURES &&
                           may_refine(r);) {
        bool better;
        status = refine_some(r, wide, &better, error);
        if (status == TM_OK && better)
            status = show(r, true, &count, error);
        failures = better ? 0 : failures + 1;
        wide = !better && !wide;
    }
    if (status == TM_OK && score->invalid > 0 && !r->state->rest && !is_stopped(r))
        status = make_valid_leniently(r, error);
    return status;
}

/* Splits octants, whatever that makes of the mesh. */
static tm_status remake(const repair *r, const uint32_t *octant, size_t count,
                        tm_error *error)
{
    tm_repair_state made = {0};
    const tm_status status =
        tm_repair_remake(&made, r->state, r->surface, octant, count, false, error);
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
    while (status == TM_OK && count > 0 && r->report->iterations < o->iterations &&
           !is_stopped(r)) {
        uint32_t *octant;
        status = tm_repair_bad_octants(r->state, o->threshold, false, NULL, &octant,
                                       &count, error);
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
    state->stop = options->stop;
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
    r.remade_at_most =
        state->mesh.elements > REMADE_MOST ? state->mesh.elements : REMADE_MOST;
    return refine ? run_refine(&r, error) : run_full(&r, error);
}
