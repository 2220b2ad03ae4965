/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dual_vicinity.h"

#include "../../base/array.h"
#include "../facets.h"

#include <stdlib.h>
#include <string.h>

static bool list_facets_of_points(tm_dual_vicinity *v)
{
    const tm_dual *d = v->d;
    size_t *start = calloc(d->points + 2, sizeof *start);
    v->start = start;
    v->facet = tm_new(d->items, sizeof *v->facet);
    if (!start || !v->facet)
        return false;
    for (size_t i = 0; i < d->items; i++)
        start[d->facet.item[i] + 1]++;
    for (size_t p = 0; p < d->points; p++)
        start[p + 1] += start[p];
    for (size_t f = d->facets; f-- > 0;)
        for (size_t i = d->facet.start[f]; i < d->facet.start[f + 1]; i++)
            v->facet[--start[d->facet.item[i] + 1]] = (uint32_t)f;
    /* Each is now where its own begin, one place too far. */
    memmove(start, start + 1, d->points * sizeof *start);
    start[d->points] = d->items;
    return true;
}

static bool measure_all(tm_dual_vicinity *v)
{
    tm_dual *d = v->d;
    v->m = (tm_dual_measures){.d = d,
                              .face = tm_new(d->facets, sizeof *v->m.face),
                              .centre = tm_new(d->cells, sizeof *v->m.centre),
                              .cell = &v->cells};
    if (!v->m.face || !v->m.centre)
        return false;
    for (size_t f = 0; f < d->facets; f++)
        tm_dual_measure_face(d, f, &v->m.face[f]);
    for (size_t c = 0; c < d->cells; c++)
        tm_dual_measure_centre(&v->m, c, &v->m.centre[c]);
    v->facet_stamp = calloc(d->facets + 1, sizeof *v->facet_stamp);
    v->cell_stamp = calloc(d->cells + 1, sizeof *v->cell_stamp);
    return v->facet_stamp && v->cell_stamp;
}

tm_status tm_dual_vicinity_make(tm_dual_vicinity *v, tm_dual *d, tm_error *error)
{
    *v = (tm_dual_vicinity){.d = d, .cells = {.kind = TM_CELL}};
    const tm_status status = tm_cells_from_facets(&d->facet, &v->cells, d->cells, error);
    if (status != TM_OK)
        return status;
    return measure_all(v) && list_facets_of_points(v) ? TM_OK : tm_fail_memory(error);
}

void tm_dual_vicinity_free(tm_dual_vicinity *v)
{
    tm_block_clear(&v->cells);
    free(v->m.face);
    free(v->m.centre);
    free(v->start);
    free(v->facet);
    free(v->facet_stamp);
    free(v->cell_stamp);
    free(v->near);
    free(v->watch);
    free(v->cell);
    free(v->was_face);
    free(v->was_centre);
}

/* Adds a facet, unless it is there. */
static bool add_facet(tm_dual_vicinity *v, uint32_t f)
{
    if (v->facet_stamp[f] == v->stamp)
        return true;
    v->facet_stamp[f] = v->stamp;
    return tm_append(&v->near, &v->nears, &v->near_room, f);
}

static bool add_cell(tm_dual_vicinity *v, uint32_t c)
{
    if (c == TM_NONE || v->cell_stamp[c] == v->stamp)
        return true;
    v->cell_stamp[c] = v->stamp;
    return tm_append(&v->cell, &v->cell_count, &v->cell_room, c);
}

bool tm_dual_vicinity_find(tm_dual_vicinity *v, uint32_t p)
{
    const uint32_t *side = v->d->facet.integer;
    bool done = true;
    v->stamp++;
    v->nears = v->cell_count = 0;
    for (size_t i = v->start[p]; i < v->start[p + 1] && done; i++) {
        const size_t f = v->facet[i];
        done = add_facet(v, (uint32_t)f) && add_cell(v, side[2 * f]) &&
               add_cell(v, side[2 * f + 1]);
    }
    v->own = v->nears;
    for (size_t k = 0; k < v->cell_count && done; k++)
        for (size_t i = v->cells.start[v->cell[k]];
             i < v->cells.start[v->cell[k] + 1] && done; i++)
            done = add_facet(v, v->cells.item[i]);
    tm_dual_face *face = tm_grow(v->was_face, &v->face_room, v->own, sizeof *face);
    v->was_face = face ? face : v->was_face;
    tm_dual_centre *centre =
        tm_grow(v->was_centre, &v->centre_room, v->cell_count, sizeof *centre);
    v->was_centre = centre ? centre : v->was_centre;
    uint32_t *watch = tm_grow(v->watch, &v->watch_room, v->nears, sizeof *watch);
    v->watch = watch ? watch : v->watch;
    return done && face && centre && watch;
}

/* Adds how bad a facet is. */
static void add_to_score(tm_dual_score *s, double x)
{
    const double heavy = 30;
    if (!(x > 0))
        return;
    s->worst = x > s->worst ? x : s->worst;
    s->sum += x * x + (x > TM_DUAL_BAD ? heavy * (x - TM_DUAL_BAD) : 0);
}

static bool is_beaten(const tm_dual_score *s, const tm_dual_score *limit)
{
    const double worst = limit->worst > TM_DUAL_BAD ? limit->worst : TM_DUAL_BAD;
    return s->sum >= limit->sum || s->worst > worst;
}

static void add_cells(const tm_dual_vicinity *v, tm_dual_score *s,
                      const tm_dual_score *limit)
{
    for (size_t k = 0; k < v->cell_count && v->d->options->convex; k++) {
        s->concave |= tm_dual_judge_cell(&v->m, v->cell[k], &s->sum) > TM_DUAL_BAD;
        if (limit && s->sum >= limit->sum)
            return;
    }
}

tm_dual_score tm_dual_vicinity_judge(tm_dual_vicinity *v)
{
    const double calm = -0.15;
    tm_dual_score s = {0, 0, false};
    v->watched = 0;
    for (size_t k = 0; k < v->nears; k++) {
        const double x = tm_dual_judge_face(&v->m, v->near[k]);
        add_to_score(&s, x);
        if (k >= v->own && !(x > calm))
            continue;
        v->watch[v->watched++] = v->near[k];
        if (x > 0) { /* the bad ones first */
            v->watch[v->watched - 1] = v->watch[0];
            v->watch[0] = v->near[k];
        }
    }
    add_cells(v, &s, NULL);
    return s;
}

/* Judges what is watched, until that is not better than before any more. */
static tm_dual_score judge_again(const tm_dual_vicinity *v, const tm_dual_score *limit)
{
    tm_dual_score s = {0, 0, false};
    for (size_t k = 0; k < v->watched && !is_beaten(&s, limit); k++)
        add_to_score(&s, tm_dual_judge_face(&v->m, v->watch[k]));
    if (!is_beaten(&s, limit))
        add_cells(v, &s, limit);
    return s;
}

bool tm_dual_vicinity_move(tm_dual_vicinity *v, uint32_t p, const double to[3],
                           tm_dual_score *now)
{
    double was[3];
    double *at = v->d->xyz[p];
    memcpy(was, at, sizeof was);
    memcpy(at, to, sizeof was);
    for (size_t k = 0; k < v->own; k++) {
        v->was_face[k] = v->m.face[v->near[k]];
        tm_dual_measure_face(v->d, v->near[k], &v->m.face[v->near[k]]);
    }
    for (size_t k = 0; k < v->cell_count; k++) {
        v->was_centre[k] = v->m.centre[v->cell[k]];
        tm_dual_measure_centre(&v->m, v->cell[k], &v->m.centre[v->cell[k]]);
    }
    const tm_dual_score after = judge_again(v, now);
    if (!is_beaten(&after, now)) {
        *now = after;
        return true;
    }
    memcpy(at, was, sizeof was);
    for (size_t k = 0; k < v->own; k++)
        v->m.face[v->near[k]] = v->was_face[k];
    for (size_t k = 0; k < v->cell_count; k++)
        v->m.centre[v->cell[k]] = v->was_centre[k];
    return false;
}
