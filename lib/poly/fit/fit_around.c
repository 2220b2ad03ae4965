/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What moves with a node: the facets that have it, and the centroids of their cells, from
 * which all their facets are seen. A large cell has very many beside tiny ones: so its
 * sums are kept, of which only the part of the node's facets is made again, and of its
 * other facets only those are looked at that are not good by far. */
#include "fit_parts.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool list_facets_of_nodes(tm_fit_around *a)
{
    const tm_poly_arrays *mesh = a->m.mesh;
    const size_t corners = mesh->facets > 0 ? mesh->facet_start[mesh->facets] : 0;
    a->start = calloc(mesh->nodes + 2, sizeof *a->start);
    a->facet = tm_new(corners, sizeof *a->facet);
    if (!a->start || !a->facet)
        return false;
    for (size_t i = 0; i < corners; i++)
        a->start[mesh->facet_node[i] + 2]++;
    for (size_t v = 0; v < mesh->nodes; v++)
        a->start[v + 2] += a->start[v + 1];
    for (uint32_t f = 0; f < mesh->facets; f++)
        for (size_t i = mesh->facet_start[f]; i < mesh->facet_start[f + 1]; i++)
            a->facet[a->start[mesh->facet_node[i] + 1]++] = f;
    return true;
}

static void judge_cell(tm_fit_around *a, size_t c)
{
    const tm_poly_arrays *mesh = a->m.mesh;
    const size_t begin = mesh->cell_start[c], end = mesh->cell_start[c + 1];
    tm_fit_cell *sums = &a->sums[c];
    *sums = (tm_fit_cell){.volume = 0};
    memcpy(sums->base, a->m.cell[c].mean, sizeof sums->base);
    for (size_t i = begin; i < end; i++) {
        tm_fit_cell_add(sums, &a->m, mesh->cell_facet[i], c);
        for (size_t k = begin; k < i && a->convex; k++)
            tm_fit_add_pairs(&sums->pairs, &a->m, mesh->cell_facet[i],
                             mesh->cell_facet[k], c);
    }
}

tm_status tm_fit_around_make(tm_fit_around *a, const tm_poly_arrays *mesh,
                             double (*xyz)[3], bool convex, tm_error *error)
{
    *a = (tm_fit_around){.xyz = xyz, .convex = convex};
    const tm_status status = tm_poly_centroids_find(&a->m, mesh, error);
    if (status != TM_OK)
        return status;
    a->verdict = tm_new(mesh->facets, sizeof *a->verdict);
    a->sums = tm_new(mesh->cells, sizeof *a->sums);
    a->facet_stamp = calloc(mesh->facets + 1, sizeof *a->facet_stamp);
    a->cell_stamp = calloc(mesh->cells + 1, sizeof *a->cell_stamp);
    if (!a->verdict || !a->sums || !a->facet_stamp || !a->cell_stamp ||
        !list_facets_of_nodes(a))
        return tm_fail_memory(error);
    for (size_t f = 0; f < mesh->facets; f++)
        a->verdict[f] = tm_fit_judge_facet(&a->m, f, HUGE_VAL);
    for (size_t c = 0; c < mesh->cells; c++)
        judge_cell(a, c);
    return TM_OK;
}

static void free_state(tm_fit_state *state)
{
    free(state->facet);
    free(state->cell);
    free(state->sums);
    free(state->verdict);
}

void tm_fit_around_free(tm_fit_around *a)
{
    void *const all[] = {a->start, a->facet, a->verdict,     a->sums,       a->near,
                         a->fresh, a->cell,  a->facet_stamp, a->cell_stamp, a->rest};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    free_state(&a->first);
    free_state(&a->last);
    tm_poly_centroids_free(&a->m);
}

tm_fit_sum tm_fit_sum_up(const tm_fit_around *a)
{
    tm_fit_sum sum = {{0}, 0, 0};
    for (size_t f = 0; f < a->m.mesh->facets; f++)
        tm_fit_add_facet(&sum, &a->verdict[f]);
    for (size_t c = 0; c < a->m.mesh->cells; c++)
        tm_fit_add_cell(&sum, &a->sums[c]);
    return sum;
}

/* Around a node --------------------------------------------------------------------- */

/* Adds a facet, unless it is there. */
static bool add_facet(tm_fit_around *a, uint32_t f, uint32_t stamp)
{
    if (a->facet_stamp[f] >= a->stamp)
        return true;
    a->facet_stamp[f] = stamp;
    return tm_append(&a->near, &a->nears, &a->near_room, f);
}

static bool add_cell(tm_fit_around *a, uint32_t c)
{
    if (c == TM_NONE || a->cell_stamp[c] == a->stamp)
        return true;
    a->cell_stamp[c] = a->stamp;
    return tm_append(&a->cell, &a->cells, &a->cell_room, c);
}

static bool is_own(const tm_fit_around *a, uint32_t f)
{
    return a->facet_stamp[f] == a->stamp + 1;
}

static bool is_of(const tm_fit_around *a, uint32_t f, uint32_t c)
{
    const uint32_t *side = a->m.mesh->side[f];
    return side[0] == c || side[1] == c;
}

static bool list_near(tm_fit_around *a, uint32_t v)
{
    const tm_poly_arrays *mesh = a->m.mesh;
    bool done = true;
    a->stamp += 2;
    a->nears = a->cells = 0;
    for (size_t i = a->start[v]; i < a->start[v + 1] && done; i++) {
        const uint32_t f = a->facet[i];
        done = add_facet(a, f, a->stamp + 1) && add_cell(a, mesh->side[f][0]) &&
               add_cell(a, mesh->side[f][1]);
    }
    a->own = a->nears;
    for (size_t k = 0; k < a->cells && done; k++)
        for (size_t i = mesh->cell_start[a->cell[k]];
             i < mesh->cell_start[a->cell[k] + 1] && done; i++)
            done = add_facet(a, mesh->cell_facet[i], a->stamp);
    return done;
}

/* Puts those of the other facets first that are not good by far. */
static void find_watched(tm_fit_around *a)
{
    const float calm = -0.15F;
    a->watched = a->own;
    for (size_t k = a->own; k < a->nears; k++) {
        const uint32_t f = a->near[k];
        if (a->verdict[f].worst <= calm)
            continue;
        a->near[k] = a->near[a->watched];
        a->near[a->watched++] = f;
    }
}

static bool make_room_for(const tm_fit_around *a, tm_fit_state *s)
{
    tm_facet_centroid *facet = tm_grow(s->facet, &s->facet_room, a->own, sizeof *facet);
    s->facet = facet ? facet : s->facet;
    tm_cell_centroid *cell = tm_grow(s->cell, &s->cell_room, a->cells, sizeof *cell);
    s->cell = cell ? cell : s->cell;
    tm_fit_cell *sums = tm_grow(s->sums, &s->sums_room, a->cells, sizeof *sums);
    s->sums = sums ? sums : s->sums;
    tm_fit_verdict *verdict =
        tm_grow(s->verdict, &s->verdict_room, a->nears, sizeof *verdict);
    s->verdict = verdict ? verdict : s->verdict;
    return facet && cell && sums && verdict;
}

static bool make_room(tm_fit_around *a)
{
    tm_fit_verdict *fresh = tm_grow(a->fresh, &a->fresh_room, a->nears, sizeof *fresh);
    a->fresh = fresh ? fresh : a->fresh;
    tm_fit_cell *rest = tm_grow(a->rest, &a->rest_room, a->cells, sizeof *rest);
    a->rest = rest ? rest : a->rest;
    return fresh && rest && make_room_for(a, &a->first) && make_room_for(a, &a->last);
}

static void keep(const tm_fit_around *a, uint32_t v, tm_fit_state *state)
{
    memcpy(state->at, a->xyz[v], sizeof state->at);
    for (size_t k = 0; k < a->own; k++)
        state->facet[k] = a->m.face[a->near[k]];
    for (size_t k = 0; k < a->cells; k++) {
        state->cell[k] = a->m.cell[a->cell[k]];
        state->sums[k] = a->sums[a->cell[k]];
    }
    for (size_t k = 0; k < a->watched; k++)
        state->verdict[k] = a->verdict[a->near[k]];
}

static void put_back(const tm_fit_around *a, uint32_t v, const tm_fit_state *state)
{
    memcpy(a->xyz[v], state->at, sizeof state->at);
    for (size_t k = 0; k < a->own; k++)
        a->m.face[a->near[k]] = state->facet[k];
    for (size_t k = 0; k < a->cells; k++) {
        a->m.cell[a->cell[k]] = state->cell[k];
        a->sums[a->cell[k]] = state->sums[k];
    }
    for (size_t k = 0; k < a->watched; k++)
        a->verdict[a->near[k]] = state->verdict[k];
}

/* The pairs of cell c with at least one facet of the node. */
static tm_fit_pairs own_pairs(const tm_fit_around *a, uint32_t c)
{
    const tm_poly_arrays *mesh = a->m.mesh;
    tm_fit_pairs pairs = {0, 0, 0};
    for (size_t k = 0; k < a->own; k++) {
        const uint32_t f = a->near[k];
        if (!is_of(a, f, c))
            continue;
        for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
            const uint32_t g = mesh->cell_facet[i];
            if (g < f || (g > f && !is_own(a, g)))
                tm_fit_add_pairs(&pairs, &a->m, f, g, c);
        }
    }
    return pairs;
}

/* The sums of cell c but for the facets of the node. */
static void find_rest(const tm_fit_around *a, uint32_t c, tm_fit_cell *rest)
{
    const tm_poly_arrays *mesh = a->m.mesh;
    *rest = (tm_fit_cell){.volume = 0};
    memcpy(rest->base, a->sums[c].base, sizeof rest->base);
    for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++)
        if (!is_own(a, mesh->cell_facet[i]))
            tm_fit_cell_add(rest, &a->m, mesh->cell_facet[i], c);
    if (!a->convex)
        return;
    const tm_fit_pairs own = own_pairs(a, c), *all = &a->sums[c].pairs;
    rest->pairs = (tm_fit_pairs){all->concave - own.concave, all->bad - own.bad,
                                 all->missing - own.missing};
}

bool tm_fit_around_find(tm_fit_around *a, uint32_t v)
{
    if (!list_near(a, v) || !make_room(a))
        return false;
    find_watched(a);
    a->work += a->nears;
    a->now = (tm_fit_sum){{0}, 0, 0};
    for (size_t k = 0; k < a->watched; k++)
        tm_fit_add_facet(&a->now, &a->verdict[a->near[k]]);
    for (size_t k = 0; k < a->cells; k++)
        tm_fit_add_cell(&a->now, &a->sums[a->cell[k]]);
    a->before = a->now;
    if (a->now.bad == 0)
        return true;
    for (size_t k = 0; k < a->cells; k++)
        find_rest(a, a->cell[k], &a->rest[k]);
    keep(a, v, &a->first);
    return true;
}

/* Moves ----------------------------------------------------------------------------- */

/* Measures the node's facets and their cells. */
static void measure(tm_fit_around *a)
{
    for (size_t k = 0; k < a->own; k++)
        tm_facet_centroid_find(&a->m, a->near[k]);
    for (size_t i = 0; i < a->cells; i++) {
        const uint32_t c = a->cell[i];
        a->sums[c] = a->rest[i];
        for (size_t k = 0; k < a->own; k++)
            if (is_of(a, a->near[k], c))
                tm_fit_cell_add(&a->sums[c], &a->m, a->near[k], c);
        tm_fit_cell_finish(&a->sums[c], &a->m, c);
    }
}

static bool is_better(const tm_fit_sum *after, const tm_fit_sum *before)
{
    const bool sounder = after->count[TM_FIT_PYRAMID] < before->count[TM_FIT_PYRAMID];
    for (int k = 0; k < TM_FIT_FAULTS && !sounder; k++)
        if (after->count[k] > before->count[k])
            return false;
    return after->missing < before->missing;
}

/* Adds the facets near[from … to) again, as long as less is missing than so much. */
static void add_facets(tm_fit_around *a, size_t from, size_t to, double missing,
                       tm_fit_sum *sum)
{
    for (size_t k = from; k < to && sum->missing < missing; k++) {
        a->work += tm_facet_corners(a->m.mesh, a->near[k]);
        a->fresh[k] = tm_fit_judge_facet(&a->m, a->near[k], missing - sum->missing);
        tm_fit_add_facet(sum, &a->fresh[k]);
    }
}

static void add_cells(const tm_fit_around *a, tm_fit_sum *sum)
{
    for (size_t k = 0; k < a->cells && sum->missing < a->now.missing; k++) {
        const uint32_t c = a->cell[k];
        if (a->convex) {
            const tm_fit_pairs own = own_pairs(a, c), *rest = &a->rest[k].pairs;
            a->sums[c].pairs =
                (tm_fit_pairs){rest->concave + own.concave, rest->bad + own.bad,
                               rest->missing + own.missing};
        }
        tm_fit_add_cell(sum, &a->sums[c]);
    }
}

static void take_verdicts(const tm_fit_around *a, size_t from, size_t to)
{
    for (size_t k = from; k < to; k++)
        a->verdict[a->near[k]] = a->fresh[k];
}

bool tm_fit_around_move(tm_fit_around *a, uint32_t v, const double to[3])
{
    tm_fit_sum after = {{0}, 0, 0};
    keep(a, v, &a->last);
    memcpy(a->xyz[v], to, sizeof *a->xyz);
    measure(a);
    add_facets(a, 0, a->watched, a->now.missing, &after);
    add_cells(a, &after);
    if (!is_better(&after, &a->now)) {
        put_back(a, v, &a->last);
        return false;
    }
    take_verdicts(a, 0, a->watched);
    a->now = after;
    return true;
}

bool tm_fit_around_settle(tm_fit_around *a, uint32_t v)
{
    tm_fit_sum after = a->now;
    if (!(after.missing < a->before.missing))
        return false;
    add_facets(a, a->watched, a->nears, a->before.missing, &after);
    if (!is_better(&after, &a->before)) {
        put_back(a, v, &a->first);
        return false;
    }
    take_verdicts(a, a->watched, a->nears);
    return true;
}
