/* SPDX-License-Identifier: GPL-3.0-or-later */
/* When the improver tries what. */
#include "improve_engine.h"
#include "improve_ranks.h"

#include "../../base/array.h"
#include "../mesh_set.h"

#include <stdlib.h>
#include <string.h>

/* Prices of a tetrahedron: those at which insertions begin, and of a kick. */
static const double insertion_price = 0.1, kick_price = -1;

/* Passes go on while each leaves this share of the bad tetrahedra less, kicks of all of
 * them too while it is much, and those of one after the other; to converge, this least
 * one. */
static const double enough_gain = 0.05, much_gain = 0.1, least_gain = 0.002;

/* Of what was tried before, so much is tried by kicks of one after the other; where the
 * surface may move and little is left; to converge. */
static const double local_share = 0.6, moving_share = 0.1, converging_share = 2;

/* Where passes leave this share of the tetrahedra, and bad ones, there are too few. */
static const double fewest = 0.5;

/* For few tetrahedra it is cheap to insist. */
static const size_t tries_least = 3000;

/* Tetrahedra of a part of a large mesh. In smaller ones more of all is near to other
 * parts, and waits; larger ones are slower, as their memory is further away. */
enum { PART_TETS = 250000 };

/* Where less is bad, taking parts out costs more than they save. */
static const double part_bad = 0.01;

enum { PASSES_MAX = 8, KICKS_MAX = 1000, ROUNDS_MAX = 4 };

/* Work, see improve_engine.h: of a tetrahedron tried in a phase; by so many that are only
 * looked at. */
static const size_t work_of_try[] = {1, 1, 3}, tets_scanned = 8192;

/* The table of operations, as far as it says when what is tried. */
#define ROW(op, name, key, effect, phase, function)                                      \
    {TM_PHASE_##phase, tm_improve_##function},
static const struct {
    tm_improve_phase phase;
    bool (*try)(tm_improver *m, uint32_t t);
} operation[TM_IMPROVE_OPS] = {TM_IMPROVE_TABLE(ROW)};

/* Whether something begins with the phase. */
static bool has_phase(const tm_improver *m, tm_improve_phase phase)
{
    for (int op = 0; op < TM_IMPROVE_OPS; op++)
        if (operation[op].phase == phase && tm_improve_has(m, (tm_improve_op)op))
            return true;
    return false;
}

bool tm_improve_is_bad(const tm_improver *m, uint32_t t)
{
    return tm_tet_lives(m->mesh, t) && m->quality[t] < m->cost.target &&
           tm_tet_is_in_set(m->mesh, t);
}

size_t tm_improve_count_bad(const tm_improver *m)
{
    size_t bad = 0;
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        bad += tm_improve_is_bad(m, t);
    return bad;
}

/* What a tetrahedron costs on the average. */
static double mean_cost(const tm_improver *m)
{
    double sum = 0;
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        if (tm_improve_is_bad(m, t))
            sum += tm_cost_of(&m->cost, m->quality[t]);
    return m->mesh->tets > 0 ? sum / (double)m->mesh->tets : 0;
}

bool tm_improve_is_due(const tm_improver *m, uint32_t t)
{
    const uint32_t *n = m->mesh->tet[t];
    uint32_t tried = m->tried[t];
    return tried == 0 || m->changed[n[0]] > tried || m->changed[n[1]] > tried ||
           m->changed[n[2]] > tried || m->changed[n[3]] > tried;
}

bool tm_improve_find_targets(tm_improver *m, bool all)
{
    const tm_tet_mesh *mesh = m->mesh;
    size_t bad = tm_improve_count_bad(m), count = 0;
    tm_curve_point *placed = tm_new(bad, sizeof *placed);
    uint32_t *target = tm_grow(m->target, &m->target_room, bad + 1, sizeof *target);
    m->target = target ? target : m->target;
    for (uint32_t t = 0; t < mesh->slots && placed; t++)
        if (tm_improve_is_bad(m, t) && (all || tm_improve_is_due(m, t)))
            placed[count++] = (tm_curve_point){
                tm_space_position(&m->space, mesh->xyz[mesh->tet[t][0]]), t};
    bool done = placed && target && tm_space_sort(placed, count, 1);
    for (size_t k = 0; k < count && done; k++)
        target[k] = placed[k].item;
    m->targets = count;
    m->at.bad = bad;
    free(placed);
    return done || tm_improve_no_memory(m);
}

bool tm_improve_try(tm_improver *m, uint32_t t, tm_improve_phase phase)
{
    bool (*tried)(tm_improver *, uint32_t) = NULL;
    m->tries++;
    for (int op = 0; op < TM_IMPROVE_OPS; op++) {
        if (operation[op].phase > phase || operation[op].try == tried ||
            !tm_improve_has(m, (tm_improve_op)op))
            continue;
        tried = operation[op].try;
        if (tried(m, t))
            return true;
    }
    return false;
}

bool tm_improve_is_over(const tm_improver *m)
{
    return m->status != TM_OK || m->work >= m->work_most ||
           (m->options->passes > 0 && m->report->passes >= m->options->passes);
}

/* A pass begins. Of bad tetrahedra it is told how many the result has, if there were no
 * more. */
void tm_improve_tell_pass(tm_improver *m)
{
    tm_progress_at *at = &m->at;
    at->pass = m->report->passes + 1;
    at->of = m->targets;
    at->bad = m->best.bad < at->bad ? m->best.bad : at->bad;
    at->all_bad = at->bad > at->all_bad ? at->bad : at->all_bad;
}

/* Tries all bad tetrahedra once. */
static void run_pass(tm_improver *m, tm_improve_phase phase)
{
    if (tm_improve_is_over(m) || !tm_improve_find_targets(m, false))
        return;
    if (m->thrifty)
        m->mean = mean_cost(m);
    tm_improve_tell_pass(m);
    for (size_t k = 0; k < m->targets && m->status == TM_OK; k++) {
        uint32_t t = m->target[k];
        tm_progress_step(m->options->progress, &m->at, k);
        if (tm_improve_is_bad(m, t) && tm_improve_is_due(m, t) &&
            !tm_improve_try(m, t, phase))
            m->tried[t] = m->change + 1;
    }
    m->report->passes++;
    m->work += m->targets * work_of_try[phase] + m->mesh->slots / tets_scanned;
}

/* Whether that is enough less than before. */
static bool is_gain(double before, double after, double share)
{
    return after < (1 - share) * before;
}

double tm_improve_badness(const tm_improver *m, size_t tets, size_t bad)
{
    return tets > 0 ? (double)bad * fmax(1, (double)m->full_size / (double)tets) : 0;
}

static double badness_of(const tm_improver *m, size_t bad)
{
    return tm_improve_badness(m, m->mesh->tets, bad);
}

double tm_improve_mesh_badness(const tm_improver *m)
{
    return badness_of(m, tm_improve_count_bad(m));
}

/* Whether a pass took away the good: it left fewer tetrahedra than there were, and these
 * cost more on the average, or are few. */
static bool is_emptied(const tm_improver *m, size_t tets, double mean)
{
    double left = (double)m->mesh->tets, now = mean_cost(m);
    return left < (double)tets &&
           (now > mean || (now > 0 && left < fewest * (double)m->full_size));
}

/* A pass. Where it takes away the good, it is undone, and tetrahedra are worth something
 * from then on. */
static void run_thrifty_pass(tm_improver *m, tm_improve_phase phase)
{
    size_t tets = m->mesh->tets;
    bool watched = phase > TM_PHASE_MOVE && !m->thrifty;
    double mean = watched ? mean_cost(m) : 0;
    if (watched)
        tm_improve_snapshot(m, &m->earlier, tm_improve_count_bad(m), 0);
    run_pass(m, phase);
    if (!watched || !is_emptied(m, tets, mean))
        return;
    tm_improve_restore(m, &m->earlier);
    m->thrifty = true;
    run_pass(m, phase);
}

/* Passes until one gains too little. */
static void settle(tm_improver *m, tm_improve_phase phase, double price)
{
    double before, after = tm_improve_mesh_badness(m);
    tm_improve_set_price(m, price);
    for (int k = 0; k < PASSES_MAX && after > 0 && !tm_improve_is_over(m); k++) {
        before = after;
        run_thrifty_pass(m, phase);
        after = tm_improve_mesh_badness(m);
        if (!is_gain(before, after, enough_gain))
            break;
    }
}

static void contract_all(tm_improver *m)
{
    for (uint32_t v = 0; v < m->mesh->nodes; v++) {
        if (m->mesh->tets <= m->most_tets || m->status != TM_OK)
            return;
        if (tm_node_lives(m->mesh, v) && m->tet_at[v] != TM_NONE)
            tm_improve_contract_node(m, m->tet_at[v], v);
    }
}

void tm_improve_shrink(tm_improver *m, int doublings, bool passes)
{
    double price = insertion_price;
    for (int k = 0; k < doublings; k++, price *= 2) {
        if (m->mesh->tets <= m->most_tets || !tm_improve_has(m, TM_OP_CONTRACTION))
            return;
        tm_improve_set_price(m, price);
        contract_all(m);
        if (passes)
            run_pass(m, TM_PHASE_SHRINK);
    }
}

/* Makes the mesh as small as is asked for. */
static void coarsen(tm_improver *m)
{
    enum { DOUBLINGS = 14 };
    tm_improve_shrink(m, DOUBLINGS, true);
    settle(m, TM_PHASE_SHRINK, 0);
}

bool tm_improve_keeps_angles(const tm_improver *m)
{
    return m->cost.measure == TM_MEASURE_DIHEDRAL ||
           badness_of(m, tm_improve_count_bad_angles(m->mesh, m->options->angle)) <=
               m->angle_badness;
}

/* Keeps the mesh if it is the best so far, or goes back to that. Returns how bad it is.
 */
static double snapshot_best(tm_improver *m)
{
    bool is_first = m->best.bad == SIZE_MAX;
    size_t bad = tm_improve_count_bad(m);
    double badness = badness_of(m, bad);
    if (is_first || (badness < m->best.badness && tm_improve_keeps_angles(m)))
        tm_improve_snapshot(m, &m->best, bad, badness);
    else if (badness > m->best.badness || !tm_improve_keeps_angles(m))
        tm_improve_restore(m, &m->best);
    return m->best.badness;
}

/* Passes at a price per tetrahedron below 0: operations that add some are then done
 * although nothing else gets better; and after each what is good for the mesh again. As
 * long as that leaves much less bad. */
static void kick(tm_improver *m)
{
    double before, after = snapshot_best(m);
    for (int k = 0; k < KICKS_MAX && after > 0 && !tm_improve_is_over(m); k++) {
        before = after;
        tm_improve_set_price(m, kick_price);
        run_pass(m, TM_PHASE_ALL);
        settle(m, TM_PHASE_MOVE, 0);
        settle(m, TM_PHASE_ALL, 0);
        after = snapshot_best(m);
        m->report->kicks++;
        if (!is_gain(before, after, much_gain))
            return;
    }
}

/* The same around one bad tetrahedron after the other. */
static void kick_locally(tm_improver *m)
{
    double share = m->options->converge   ? converging_share
                   : m->features.may_move ? moving_share
                                          : local_share;
    if (m->best.bad > 0)
        tm_improve_kick_locally(m, m->options->converge ? least_gain : enough_gain,
                                tries_least + (size_t)(share * (double)m->tries));
}

/* Everything for one target. */
static void reach(tm_improver *m)
{
    m->best.bad = SIZE_MAX;
    if (m->mesh->tets <= m->most_tets)
        snapshot_best(m);
    settle(m, TM_PHASE_MOVE, 0);
    settle(m, TM_PHASE_SHRINK, 0);
    if (m->mesh->tets > m->most_tets)
        coarsen(m);
    if (has_phase(m, TM_PHASE_ALL)) {
        settle(m, TM_PHASE_ALL, insertion_price);
        settle(m, TM_PHASE_ALL, 0);
        kick(m);
        kick_locally(m);
    }
    snapshot_best(m);
}

/* Targets above the first one, step by step, as long as nothing is left behind; then the
 * last one, without giving up what was reached. */
static void climb(tm_improver *m, double first, double last)
{
    const double step = 1;
    double reached = first;
    while (reached < last && tm_improve_count_bad(m) == 0 && !tm_improve_is_over(m)) {
        double degrees = fmin(reached + step, last);
        tm_improve_snapshot(m, &m->reached, 0, 0);
        tm_improve_set_target(m, degrees);
        reach(m);
        if (tm_improve_count_bad(m) > 0) {
            tm_improve_restore(m, &m->reached);
            tm_improve_forbid(m, reached);
            break;
        }
        reached = degrees;
    }
    if (reached == last)
        return;
    tm_improve_set_target(m, last);
    reach(m);
}

/* The target; one above 30 degrees in steps. */
static void run(tm_improver *m)
{
    const double first = 30, last = m->options->angle;
    m->input.bad = SIZE_MAX;
    if (m->mesh->tets <= m->most_tets && (first < last || tm_improve_is_mostly_bad(m)))
        tm_improve_keep(m, &m->input);
    tm_improve_set_target(m, fmin(first, last));
    reach(m);
    if (first >= last)
        return;
    climb(m, first, last);
    tm_improve_set_target(m, last);
    if (m->input.bad != SIZE_MAX && tm_improve_mesh_badness(m) > m->input.badness)
        tm_improve_restore(m, &m->input);
}

/* Everything; to converge, that once more from where enough was gained, so that the worst
 * ones are seen to while there are others to gain from. */
static void run_all(tm_improver *m)
{
    const tm_improve_options *options = m->options;
    tm_improve_options first = *options;
    first.converge = false;
    m->options = &first;
    run(m);
    for (int k = 0; k < ROUNDS_MAX && tm_improve_stuck(m, run, reach); k++)
        run(m);
    tm_improve_worst(m, reach);
    m->options = options;
    if (!options->converge || tm_improve_is_over(m))
        return;
    tm_improve_set_target(m, options->angle);
    reach(m);
    tm_improve_worst(m, reach);
}

static void run_at_most(tm_improver *m, size_t most, size_t bad)
{
    const size_t tets = m->mesh->tets;
    m->most_tets = most;
    m->full_size = tets < most ? tets : most;
    m->angle_badness = tets <= most ? badness_of(m, bad) : HUGE_VAL;
    run_all(m);
}

/* A mesh that has to become smaller becomes so, too, by what makes it better. Only where
 * that was not enough it is coarsened, from there on; or, where what is good by then does
 * not give way, as it was before. */
static void run_within_growth(tm_improver *m, size_t bad)
{
    const size_t most = m->most_tets;
    const bool shrinks = m->mesh->tets > most;
    const tm_angle_limits limits = m->cost.limits;
    if (shrinks) {
        tm_improve_keep(m, &m->whole);
        run_at_most(m, SIZE_MAX, bad);
        m->cost.limits = limits;
    }
    if (!shrinks || m->mesh->tets > most)
        run_at_most(m, most, bad);
    if (shrinks && m->mesh->tets > most) {
        tm_improve_restore(m, &m->whole);
        m->cost.limits = limits;
        run_at_most(m, most, bad);
    }
    m->most_tets = most;
}

/* *distance is how far the surface has moved. */
static tm_status improve_once(tm_tet_mesh *mesh, const tm_improve_options *options,
                              tm_improve_report *report, double *distance,
                              tm_error *error)
{
    *distance = 0;
    tm_improver *m = malloc(sizeof *m);
    if (!m)
        return tm_fail_memory(error);
    tm_status status = tm_improve_start(m, mesh, options, report, error);
    if (status == TM_OK) {
        report->bad_before = tm_improve_count_bad_angles(m->mesh, m->options->angle);
        run_within_growth(m, report->bad_before);
        status = m->status;
        report->bad_after = tm_improve_count_bad_angles(m->mesh, m->options->angle);
        report->too_large = mesh->tets > m->most_tets;
        if (status == TM_OK && m->features.may_move)
            status = tm_envelope_measure(&m->features.envelope, mesh, distance, error);
    }
    tm_improve_finish(m);
    free(m);
    return status;
}

static tm_status improve_whole(tm_tet_mesh *mesh, const tm_improve_options *options,
                               tm_improve_report *report, tm_error *error)
{
    enum { TRIES = 3 };
    const double most = options->surface.tolerance, rounding = 1e-9, less = 0.5;
    tm_improve_options now = *options;
    tm_tet_mesh input = {0};
    double distance;
    tm_status status = TM_OK;
    if (most > 0)
        status = tm_tet_mesh_copy(&input, mesh, error);
    /* Where the surface was left behind after all, again with less, at last none. */
    for (int k = 0; status == TM_OK; k++) {
        status = improve_once(mesh, &now, report, &distance, error);
        if (status != TM_OK || distance <= most * (1 + rounding))
            break;
        now.surface.tolerance = k + 1 < TRIES ? less * now.surface.tolerance : 0;
        status = tm_tet_mesh_copy(mesh, &input, error);
    }
    tm_tet_mesh_free(&input);
    return status;
}

const tm_improve_cut tm_improve_usual_cut = {PART_TETS, improve_whole};

bool tm_improve_cuts(const tm_improve_options *options, size_t tets, size_t bad)
{
    const bool shrinks = options->max_growth > 0 && options->max_growth < 1;
    return tets >= 2 * (size_t)PART_TETS && options->surface.tolerance == 0 && !shrinks &&
           (double)bad >= part_bad * (double)tets;
}

/* Whether a mesh is so large that it is cut. One whose surface may move is not, nor one
 * with a set, nor one that is to become smaller, nor one that is good nearly all over. */
static bool is_for_parts(const tm_tet_mesh *mesh, const tm_improve_options *options)
{
    return !mesh->has_set && mesh->dangling == 0 &&
           tm_improve_cuts(options, mesh->tets, mesh->tets) &&
           tm_improve_cuts(options, mesh->tets,
                           tm_improve_count_bad_angles(mesh, options->angle));
}

tm_status tm_improve(tm_tet_mesh *mesh, const tm_improve_options *options,
                     tm_improve_report *report, tm_error *error)
{
    const tm_improve_cut *cut = &tm_improve_usual_cut;
    if (is_for_parts(mesh, options))
        return tm_improve_parts(mesh, options, cut->size, cut->engine, report, error);
    return improve_whole(mesh, options, report, error);
}
