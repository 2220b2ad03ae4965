/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points of bad facets, and of cells that are not convex, are moved where that makes them
 * better: in their tetrahedron or triangle or along their edge, towards a corner of it or
 * away, by one step or another. What they change is judged before and after; a point
 * stays where it was unless the sum is less and the worst facet is no worse. */
#include "dual_steps.h"
#include "dual_vicinity.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { STEPS = 4, FIRST_SWEEPS = 12, MORE_SWEEPS = 2 };

/* The least barycentric coordinate that a point may have. */
static const double least_coordinate = 0.03;

typedef struct {
    tm_dual_vicinity v;
    bool *active;    /* [points] */
    uint8_t *missed; /* [points]: so many steps in a row were none */
    size_t moved;
} improver;

/* The corners of what a point may move in; how many. */
static int find_corners(const tm_dual *d, uint32_t p, const double *corner[4])
{
    const tm_tet_mesh *mesh = d->mesh;
    const uint32_t of = d->point[p].of;
    uint32_t node[3];
    switch ((tm_dual_place)d->point[p].place) {
    case TM_DUAL_IN_TET:
        for (int i = 0; i < 4; i++)
            corner[i] = mesh->xyz[mesh->tet[of][i]];
        return d->frozen[of] ? 0 : 4;
    case TM_DUAL_IN_FACE:
        tm_dual_half_nodes(mesh, d->wall[of].half, node);
        for (int i = 0; i < 3; i++)
            corner[i] = mesh->xyz[node[i]];
        return d->frozen[d->wall[of].half / 4] ? 0 : 3;
    case TM_DUAL_ON_EDGE:
        for (int i = 0; i < 2; i++)
            corner[i] = mesh->xyz[d->edge[of].node[i]];
        return d->level[d->edge[of].node[0]] == TM_DUAL_PIECES ||
                       d->level[d->edge[of].node[1]] == TM_DUAL_PIECES
                   ? 0
                   : 2;
    case TM_DUAL_AT_NODE:
        break;
    }
    return 0;
}

/* Barycentric coordinate i of a point in a simplex, by its distance to the side opposite
 * corner i. */
static double coordinate(const double *const *corner, int corners, int i,
                         const double p[3])
{
    const double *a = corner[(i + 1) % corners];
    double normal[3], to[3], height[3];
    tm_subtract(to, p, a);
    tm_subtract(height, corner[i], a);
    if (corners == 4) {
        tm_triangle_normal(normal, a, corner[(i + 2) % 4], corner[(i + 3) % 4]);
    } else {
        double plane[3], along[3];
        tm_subtract(along, corner[(i + 2) % corners], a);
        if (corners == 2)
            memcpy(normal, height, sizeof normal);
        else {
            tm_cross(plane, along, height);
            tm_cross(normal, plane, along);
        }
    }
    return tm_dot(normal, to) / tm_dot(normal, height);
}

/* What is around the point is new: all points there are to be tried again. */
static void forget_misses(improver *m)
{
    const tm_block *facet = &m->v.d->facet;
    for (size_t k = 0; k < m->v.nears; k++)
        for (size_t i = facet->start[m->v.near[k]]; i < facet->start[m->v.near[k] + 1];
             i++)
            m->missed[facet->item[i]] = 0;
}

/* Tries a step towards each corner and away from it. */
static bool improve_point(improver *m, uint32_t p, double step)
{
    const double *corner[4];
    const int corners = find_corners(m->v.d, p, corner);
    if (corners == 0)
        return true;
    if (!tm_dual_vicinity_find(&m->v, p))
        return false;
    tm_dual_score now = tm_dual_vicinity_judge(&m->v);
    bool moved = false;
    for (int k = 0; k < 2 * corners && (now.worst > TM_DUAL_BAD || now.concave); k++) {
        const double by = k % 2 ? -step : step;
        double to[3];
        const double *at = m->v.d->xyz[p];
        for (int x = 0; x < 3; x++)
            to[x] = at[x] + by * (corner[k / 2][x] - at[x]);
        bool inside = true;
        for (int i = 0; i < corners && inside; i++)
            inside = coordinate(corner, corners, i, to) >= least_coordinate;
        moved |= inside && tm_dual_vicinity_move(&m->v, p, to, &now);
    }
    m->missed[p]++;
    if (moved)
        forget_misses(m);
    m->moved += moved;
    return true;
}

static void mark_facet(improver *m, size_t f)
{
    const tm_block *facet = &m->v.d->facet;
    for (size_t k = facet->start[f]; k < facet->start[f + 1]; k++)
        m->active[facet->item[k]] = true;
}

static void mark_cell(improver *m, uint32_t c)
{
    if (c == TM_NONE)
        return;
    for (size_t i = m->v.cells.start[c]; i < m->v.cells.start[c + 1]; i++)
        mark_facet(m, m->v.cells.item[i]);
}

/* Marks the points of bad facets, or all those of their cells, and of cells that are not
 * convex; how many are bad. */
static size_t mark_points(improver *m, bool all)
{
    const tm_dual *d = m->v.d;
    size_t count = 0;
    memset(m->active, 0, d->points * sizeof *m->active);
    for (size_t f = 0; f < d->facets; f++) {
        if (!(tm_dual_judge_face(&m->v.m, f) > TM_DUAL_BAD))
            continue;
        count++;
        mark_facet(m, f);
        for (int s = 0; s < 2 && all; s++)
            mark_cell(m, d->facet.integer[2 * f + (size_t)s]);
    }
    for (uint32_t c = 0; c < d->cells && d->options->convex; c++) {
        double sum = 0;
        if (!(tm_dual_judge_cell(&m->v.m, c, &sum) > TM_DUAL_BAD))
            continue;
        count++;
        mark_cell(m, c);
    }
    return count;
}

static bool improve(improver *m, int sweeps)
{
    const double enough =
        0.9; /* are left by a sweep after which another one is worth it */
    static const double steps[STEPS] = {0.1, 0.2, 0.05, 0.3};
    const tm_dual *d = m->v.d;
    m->active = tm_new(d->points, sizeof *m->active);
    m->missed = calloc(d->points + 1, sizeof *m->missed);
    bool done = m->active && m->missed;
    size_t before = SIZE_MAX;
    for (int sweep = 0; sweep < sweeps && done; sweep++) {
        const size_t left = mark_points(m, sweep > 1);
        if (left == 0 || (sweep > STEPS && (double)left > enough * (double)before))
            break;
        before = left;
        for (uint32_t p = 0; p < d->points && done; p++)
            if (m->active[p] && m->missed[p] < STEPS)
                done = improve_point(m, p, steps[sweep % STEPS]);
    }
    return done;
}

/* Cuts the nodes whose cells have a wrong pyramid one level further, and counts what is
 * bad. */
static void finish(improver *m, bool move, tm_dual_report *report)
{
    tm_dual *d = m->v.d;
    d->again = false;
    report->wrong_pyramids = report->bad_facets = report->concave = 0;
    for (size_t f = 0; f < d->facets; f++) {
        report->bad_facets += tm_dual_judge_face(&m->v.m, f) > 1;
        for (int s = 0; s < 2; s++) {
            const uint32_t c = d->facet.integer[2 * f + (size_t)s];
            if (c == TM_NONE || !tm_dual_is_wrong(&m->v.m, f, s))
                continue;
            report->wrong_pyramids++;
            uint8_t *level = &d->level[d->cell_node[c]];
            const tm_dual_level next = tm_dual_next_level((tm_dual_level)*level);
            if (next == *level || (!move && *level != TM_DUAL_WHOLE))
                continue;
            *level = (uint8_t)next;
            d->again = true;
        }
    }
    for (size_t c = 0; c < d->cells; c++) {
        double sum = 0;
        report->concave += tm_dual_judge_cell(&m->v.m, c, &sum) > 1;
    }
    report->moved += m->moved;
}

tm_status tm_dual_improve(tm_dual *d, tm_dual_round round, tm_dual_report *report,
                          tm_error *error)
{
    static const int sweeps_of[] = {0, FIRST_SWEEPS, MORE_SWEEPS};
    const int sweeps = sweeps_of[round];
    improver m = {0};
    tm_status status = tm_dual_vicinity_make(&m.v, d, error);
    if (status == TM_OK && sweeps > 0 && !improve(&m, sweeps))
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        finish(&m, sweeps > 0, report);
        status = tm_dual_find_no_balls(d, &m.v.cells, error);
    }
    if (status == TM_OK)
        memcpy(d->tet_xyz, d->xyz, d->mesh->slots * sizeof *d->tet_xyz);
    tm_dual_vicinity_free(&m.v);
    free(m.active);
    free(m.missed);
    return status;
}
