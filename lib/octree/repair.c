/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair.h"

#include "../base/array.h"
#include "repair_steps.h"

#include <stdlib.h>
#include <string.h>

/* How often nodes are moved, with how much effort, before more octants are split; and how
 * many splits in a row may fail. */
static const unsigned efforts[] = {1, 3};
enum { EFFORTS = sizeof efforts / sizeof *efforts, FAILURES = 2 };

typedef struct {
    tm_repair_state *state;
    tm_surface *surface;
    const tm_repair_options *options;
    tm_repair_report *report;
    size_t elements_at_most;
} repair;

static bool is_done(const tm_repair_score *score)
{
    return score->bad == 0 && score->held == 0;
}

static tm_status visit(const repair *r, unsigned iteration, const uint32_t *bad,
                       size_t count, tm_error *error)
{
    if (!r->options->visit)
        return TM_OK;
    return r->options->visit(r->options->context, iteration, r->state, bad, count, error);
}

/* All that helps without other octants. */
static tm_status mend(const repair *r, tm_repair_state *state, tm_repair_score *score,
                      tm_error *error)
{
    const double t = r->options->threshold;
    tm_status status = TM_OK;
    for (size_t i = 0; i < EFFORTS && status == TM_OK && !is_done(score); i++)
        status = tm_repair_move(state, r->surface, t, t, efforts[i], score, error);
    for (double held = t; status == TM_OK && score->held > 0 && held > 0;) {
        held = held > TM_REPAIR_LEAST ? held / 4 : 0;
        status = tm_repair_move(state, r->surface, t, held, 1, score, error);
    }
    if (status == TM_OK && score->bad > 0)
        status = tm_repair_tips(state, r->surface, t, score, &r->report->tips, error);
    if (status == TM_OK && score->bad > 0)
        status = tm_repair_divide(state, r->surface, t, score, &r->report->divided, error);
    return status;
}

static void replace(tm_repair_state *state, tm_repair_state *by)
{
    tm_repair_state_free(state);
    *state = *by;
    *by = (tm_repair_state){0};
}

/* Splits octants and keeps what that makes if it is better. */
static tm_status refine(const repair *r, const uint32_t *octant, size_t count,
                        tm_repair_score *score, bool *better, tm_error *error)
{
    tm_repair_state made = {0};
    *better = false;
    tm_status status =
        tm_repair_remake(&made, r->state, r->surface, octant, count, error);
    if (status == TM_ERROR_INPUT) { /* too deep: there is no such octree */
        tm_repair_state_free(&made);
        return TM_OK;
    }
    if (status == TM_OK && made.mesh.elements <= r->elements_at_most) {
        tm_repair_score now = tm_repair_measure(&made, r->options->threshold);
        status = mend(r, &made, &now, error);
        *better = status == TM_OK && tm_repair_better(&now, score);
        if (*better) {
            *score = now;
            replace(r->state, &made);
        }
    }
    tm_repair_state_free(&made);
    return status;
}

static tm_status run_full(const repair *r, tm_error *error)
{
    const tm_repair_options *o = r->options;
    tm_repair_score *score = &r->report->after;
    tm_status status = is_done(score) ? TM_OK : mend(r, r->state, score, error);
    unsigned failures = 0;
    for (unsigned i = 0; status == TM_OK; i++) {
        uint32_t *octant;
        size_t count;
        bool better = false;
        status = tm_repair_bad_octants(r->state, o->threshold, true, &octant, &count, error);
        if (status == TM_OK)
            status = visit(r, i, octant, count, error);
        const bool more = count > 0 && r->state->octree.leaves > 0 && i < o->iterations &&
                          failures < FAILURES;
        if (status == TM_OK && more) {
            r->report->iterations++;
            status = refine(r, octant, count, score, &better, error);
            failures = better ? 0 : FAILURES;
        }
        free(octant);
        if (!more)
            break;
    }
    return status;
}

/* The loop of the thesis: there is no best state, the last one counts. */
static tm_status run_refine(const repair *r, tm_error *error)
{
    const tm_repair_options *o = r->options;
    tm_status status = TM_OK;
    for (unsigned i = 0; status == TM_OK; i++) {
        uint32_t *octant;
        size_t count;
        tm_repair_state made = {0};
        status = tm_repair_bad_octants(r->state, o->threshold, false, &octant, &count, error);
        if (status == TM_OK)
            status = visit(r, i, octant, count, error);
        const bool more = count > 0 && i < o->iterations;
        if (status == TM_OK && more) {
            r->report->iterations++;
            status = tm_repair_remake(&made, r->state, r->surface, octant, count, error);
        }
        if (status == TM_OK && more)
            replace(r->state, &made);
        tm_repair_state_free(&made);
        free(octant);
        if (!more)
            break;
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
    const repair r = {.state = state,
                      .surface = surface,
                      .options = options,
                      .report = report,
                      .elements_at_most =
                          (size_t)(options->growth * (double)state->mesh.elements)};
    if (options->method == TM_REPAIR_FULL)
        return run_full(&r, error);
    if (state->octree.leaves == 0)
        return tm_fail(error, TM_ERROR_INPUT, "there are no octants to refine");
    return run_refine(&r, error);
}
