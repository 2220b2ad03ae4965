/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's last phase: the worst tetrahedra. The target is lowered, so that only
 * they are worked on, by kicks too, and raised again. What is bad after that is tried one
 * by one. */
#include "improve_engine.h"

#include "../../base/array.h"
#include "../mesh_set.h"

#include <stdlib.h>

/* Where more than this share of the tetrahedra is bad, or below a lower target, there are
 * no last ones; so few always are. */
static const double bad_share = 0.05, low_share = 0.005;
enum { FEW = 200 };

/* What all of this may take, by what was done before; and the first part of it. */
static const double share_of_work = 0.45, first_share = 0.6;

/* Lower targets, by the target; the last ones only to converge. */
static const double lower[] = {1. / 6, 2. / 3, 1. / 3, 5. / 6};
enum { LEVELS = 2, LEVELS_TO_CONVERGE = 4, ROUNDS_MAX = 8, PASSES_MAX = 6 };

/* One by one: against one bad tetrahedron more all else counts little, but in cavities of
 * hundreds; what is so many times as good as the worst costs half as much. A try takes
 * longer than one without reconnection. */
static const double last_weight = 0.01, near_worst = 2, never_flat = 1e-3;
enum { WORK_OF_TRY = 12 };

typedef struct {
    double quality;
    uint32_t t;
} bad_tet;

static int compare(const void *a, const void *b)
{
    const bad_tet *p = a, *q = b;
    if (p->quality != q->quality)
        return p->quality < q->quality ? -1 : 1;
    return p->t < q->t ? -1 : p->t > q->t;
}

static bool is_below(const tm_improver *m, uint32_t t, double quality)
{
    return tm_tet_lives(m->mesh, t) && m->quality[t] < quality;
}

/* How many are below, and how bad the worst of all is. */
static size_t count_below(const tm_improver *m, double quality, double *worst)
{
    size_t count = 0;
    *worst = HUGE_VAL;
    for (uint32_t t = 0; t < m->mesh->slots; t++) {
        count += is_below(m, t, quality);
        if (tm_tet_lives(m->mesh, t))
            *worst = fmin(*worst, m->quality[t]);
    }
    return count;
}

/* Whether so many are few enough to be the last ones. */
static bool are_few(const tm_improver *m, size_t count, double share)
{
    return count <= FEW || (double)count <= share * (double)m->mesh->tets;
}

/* Works for a lower target, then for the target again, without more work than that. */
static void lower_and_raise(tm_improver *m, tm_improve_reach *reach, double degrees,
                            size_t work_most)
{
    const double target = m->degrees;
    double worst;
    m->work_most = m->work + (size_t)(first_share * (double)(work_most - m->work));
    tm_improve_set_target(m, degrees);
    reach(m);
    if (count_below(m, m->cost.target, &worst) == 0)
        tm_improve_forbid(m, degrees);
    m->work_most = work_most;
    tm_improve_set_target(m, target);
    reach(m);
}

/* The same; keeps what that does if the worst is better, or fewer are bad, and neither is
 * worse. Whether it was kept. */
static bool raise_worst(tm_improver *m, tm_improve_reach *reach, double degrees,
                        size_t work_most)
{
    const tm_angle_limits limits = m->cost.limits;
    const double low = tm_improve_target(m, degrees);
    double worst, raised;
    size_t bad = count_below(m, m->cost.target, &worst);
    if (m->status != TM_OK || worst >= low || m->work >= work_most)
        return false;
    if (!m->options->converge && !are_few(m, count_below(m, low, &worst), low_share))
        return false;
    const double badness = tm_improve_badness(m, m->mesh->tets, bad);
    tm_improve_snapshot(m, &m->kept, bad, badness);
    lower_and_raise(m, reach, degrees, work_most);
    size_t after = count_below(m, m->cost.target, &raised);
    if (after <= bad && tm_improve_badness(m, m->mesh->tets, after) <= badness &&
        raised >= worst && (after < bad || raised > worst))
        return true;
    tm_improve_restore(m, &m->kept);
    m->cost.limits = limits;
    return false;
}

/* The bad tetrahedra that are targets, the worst first. NULL: no memory. */
static bad_tet *list_bad(tm_improver *m, size_t *count)
{
    double worst;
    size_t bad = count_below(m, m->cost.target, &worst);
    bad_tet *list = tm_new(bad + 1, sizeof *list);
    *count = 0;
    for (uint32_t t = 0; t < m->mesh->slots && list; t++)
        if (is_below(m, t, m->cost.target) && tm_tet_is_in_set(m->mesh, t))
            list[(*count)++] = (bad_tet){m->quality[t], t};
    if (list)
        qsort(list, *count, sizeof *list, compare);
    else
        tm_improve_no_memory(m);
    return list;
}

/* Tries all bad tetrahedra, the worst first; how many operations that were. */
static size_t try_each(tm_improver *m, size_t work_most)
{
    size_t count, done = 0;
    bad_tet *list = list_bad(m, &count);
    for (size_t k = 0; k < count && m->status == TM_OK && m->work < work_most; k++) {
        uint32_t t = list[k].t;
        if (!is_below(m, t, m->cost.target) || m->tried[t] > 0)
            continue;
        m->work += WORK_OF_TRY;
        m->cost.steep = near_worst * sqrt(m->quality[t] / m->cost.target) + never_flat;
        if (tm_improve_try(m, t, TM_PHASE_LAST))
            done++;
        else
            m->tried[t] = m->change + 1;
    }
    free(list);
    m->report->passes++;
    return done;
}

static void try_last(tm_improver *m, size_t work_most)
{
    const tm_cost cost = m->cost;
    const size_t passes = m->options->passes;
    double worst;
    size_t bad = count_below(m, cost.target, &worst);
    tm_improve_snapshot(m, &m->kept, bad, tm_improve_badness(m, m->mesh->tets, bad));
    m->last = true;
    m->cost.weight = last_weight;
    tm_improve_set_target(m, m->degrees);
    for (int k = 0; k < PASSES_MAX && m->status == TM_OK; k++)
        if ((passes > 0 && m->report->passes >= passes) || try_each(m, work_most) == 0)
            break;
    m->cost = cost;
    m->last = false;
    bad = count_below(m, cost.target, &worst);
    if (tm_improve_badness(m, m->mesh->tets, bad) > m->kept.badness)
        tm_improve_restore(m, &m->kept);
}

/* Raises the worst by lower targets, until that fails or for once. */
static void raise_all(tm_improver *m, tm_improve_reach *reach, size_t work_most)
{
    bool converge = m->options->converge, any = true;
    for (int round = 0; round < (converge ? ROUNDS_MAX : 1) && any; round++) {
        any = false;
        for (size_t k = 0; k < (converge ? LEVELS_TO_CONVERGE : LEVELS); k++)
            any |= raise_worst(m, reach, lower[k] * m->degrees, work_most);
    }
    m->work_most = SIZE_MAX;
}

void tm_improve_worst(tm_improver *m, tm_improve_reach *reach)
{
    double worst;
    const tm_improve_options *o = m->options;
    size_t work_most = m->work + (size_t)(share_of_work * (double)m->work);
    if (m->status != TM_OK || (o->passes > 0 && m->report->passes >= o->passes))
        return;
    if (o->ops == 1u << TM_OP_RECONNECTION) {
        try_last(m, SIZE_MAX);
    } else if (are_few(m, count_below(m, m->cost.target, &worst), bad_share)) {
        raise_all(m, reach, work_most);
        try_last(m, work_most);
    }
    count_below(m, m->cost.target, &worst);
    if (m->cost.measure == TM_MEASURE_DIHEDRAL)
        tm_improve_forbid(m, tm_sine2_to_degrees(worst));
}
