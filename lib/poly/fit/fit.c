/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fit_parts.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_poly_centroids m;
    double (*xyz)[3];
    const bool *fixed;
    size_t *start; /* [nodes + 1]: facets of node v are */
    uint32_t *facet;
    bool *tried;     /* [nodes]: its faults are to be mended */
    uint32_t *stamp; /* [facets]: the node that has it in `around` */
    /* Around one node: its facets, their cells, all facets of these. */
    uint32_t *cell, *around;
    tm_facet_centroid *old_facet;
    tm_cell_centroid *old_cell;
    size_t cells, arounds, cell_room, around_room, old_facet_room, old_cell_room;
} fitter;

static void free_fitter(fitter *w)
{
    tm_poly_centroids_free(&w->m);
    free(w->start);
    free(w->facet);
    free(w->tried);
    free(w->stamp);
    free(w->cell);
    free(w->around);
    free(w->old_facet);
    free(w->old_cell);
}

static bool list_facets_of_nodes(fitter *w)
{
    const tm_poly_arrays *mesh = w->m.mesh;
    const size_t corners = mesh->facets > 0 ? mesh->facet_start[mesh->facets] : 0;
    w->start = calloc(mesh->nodes + 2, sizeof *w->start);
    w->facet = tm_new(corners, sizeof *w->facet);
    w->tried = calloc(mesh->nodes + 1, sizeof *w->tried);
    w->stamp = tm_new(mesh->facets, sizeof *w->stamp);
    if (!w->start || !w->facet || !w->tried || !w->stamp)
        return false;
    for (size_t i = 0; i < corners; i++)
        w->start[mesh->facet_node[i] + 2]++;
    for (size_t v = 0; v < mesh->nodes; v++)
        w->start[v + 2] += w->start[v + 1];
    for (uint32_t f = 0; f < mesh->facets; f++) {
        w->stamp[f] = TM_NONE;
        for (size_t i = mesh->facet_start[f]; i < mesh->facet_start[f + 1]; i++)
            w->facet[w->start[mesh->facet_node[i] + 1]++] = f;
    }
    return true;
}

static size_t sum_of(const size_t count[TM_FIT_FAULTS])
{
    size_t sum = 0;
    for (int k = 0; k < TM_FIT_FAULTS; k++)
        sum += count[k];
    return sum;
}

static void add_counts(size_t to[TM_FIT_FAULTS], const size_t count[TM_FIT_FAULTS])
{
    for (int k = 0; k < TM_FIT_FAULTS; k++)
        to[k] += count[k];
}

/* The nodes of a cell that are not fixed may mend it. */
static void try_nodes_of(fitter *w, uint32_t c)
{
    const tm_poly_arrays *mesh = w->m.mesh;
    if (c == TM_NONE)
        return;
    for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
        const uint32_t f = mesh->cell_facet[i];
        for (size_t k = mesh->facet_start[f]; k < mesh->facet_start[f + 1]; k++)
            w->tried[mesh->facet_node[k]] = !w->fixed[mesh->facet_node[k]];
    }
}

/* Counts faults, and marks the nodes that may mend them. */
static void find_faults(fitter *w, size_t count[TM_FIT_FAULTS])
{
    const tm_poly_arrays *mesh = w->m.mesh;
    memset(w->tried, 0, mesh->nodes * sizeof *w->tried);
    memset(count, 0, TM_FIT_FAULTS * sizeof *count);
    for (size_t f = 0; f < mesh->facets; f++) {
        tm_fit_sum here = {{0}, 0};
        tm_fit_judge_facet(&w->m, f, &here);
        if (sum_of(here.count) > 0)
            for (int s = 0; s < 2; s++)
                try_nodes_of(w, mesh->side[f][s]);
        add_counts(count, here.count);
    }
    for (uint32_t c = 0; c < mesh->cells; c++) {
        tm_fit_sum here = {{0}, 0};
        tm_fit_judge_cell(&w->m, c, &here);
        if (sum_of(here.count) > 0)
            try_nodes_of(w, c);
        add_counts(count, here.count);
    }
}

static bool add_cell(fitter *w, uint32_t c)
{
    for (size_t i = 0; i < w->cells; i++)
        if (w->cell[i] == c)
            return true;
    return c == TM_NONE || tm_append(&w->cell, &w->cells, &w->cell_room, c);
}

/* What moves with a node. */
static bool gather(fitter *w, uint32_t v)
{
    const tm_poly_arrays *mesh = w->m.mesh;
    bool done = true;
    w->cells = w->arounds = 0;
    for (size_t i = w->start[v]; i < w->start[v + 1] && done; i++)
        for (int s = 0; s < 2 && done; s++)
            done = add_cell(w, mesh->side[w->facet[i]][s]);
    for (size_t i = 0; i < w->cells && done; i++)
        for (size_t k = mesh->cell_start[w->cell[i]];
             k < mesh->cell_start[w->cell[i] + 1] && done; k++) {
            const uint32_t f = mesh->cell_facet[k];
            if (w->stamp[f] != v)
                done = tm_append(&w->around, &w->arounds, &w->around_room, f);
            w->stamp[f] = v;
        }
    for (size_t i = 0; i < w->arounds; i++)
        w->stamp[w->around[i]] = TM_NONE;
    const size_t facets = w->start[v + 1] - w->start[v];
    tm_facet_centroid *old =
        tm_grow(w->old_facet, &w->old_facet_room, facets, sizeof *old);
    w->old_facet = old ? old : w->old_facet;
    tm_cell_centroid *cell =
        tm_grow(w->old_cell, &w->old_cell_room, w->cells, sizeof *cell);
    w->old_cell = cell ? cell : w->old_cell;
    return done && old && cell;
}

static tm_fit_sum judge(const fitter *w)
{
    tm_fit_sum sum = {{0}, 0};
    for (size_t i = 0; i < w->arounds; i++)
        tm_fit_judge_facet(&w->m, w->around[i], &sum);
    for (size_t i = 0; i < w->cells; i++)
        tm_fit_judge_cell(&w->m, w->cell[i], &sum);
    return sum;
}

static void put(fitter *w, uint32_t v, const double at[3])
{
    memcpy(w->xyz[v], at, sizeof w->xyz[v]);
    for (size_t i = w->start[v]; i < w->start[v + 1]; i++)
        tm_facet_centroid_find(&w->m, w->facet[i]);
    for (size_t i = 0; i < w->cells; i++)
        tm_cell_centroid_find(&w->m, w->cell[i]);
}

static void save(const fitter *w, uint32_t v)
{
    for (size_t i = w->start[v]; i < w->start[v + 1]; i++)
        w->old_facet[i - w->start[v]] = w->m.face[w->facet[i]];
    for (size_t i = 0; i < w->cells; i++)
        w->old_cell[i] = w->m.cell[w->cell[i]];
}

static void restore(fitter *w, uint32_t v, const double at[3])
{
    memcpy(w->xyz[v], at, sizeof w->xyz[v]);
    for (size_t i = w->start[v]; i < w->start[v + 1]; i++)
        w->m.face[w->facet[i]] = w->old_facet[i - w->start[v]];
    for (size_t i = 0; i < w->cells; i++)
        w->m.cell[w->cell[i]] = w->old_cell[i];
}

static bool is_better(const tm_fit_sum *now, const tm_fit_sum *before)
{
    for (int k = 0; k < TM_FIT_FAULTS; k++)
        if (now->count[k] > before->count[k])
            return false;
    return now->missing < before->missing;
}

/* The shortest side of the facets at a node. */
static double edge_length(const fitter *w, uint32_t v)
{
    const tm_poly_arrays *mesh = w->m.mesh;
    double least = HUGE_VAL;
    for (size_t i = w->start[v]; i < w->start[v + 1]; i++) {
        const uint32_t f = w->facet[i];
        const size_t from = mesh->facet_start[f], count = mesh->facet_start[f + 1] - from;
        for (size_t k = 0; k < count; k++) {
            const uint32_t a = mesh->facet_node[from + k];
            const uint32_t b = mesh->facet_node[from + (k + 1) % count];
            if (a == v || b == v)
                least = fmin(least, tm_distance2(w->xyz[a], w->xyz[b]));
        }
    }
    return sqrt(least);
}

/* Steps along the axes, shorter and shorter. Whether the node moved. */
static bool move_node(fitter *w, uint32_t v)
{
    const double longest = 0.2, shortest = 0.001;
    const double edge = edge_length(w, v);
    tm_fit_sum best = judge(w);
    bool moved = false;
    for (double step = longest; step > shortest && best.missing > 0; step /= 2) {
        for (int d = 0; d < 6 && best.missing > 0; d++) {
            double at[3], old[3];
            memcpy(old, w->xyz[v], sizeof old);
            memcpy(at, old, sizeof at);
            at[d / 2] += (d % 2 ? -1 : 1) * step * edge;
            save(w, v);
            put(w, v, at);
            const tm_fit_sum now = judge(w);
            if (is_better(&now, &best)) {
                best = now;
                moved = true;
            } else
                restore(w, v, old);
        }
    }
    return moved;
}

/* Marks the nodes of all cells with a node that is marked. */
static bool widen(fitter *w)
{
    const size_t nodes = w->m.mesh->nodes;
    bool *marked = tm_new(nodes, sizeof *marked);
    if (!marked)
        return false;
    memcpy(marked, w->tried, nodes * sizeof *marked);
    for (size_t v = 0; v < nodes; v++)
        for (size_t i = w->start[v]; i < w->start[v + 1] && marked[v]; i++)
            for (int s = 0; s < 2; s++)
                try_nodes_of(w, w->m.mesh->side[w->facet[i]][s]);
    free(marked);
    return true;
}

static bool fit(fitter *w, tm_fit_report *r)
{
    const int near = 4, wide = 4; /* rounds */
    size_t moved = 1;
    bool done = true;
    memcpy(r->after, r->before, sizeof r->after);
    for (int i = 0; i < near + wide && sum_of(r->after) > 0 && done; i++) {
        if (moved == 0 && i >= near)
            break;
        moved = 0;
        done = i < near || widen(w);
        for (uint32_t v = 0; v < w->m.mesh->nodes && done; v++) {
            if (!w->tried[v])
                continue;
            done = gather(w, v);
            moved += done && move_node(w, v);
        }
        r->moved += moved;
        find_faults(w, r->after);
    }
    return done;
}

tm_status tm_polyhedra_fit(const tm_poly_arrays *mesh, double (*xyz)[3],
                           const bool *fixed, tm_fit_report *report, tm_error *error)
{
    fitter w = {.xyz = xyz, .fixed = fixed};
    *report = (tm_fit_report){0};
    tm_status status = tm_poly_centroids_find(&w.m, mesh, error);
    if (status == TM_OK && !list_facets_of_nodes(&w))
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        find_faults(&w, report->before);
        status = fit(&w, report) ? TM_OK : tm_fail_memory(error);
    }
    free_fitter(&w);
    return status;
}

size_t tm_fit_faults_left(const tm_fit_report *report)
{
    return sum_of(report->after);
}

void tm_fit_faults_say(const tm_fit_report *report, char *text, size_t size)
{
    static const char *const what[TM_FIT_FAULTS] = {
        [TM_FIT_PYRAMID] = "pyramids of no volume",
        [TM_FIT_BENT] = "facets bent beyond a centroid",
        [TM_FIT_TETRAHEDRA] = "facets that do not divide into tetrahedra",
        [TM_FIT_CONCAVE] = "concave cells",
        [TM_FIT_OBLIQUE] = "facets above 70 degrees",
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
