/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fit_parts.h"

#include "../../base/array.h"
#include "../../base/hash.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the way to a corner, or the shortest side: a round takes one after the other. */
static const double steps[] = {0.4, 0.2, 0.1, 0.3, 0.05, 0.02};

enum { STEPS = sizeof steps / sizeof *steps, DIRECTIONS = 4 };

typedef struct {
    tm_fit_around a;
    const tm_fit_options *o;
    bool *tried;     /* [nodes]: may mend a fault */
    uint8_t *missed; /* [nodes]: so many steps in a row gained nothing */
} fitter;

/* Which nodes ----------------------------------------------------------------------- */

static void try_facet(const fitter *w, size_t f)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    for (size_t i = mesh->facet_start[f]; i < mesh->facet_start[f + 1]; i++)
        w->tried[mesh->facet_node[i]] = !w->o->fixed[mesh->facet_node[i]];
}

static void try_cell(const fitter *w, uint32_t c)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1] && c != TM_NONE; i++)
        try_facet(w, mesh->cell_facet[i]);
}

/* The facets of bad pairs. */
static void try_pairs(const fitter *w, uint32_t c)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    const size_t begin = mesh->cell_start[c], end = mesh->cell_start[c + 1];
    for (size_t i = begin; i < end; i++)
        for (size_t k = begin; k < i; k++) {
            tm_fit_pairs pair = {0, 0, 0};
            tm_fit_add_pairs(&pair, &w->a.m, mesh->cell_facet[i], mesh->cell_facet[k], c);
            if (pair.bad == 0)
                continue;
            try_facet(w, mesh->cell_facet[i]);
            try_facet(w, mesh->cell_facet[k]);
        }
}

/* Marks the nodes that may mend what is bad: those of bad facets and pairs; if `wide` all
 * those of the cells that have them. How much is bad. */
static size_t find_bad(const fitter *w, bool wide)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    size_t bad = 0;
    memset(w->tried, 0, mesh->nodes * sizeof *w->tried);
    for (size_t f = 0; f < mesh->facets; f++) {
        if ((double)w->a.verdict[f].worst <= TM_FIT_BAD)
            continue;
        bad++;
        try_facet(w, f);
        for (int s = 0; s < 2 && wide; s++)
            if (mesh->side[f][s] != TM_NONE)
                try_cell(w, mesh->side[f][s]);
    }
    for (uint32_t c = 0; c < mesh->cells; c++) {
        tm_fit_sum sum = {{0}, 0, 0};
        tm_fit_add_cell(&sum, &w->a.sums[c]);
        bad += sum.bad > 0;
        if (sum.bad > 0 && wide)
            try_cell(w, c);
        else if (sum.bad > 0)
            try_pairs(w, c);
    }
    return bad;
}

/* Marks the nodes of all cells with a node that is marked. */
static bool widen(const fitter *w)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    bool *marked = tm_new(mesh->nodes, sizeof *marked);
    if (!marked)
        return false;
    memcpy(marked, w->tried, mesh->nodes * sizeof *marked);
    for (size_t v = 0; v < mesh->nodes; v++)
        for (size_t i = w->a.start[v]; i < w->a.start[v + 1] && marked[v]; i++)
            for (int s = 0; s < 2; s++)
                if (mesh->side[w->a.facet[i]][s] != TM_NONE)
                    try_cell(w, mesh->side[w->a.facet[i]][s]);
    free(marked);
    return true;
}

/* What is around a node is new: all nodes there are to be tried again. */
static void forget_misses(const fitter *w)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    for (size_t k = 0; k < w->a.nears; k++)
        for (size_t i = mesh->facet_start[w->a.near[k]];
             i < mesh->facet_start[w->a.near[k] + 1]; i++)
            w->missed[mesh->facet_node[i]] = 0;
}

/* Where to -------------------------------------------------------------------------- */

/* The shortest side of the facets at a node. */
static double shortest_side(const fitter *w, uint32_t v)
{
    const tm_poly_arrays *mesh = w->a.m.mesh;
    double least = HUGE_VAL;
    for (size_t i = w->a.start[v]; i < w->a.start[v + 1]; i++) {
        const uint32_t f = w->a.facet[i];
        const size_t from = mesh->facet_start[f], count = mesh->facet_start[f + 1] - from;
        for (size_t k = 0; k < count; k++) {
            const uint32_t a = mesh->facet_node[from + k];
            const uint32_t b = mesh->facet_node[from + (k + 1) % count];
            if (a == v || b == v)
                least = fmin(least, tm_distance2(mesh->xyz[a], mesh->xyz[b]));
        }
    }
    return sqrt(least);
}

/* The corners that a node moves between; how many. */
static int find_corners(const fitter *w, uint32_t v, const double *corner[DIRECTIONS])
{
    int count = 0;
    while (w->o->corner && count < DIRECTIONS && w->o->corner[v][count] != TM_NONE) {
        corner[count] = w->o->point[w->o->corner[v][count]];
        count++;
    }
    return count;
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
    } else if (corners == 2) {
        memcpy(normal, height, sizeof normal);
    } else {
        double plane[3], along[3];
        tm_subtract(along, corner[(i + 2) % corners], a);
        tm_cross(plane, along, height);
        tm_cross(normal, plane, along);
    }
    return tm_dot(normal, to) / tm_dot(normal, height);
}

/* Three directions normal to each other: the axes, or these turned by a quaternion that
 * depends on the node and the round, so that none is tried in vain for ever. */
static void find_axes(uint32_t v, int round, double axis[3][3])
{
    double q[4] = {1, 0, 0, 0}, sum = 0;
    uint64_t state = tm_hash(tm_hash(0, v), (uint64_t)round);
    for (int i = 0; i < 4 && round >= STEPS; i++, state = tm_hash(state, 1))
        q[i] = (double)(state >> 40) / 0x1p23 - 1;
    for (int i = 0; i < 4; i++)
        sum += q[i] * q[i];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const int other = 3 - i - k;
            const double sign = (k + 3 - i) % 3 == 1 ? 1 : -1;
            axis[i][k] =
                i == k ? (2 * (q[0] * q[0] + q[i + 1] * q[i + 1]) - sum) / sum
                       : 2 * (q[i + 1] * q[k + 1] + sign * q[0] * q[other + 1]) / sum;
        }
}

/* Tries a step towards each corner and away from it, or along the axes. */
static bool move_node(fitter *w, uint32_t v, int round)
{
    const double step = steps[round % STEPS];
    double axis[3][3];
    find_axes(v, round, axis);
    const double *corner[DIRECTIONS];
    const int corners = find_corners(w, v, corner), directions = corners ? corners : 3;
    const double side = corners ? 0 : shortest_side(w, v);
    for (int k = 0, gain = 0; k < 2 * directions && w->a.now.bad > 0; k += 1 + gain) {
        double to[3];
        bool inside = true;
        memcpy(to, w->a.xyz[v], sizeof to);
        for (int x = 0; x < 3; x++)
            if (corners)
                to[x] += (k % 2 ? -step : step) * (corner[k / 2][x] - to[x]);
            else
                to[x] += (k % 2 ? -step : step) * side * axis[k / 2][x];
        for (int i = 0; i < corners && inside; i++)
            inside = coordinate(corner, corners, i, to) >= w->o->least;
        gain = inside && tm_fit_around_move(&w->a, v, to) && k % 2 == 0; /* not back */
    }
    return tm_fit_around_settle(&w->a, v);
}

/* Rounds over the nodes at what is bad, then over those around them, too, until as many
 * as there are steps have mended little. */
static bool fit(fitter *w, tm_fit_report *r)
{
    const size_t few = 20; /* less of what is bad by a part of so much is little */
    const size_t most = w->o->work > 0 ? w->o->work : SIZE_MAX;
    size_t least = SIZE_MAX;
    bool done = true;
    for (int i = 0, idle = 0; i < w->o->rounds && idle < STEPS && done; i++) {
        const size_t bad = find_bad(w, i >= 2);
        idle = bad < least - least / few ? 0 : idle + 1;
        least = idle == 0 ? bad : least;
        if (bad == 0 || w->a.work >= most)
            break;
        done = i < STEPS || widen(w);
        for (uint32_t v = 0; v < w->a.m.mesh->nodes && done && w->a.work < most; v++) {
            if (!w->tried[v] || w->missed[v] >= STEPS)
                continue;
            done = tm_fit_around_find(&w->a, v);
            const bool moved = done && move_node(w, v, i);
            w->missed[v]++;
            r->moved += moved;
            if (moved)
                forget_misses(w);
        }
    }
    r->work = w->a.work;
    return done;
}

tm_status tm_polyhedra_fit(const tm_poly_arrays *mesh, double (*xyz)[3],
                           const tm_fit_options *options, tm_fit_report *report,
                           tm_error *error)
{
    fitter w = {.o = options};
    *report = (tm_fit_report){0};
    tm_status status = tm_fit_around_make(&w.a, mesh, xyz, options->convex, error);
    w.tried = tm_new(mesh->nodes, sizeof *w.tried);
    w.missed = calloc(mesh->nodes + 1, sizeof *w.missed);
    if (status == TM_OK && (!w.tried || !w.missed))
        status = tm_fail_memory(error);
    if (status == TM_OK && w.tried && w.missed) {
        const tm_fit_sum before = tm_fit_sum_up(&w.a);
        memcpy(report->before, before.count, sizeof report->before);
        status = fit(&w, report) ? TM_OK : tm_fail_memory(error);
        const tm_fit_sum after = tm_fit_sum_up(&w.a);
        memcpy(report->after, after.count, sizeof report->after);
    }
    tm_fit_around_free(&w.a);
    free(w.tried);
    free(w.missed);
    return status;
}

size_t tm_fit_faults_left(const tm_fit_report *report)
{
    size_t sum = 0;
    for (int k = 0; k < TM_FIT_FAULTS; k++)
        sum += report->after[k];
    return sum;
}

void tm_fit_faults_say(const tm_fit_report *report, char *text, size_t size)
{
    static const char *const what[TM_FIT_FAULTS] = {
        [TM_FIT_PYRAMID] = "pyramids of no volume",
        [TM_FIT_TETRAHEDRA] = "facets that do not divide into tetrahedra",
        [TM_FIT_CONCAVE] = "concave cells",
        [TM_FIT_OBLIQUE] = "facets above 70 degrees",
        [TM_FIT_SKEW] = "skew facets",
        [TM_FIT_UNEVEN] = "facets much closer to one cell than to the other",
        [TM_FIT_UNEQUAL] = "facets between cells of very unequal size",
        [TM_FIT_UNDETERMINED] = "cells with their facets in one direction"};
    size_t length = 0;
    text[0] = 0;
    for (int k = 0; k < TM_FIT_FAULTS && length < size; k++)
        if (report->after[k] > 0)
            length += (size_t)snprintf(text + length, size - length, "%s%zu %s",
                                       length > 0 ? ", " : "", report->after[k], what[k]);
}
