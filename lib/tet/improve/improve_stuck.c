/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where much of the mesh stays bad, other ways are tried: from the input without moving
 * nodes, which closes ways in thin domains; then with fewer and fewer tetrahedra, as
 * whole layers of a mesh that is too fine in one direction have to go before any one that
 * is left is good. */
#include "improve_engine.h"

#include <math.h>

/* That is where so many were bad, and so many of them are left. */
static const double most_bad = 0.5, much_left = 0.2;

/* Where less was gained than this share, fewer operations will not do more. */
static const double little_gain = 0.1;

/* Fewer tetrahedra are worth it where no more than this share of the bad ones is left,
 * all counted as in the whole mesh. */
static const double enough_less = 0.5;

/* The least angle while they get fewer, in degrees. */
static const double least_angle = 0.5;
enum { DOUBLINGS = 20, HALVINGS = 8 };

static bool is_stuck(const tm_improver *m)
{
    return !tm_improve_is_over(m) &&
           (double)tm_improve_count_bad(m) > much_left * (double)m->mesh->tets;
}

bool tm_improve_is_mostly_bad(const tm_improver *m)
{
    return (double)tm_improve_count_bad(m) > most_bad * (double)m->mesh->tets;
}

/* Whether the input was kept, and what was done with it has helped. */
static bool has_gained(const tm_improver *m)
{
    return m->input.bad != SIZE_MAX &&
           tm_improve_mesh_badness(m) <= (1 - little_gain) * m->input.badness;
}

/* From the input. */
static void without_smoothing(tm_improver *m, tm_improve_reach *run)
{
    const tm_improve_options *all = m->options;
    tm_improve_options some = *all;
    some.ops &= ~(1u << TM_OP_SMOOTHING);
    tm_improve_keep(m, &m->kept);
    tm_improve_restore(m, &m->input);
    m->options = &some;
    m->thrifty = false;
    run(m);
    m->options = all;
    if (tm_improve_mesh_badness(m) > m->kept.badness || !tm_improve_keeps_angles(m))
        tm_improve_restore(m, &m->kept);
}

/* Contracts what it can until half of the tetrahedra are left. */
static void halve(tm_improver *m)
{
    const tm_angle_limits limits = m->cost.limits;
    const size_t most = m->most_tets;
    m->most_tets = m->mesh->tets / 2;
    m->thrifty = false;
    m->cost.limits.least = fmin(limits.least, least_angle);
    tm_improve_shrink(m, DOUBLINGS, false);
    tm_improve_set_price(m, 0);
    m->most_tets = most;
    m->cost.limits = limits;
}

/* Whether no angle is beyond the limits. */
static bool keeps_limits(const tm_improver *m)
{
    const tm_angle_limits limits = m->cost.limits, now = tm_improve_angles(m);
    return now.least >= limits.least - TM_ANGLE_TOLERANCE &&
           now.most <= limits.most + TM_ANGLE_TOLERANCE;
}

/* Goes on with half of the tetrahedra as long as that leaves less bad. */
static void thin_out(tm_improver *m, tm_improve_reach *reach)
{
    const size_t full = m->full_size;
    double best = HUGE_VAL, now = tm_improve_mesh_badness(m);
    tm_improve_keep(m, &m->kept);
    for (int k = 0; k < HALVINGS && now < best && is_stuck(m); k++) {
        best = now;
        halve(m);
        m->full_size = m->mesh->tets;
        reach(m);
        m->full_size = full;
        now = tm_improve_mesh_badness(m);
        if (now <= enough_less * m->kept.badness && keeps_limits(m) &&
            tm_improve_keeps_angles(m))
            tm_improve_keep(m, &m->kept);
    }
    tm_improve_restore(m, &m->kept);
}

bool tm_improve_stuck(tm_improver *m, tm_improve_reach *run, tm_improve_reach *reach)
{
    const double before = tm_improve_mesh_badness(m);
    if (is_stuck(m) && has_gained(m) && tm_improve_has(m, TM_OP_SMOOTHING))
        without_smoothing(m, run);
    if (is_stuck(m) && m->mesh->tets <= m->most_tets &&
        tm_improve_has(m, TM_OP_CONTRACTION))
        thin_out(m, reach);
    return is_stuck(m) && tm_improve_mesh_badness(m) <= (1 - little_gain) * before;
}
