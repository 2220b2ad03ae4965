/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's reconnections: a cavity around a bad tetrahedron gets the cheapest of
 * all tetrahedralisations that its nodes have. */
#include "improve_engine.h"

#include <string.h>

/* Cavities of at most so many faces are tried, one after the other; and the steps of a
 * search. */
static const size_t stage[] = {12, 18, 26};
enum { STAGES = sizeof stage / sizeof stage[0], STEPS_MOST = 300 };

/* Marks the nodes of t; how many were not marked. */
static int mark_nodes(tm_improver *m, uint32_t t)
{
    int fresh = 0;
    for (int i = 0; i < 4; i++)
        fresh += tm_tet_mark(&m->seen, m->mesh->tet[t][i]);
    return fresh;
}

static bool has_all_nodes(const tm_improver *m, uint32_t t)
{
    for (int i = 0; i < 4; i++)
        if (!tm_tet_is_marked(&m->seen, m->mesh->tet[t][i]))
            return false;
    return true;
}

/* The tetrahedron to be added next: one that adds no node, or a bad one. */
static uint32_t next_of(const tm_improver *m)
{
    uint32_t best = TM_NONE;
    double least = HUGE_VAL;
    for (size_t f = 0; f < m->cavity.faces; f++) {
        uint32_t beyond = m->cavity.beyond[f];
        if (beyond & TM_FACE_BIT)
            continue;
        double value = m->quality[beyond / 4] + !has_all_nodes(m, beyond / 4);
        if (value >= least)
            continue;
        least = value;
        best = beyond / 4;
    }
    return best;
}

/* Adds tetrahedra while the cavity has fewer faces than that; whether any was. */
static bool grow(tm_improver *m, size_t faces)
{
    bool any = false;
    while (m->cavity.faces < faces) {
        uint32_t t = next_of(m);
        if (t == TM_NONE)
            break;
        mark_nodes(m, t);
        if (!tm_cavity_add(&m->cavity, m->mesh, &m->marks, t))
            return tm_improve_no_memory(m);
        any = true;
    }
    return any;
}

/* Lists what was found in m->node, and in m->swallowed the nodes that are left out; false
 * where one of those has to stay. */
static bool list_found(tm_improver *m, size_t *swallowed)
{
    const tm_cavity_search *s = &m->search;
    uint32_t used = 0;
    *swallowed = 0;
    for (size_t k = 0; k < s->tets; k++)
        for (int i = 0; i < 4; i++) {
            m->node[k][i] = s->label[s->tet[k][i]];
            used |= (uint32_t)1 << s->tet[k][i];
        }
    for (size_t i = s->outer_nodes; i < s->nodes; i++) {
        if (used >> i & 1)
            continue;
        if (m->features.dimension[s->label[i]] != 3)
            return false;
        m->swallowed[(*swallowed)++] = s->label[i];
    }
    return true;
}

/* Fills the cavity as it was found. */
static bool fill(tm_improver *m)
{
    const tm_cavity_search *s = &m->search;
    size_t swallowed;
    if (!tm_improve_may_grow(m, (ptrdiff_t)s->tets - (ptrdiff_t)m->cavity.size) ||
        tm_improve_has_marked_edge(m) ||
        !tm_improve_reserve(m, s->tets + m->cavity.size, 0) || !list_found(m, &swallowed))
        return false;
    tm_replacement what = {.old = m->cavity.tet,
                           .old_count = m->cavity.size,
                           .node = (const uint32_t(*)[4])m->node,
                           .count = s->tets,
                           .created = m->created};
    m->status = tm_tet_replace(m->mesh, &what, &m->table, m->error);
    if (m->status != TM_OK)
        return false;
    for (size_t k = 0; k < swallowed; k++)
        tm_tet_mesh_delete_node(m->mesh, m->swallowed[k]);
    tm_improve_note(m, m->created, what.count);
    m->report->done.swallowed += swallowed;
    m->report->done.op[TM_OP_RECONNECTION]++;
    return true;
}

/* Looks for something cheaper than what is in the cavity. */
static bool is_better(tm_improver *m)
{
    double least;
    double old = tm_improve_old_cost(m, m->cavity.tet, m->cavity.size, &least);
    return tm_cavity_search_load(&m->search, m->mesh, &m->cavity) &&
           tm_cavity_search_run(&m->search, &m->cost, least, old - TM_IMPROVE_GAIN,
                                STEPS_MOST);
}

bool tm_improve_reconnect(tm_improver *m, uint32_t t)
{
    m->report->tried[TM_OP_RECONNECTION]++;
    if (!tm_cavity_start(&m->cavity, m->mesh, &m->marks) ||
        !tm_tet_marks_clear(&m->seen, m->mesh->nodes) ||
        !tm_cavity_add(&m->cavity, m->mesh, &m->marks, t))
        return tm_improve_no_memory(m);
    mark_nodes(m, t);
    for (size_t k = 0; k < STAGES && m->status == TM_OK; k++)
        if (grow(m, stage[k]) && is_better(m))
            return fill(m);
    return false;
}
