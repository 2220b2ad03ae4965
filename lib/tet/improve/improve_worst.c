/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's last phase: the worst tetrahedra, one by one. */
#include "improve_engine.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* Against one bad tetrahedron more all else counts little, but in cavities of hundreds;
 * and of that what is near the worst counts most. */
static const double worst_weight = 0.01, level_above = 2;

enum { PASSES_MAX = 6 };

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

static bool is_bad(const tm_improver *m, uint32_t t)
{
    return tm_tet_lives(m->mesh, t) && m->quality[t] < m->cost.target;
}

/* The bad tetrahedra, the worst first. NULL: no memory. */
static bad_tet *list_bad(tm_improver *m, size_t *count)
{
    size_t bad = 0;
    for (uint32_t t = 0; t < m->mesh->slots; t++)
        bad += is_bad(m, t);
    bad_tet *list = tm_new(bad + 1, sizeof *list);
    *count = 0;
    for (uint32_t t = 0; t < m->mesh->slots && list; t++)
        if (is_bad(m, t))
            list[(*count)++] = (bad_tet){m->quality[t], t};
    if (list)
        qsort(list, *count, sizeof *list, compare);
    else
        tm_improve_no_memory(m);
    return list;
}

/* Tries all bad tetrahedra, the worst first; how many were changed. */
static size_t run_worst(tm_improver *m)
{
    size_t count, done = 0;
    bad_tet *list = list_bad(m, &count);
    for (size_t k = 0; k < count && m->status == TM_OK; k++) {
        uint32_t t = list[k].t;
        if (!is_bad(m, t) || m->quality[t] != list[k].quality || m->tried[t] > 0)
            continue;
        m->cost.steep = level_above * sqrt(m->quality[t] / m->cost.target) + 1e-3;
        if (tm_improve_try(m, t, TM_PHASE_LAST))
            done++;
        else
            m->tried[t] = m->change + 1;
    }
    free(list);
    return done;
}

void tm_improve_worst(tm_improver *m)
{
    tm_cost cost = m->cost;
    if (m->status != TM_OK)
        return;
    m->last = true;
    m->cost.weight = worst_weight;
    memset(m->smoothed, 0, m->mesh->nodes * sizeof *m->smoothed);
    tm_improve_set_price(m, 0);
    for (int k = 0; k < PASSES_MAX && run_worst(m) > 0; k++)
        ;
    m->cost = cost;
    m->last = false;
}
