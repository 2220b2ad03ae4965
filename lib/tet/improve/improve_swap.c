/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's swaps: the best removal of an edge or a face of a tetrahedron. */
#include "../operation/peel.h"
#include "improve_engine.h"

#include <string.h>

enum { EDGES = 6, NOTHING = -1 };

/* What is between two constrained faces of a closed star, as an open star. */
static tm_star part_of(const tm_star *star, size_t from, size_t to)
{
    tm_star part = *star;
    part.closed = false;
    part.tet = star->tet + from;
    part.ring = star->ring + from;
    part.size = to - from;
    return part;
}

static void reverse(uint32_t *item, size_t count)
{
    for (size_t i = 0; i < count / 2; i++) {
        uint32_t swap = item[i];
        item[i] = item[count - 1 - i];
        item[count - 1 - i] = swap;
    }
}

/* Turns a closed star so that it begins with ring[by]. */
static void rotate(tm_star *star, size_t by)
{
    uint32_t *list[2] = {star->tet, star->ring};
    for (int k = 0; k < 2; k++) {
        reverse(list[k], by);
        reverse(list[k] + by, star->size - by);
        reverse(list[k], star->size);
    }
    star->ring[star->size] = star->ring[0];
}

/* Takes the star of an edge apart into what is retriangulated by itself: all of it for an
 * edge inside, what is on each side for one in a flat facet. Returns how many parts; 0
 * where the edge has to stay. */
static int take_apart(tm_improver *m, tm_star part[2])
{
    tm_star *star = &m->star;
    size_t constrained[2];
    tm_edge_class place = tm_features_classify(&m->features, m->mesh, star, constrained);
    if (place == TM_EDGE_OF_FEATURE ||
        !tm_improve_has(m, place == TM_EDGE_INSIDE ? TM_OP_EDGE_REMOVAL
                                                   : TM_OP_BOUNDARY_SWAP) ||
        tm_edge_map_get(&m->mesh->locked, star->a, star->b) ||
        !tm_star_is_simple(m->mesh, star) || star->size >= TM_REMOVAL_MAX)
        return 0;
    const size_t least = m->features.may_move ? 1 : 2; /* one alone is peeled off */
    part[0] = *star;
    if (place == TM_EDGE_INSIDE)
        return star->size >= 3;
    if (!star->closed)
        return star->size >= least;
    size_t other = constrained[1] - constrained[0];
    rotate(star, constrained[0]);
    part[0] = part_of(star, 0, other);
    part[1] = part_of(star, other, star->size);
    return part[0].size >= least && part[1].size >= least ? 2 : 0;
}

/* How many tetrahedra a part becomes. */
static size_t becomes(const tm_star *part)
{
    return 2 * (part->size + !part->closed) - 4;
}

/* Plans the removal of edge e of t in m->removal. Returns the gain if that is above
 * `needed`, else 0. */
static double plan_edge(tm_improver *m, uint32_t t, unsigned e, double needed)
{
    tm_star part[2];
    if (!tm_star_around(m->mesh, t, e, &m->star)) {
        tm_improve_no_memory(m);
        return 0;
    }
    int parts = take_apart(m, part);
    ptrdiff_t growth = -(ptrdiff_t)m->star.size;
    for (int k = 0; k < parts; k++)
        growth += (ptrdiff_t)becomes(&part[k]);
    if (parts == 0 || !tm_improve_may_grow(m, growth))
        return 0;
    double least, sum = m->price * (double)growth;
    double old = tm_improve_old_cost(m, m->star.tet, m->star.size, &least);
    for (int k = 0; k < parts; k++) {
        if (becomes(&part[k]) == 0)
            continue;
        if (!tm_edge_removal_plan_cheapest(m->mesh, &part[k], &m->cost, least,
                                           old - needed - sum, &m->removal[k]))
            return 0;
        sum += m->removal[k].quality;
    }
    if (!(old - sum > needed) || (m->features.may_move && !part[0].closed &&
                                  !tm_improve_allows_swap(m, part, parts)))
        return 0;
    return old - sum;
}

/* Replaces a part by what was planned, or by nothing. */
static void retriangulate(tm_improver *m, const tm_star *part, int k)
{
    tm_face_renewal renewal[2];
    uint32_t beyond[2];
    bool inside = part->closed;
    if (!inside)
        tm_edge_removal_renewals(m->mesh, part, k == 0, renewal);
    if (becomes(part) == 0) {
        tm_peel(m->mesh, part, renewal, k == 0, beyond);
        tm_improve_note(m, beyond, 2);
        return;
    }
    tm_edge_removal_list(part, &m->removal[k], m->node);
    tm_replacement what = {.old = part->tet,
                           .old_count = part->size,
                           .node = (const uint32_t(*)[4])m->node,
                           .count = becomes(part),
                           .renewal = renewal,
                           .renewals = inside ? 0 : 2,
                           .created = m->created};
    m->status = tm_tet_replace(m->mesh, &what, &m->table, m->error);
    if (m->status == TM_OK)
        tm_improve_note(m, m->created, what.count);
}

/* Removes the edge as it was planned. */
static bool remove_edge(tm_improver *m)
{
    tm_star part[2];
    int parts = take_apart(m, part);
    if (parts == 0 || !tm_improve_reserve(m, 2 * m->star.size, 0))
        return false;
    bool inside = part[0].closed;
    if (!tm_replacement_table_reserve(&m->table, m->star.size, 2 * m->star.size))
        return tm_improve_no_memory(m);
    for (int k = 0; k < parts && m->status == TM_OK; k++)
        retriangulate(m, &part[k], k);
    if (m->features.may_move && !inside && m->status == TM_OK)
        tm_improve_follow_surface(m);
    m->report->done.op[inside ? TM_OP_EDGE_REMOVAL : TM_OP_BOUNDARY_SWAP]++;
    return m->status == TM_OK;
}

/* Plans the removal of face i of t in m->face_removal; as plan_edge(). */
static double plan_face(tm_improver *m, uint32_t t, uint32_t i, double needed)
{
    double least;
    uint32_t across = m->mesh->neighbour[t][i];
    tm_face_removal *plan = &m->face_removal;
    if (across & TM_FACE_BIT || !tm_improve_has(m, TM_OP_FACE_REMOVAL))
        return 0;
    tm_improve_old_cost(m, (uint32_t[2]){t, across / 4}, 2, &least);
    if (!tm_face_removal_plan(m->mesh, m->quality, t, i, &m->cost, least, plan))
        return 0;
    ptrdiff_t growth = (ptrdiff_t)plan->count - (ptrdiff_t)plan->old_count;
    double gain = plan->gain - m->price * (double)growth;
    return gain > needed && tm_improve_may_grow(m, growth) ? gain : 0;
}

static bool remove_faces(tm_improver *m)
{
    const tm_face_removal *plan = &m->face_removal;
    if (!tm_improve_reserve(m, plan->count, 0))
        return false;
    tm_replacement what = {.old = plan->old,
                           .old_count = plan->old_count,
                           .node = (const uint32_t(*)[4])plan->node,
                           .count = plan->count,
                           .created = m->created};
    m->status = tm_tet_replace(m->mesh, &what, &m->table, m->error);
    if (m->status != TM_OK)
        return false;
    tm_improve_note(m, m->created, what.count);
    m->report->done.op[TM_OP_FACE_REMOVAL]++;
    return true;
}

/* Plans choice c: an edge, or beyond these a face. */
static double plan(tm_improver *m, uint32_t t, int c, double needed)
{
    return c < EDGES ? plan_edge(m, t, (unsigned)c, needed)
                     : plan_face(m, t, (uint32_t)(c - EDGES), needed);
}

bool tm_improve_swap(tm_improver *m, uint32_t t)
{
    double best = TM_IMPROVE_GAIN;
    int choice = NOTHING;
    for (int c = 0; c < EDGES + 4 && m->status == TM_OK; c++) {
        double gain = plan(m, t, c, best);
        if (gain == 0)
            continue;
        best = gain;
        choice = c;
    }
    if (choice == NOTHING || m->status != TM_OK ||
        plan(m, t, choice, TM_IMPROVE_GAIN) == 0)
        return false;
    return choice < EDGES ? remove_edge(m) : remove_faces(m);
}
