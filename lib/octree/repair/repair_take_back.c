/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moves of nodes are judged piece by piece: what fails in one place takes nothing back in
 * another. A piece is the elements with a node that has moved, joined by such nodes. */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../geom/place_order.h"
#include "../../geom/vector.h"
#include "../../stream/stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_repair_state *state;
    const tm_repair_points *before;
    double threshold;
    double worst;                /* J_ENS of the whole mesh, before */
    uint32_t *root;              /* [nodes]: of those that moved; else TM_NONE */
    tm_repair_score (*score)[2]; /* [nodes]: of the piece at a root, before and after */
} judge;

static bool has_moved(const judge *j, size_t v)
{
    return tm_distance2(j->before->xyz[v], j->state->mesh.xyz[v]) > 0 ||
           j->before->rule[v].off_surface != j->state->rule[v].off_surface ||
           j->before->rule[v].where != j->state->rule[v].where;
}

static void find_pieces(judge *j)
{
    const tm_mixed_mesh *mesh = &j->state->mesh;
    for (size_t v = 0; v < mesh->nodes; v++)
        j->root[v] = has_moved(j, v) ? (uint32_t)v : TM_NONE;
    for (size_t e = 0; e < mesh->elements; e++) {
        uint32_t first = TM_NONE;
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
            const uint32_t v = mesh->item[i];
            if (j->root[v] == TM_NONE)
                continue;
            if (first == TM_NONE)
                first = v;
            tm_set_unite(j->root, first, v);
        }
    }
}

/* The piece that an element is in; TM_NONE: none of its nodes moved. */
static uint32_t piece_of(const judge *j, size_t e)
{
    const tm_mixed_mesh *mesh = &j->state->mesh;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (j->root[mesh->item[i]] != TM_NONE)
            return tm_set_root(j->root, mesh->item[i]);
    return TM_NONE;
}

static double add(const judge *j, const tm_mixed_mesh *mesh, size_t e,
                  tm_repair_score *score)
{
    const double jens = tm_mixed_jens(mesh, e);
    const double quality = tm_repair_quality(mesh, e, jens);
    score->invalid += quality < TM_REPAIR_LEAST;
    score->bad += quality < TM_REPAIR_LEAST || jens < j->threshold;
    score->least = fmin(score->least, quality);
    score->worst = fmin(score->worst, jens);
    return jens;
}

/* Measures the pieces, before and after. */
static void measure(judge *j)
{
    const tm_mixed_mesh *now = &j->state->mesh;
    tm_mixed_mesh old = *now;
    old.xyz = j->before->xyz;
    for (size_t v = 0; v < now->nodes; v++)
        for (int i = 0; i < 2; i++)
            j->score[v][i] = (tm_repair_score){.least = 1, .worst = 1};
    for (size_t v = 0; v < now->nodes; v++) {
        if (j->root[v] == TM_NONE)
            continue;
        tm_repair_score *score = j->score[tm_set_root(j->root, (uint32_t)v)];
        score[0].off_surface += j->before->rule[v].off_surface;
        score[1].off_surface += j->state->rule[v].off_surface;
    }
    for (size_t e = 0; e < now->elements; e++) {
        const uint32_t piece = piece_of(j, e);
        if (piece == TM_NONE)
            continue;
        const double was = add(j, &old, e, &j->score[piece][0]);
        const double is = add(j, now, e, &j->score[piece][1]);
        if (is < TM_REPAIR_FLAT && is < was && was >= TM_REPAIR_FLAT)
            j->score[piece][1].least = -INFINITY; /* never */
    }
}

static void restore(const judge *j, size_t v)
{
    memcpy(j->state->mesh.xyz[v], j->before->xyz[v], sizeof *j->before->xyz);
    j->state->rule[v] = j->before->rule[v];
}

/* Takes back nodes of the boundary that have come to where another one is: elements do
 * not tell where they have none in common. */
static tm_status take_back_doubles(const judge *j, tm_error *error)
{
    const tm_mixed_mesh *mesh = &j->state->mesh;
    size_t count = 0;
    tm_placed *list = tm_new(mesh->nodes, sizeof *list);
    if (!list)
        return tm_fail_memory(error);
    for (size_t v = 0; v < mesh->nodes; v++) {
        if (j->state->rule[v].freedom == TM_MOVES_FREELY)
            continue;
        memcpy(list[count].xyz, mesh->xyz[v], sizeof list->xyz);
        list[count++].item = (uint32_t)v;
    }
    tm_place_sort(list, count);
    for (size_t i = 1; i < count; i++)
        if (tm_distance2(list[i - 1].xyz, list[i].xyz) == 0) {
            restore(j, list[i - 1].item);
            restore(j, list[i].item);
        }
    free(list);
    return TM_OK;
}

/* What elements of a piece may fall to: half of the worst there, if the whole mesh has
 * such, or it is good still. */
static double find_good(const judge *j, uint32_t piece)
{
    const double worst = j->score[piece][0].worst;
    const double half = worst < TM_REPAIR_FLAT ? worst : fmax(worst / 2, TM_REPAIR_FLAT);
    return fmax(half, fmin(j->worst, fmax(j->threshold, TM_REPAIR_GOOD)));
}

/* Whether a piece stays as it is now. */
static bool is_kept(const judge *j, uint32_t piece)
{
    tm_repair_score was = j->score[piece][0];
    was.good = find_good(j, piece);
    was.valid = j->state->lenient ? TM_REPAIR_FLAT : TM_REPAIR_GOOD;
    return tm_repair_better(&j->score[piece][1], &was);
}

static bool fell(double is, double was, double good)
{
    return is < was && is < good;
}

/* Whether an element of a piece that does not stay is worse than it was. */
static bool is_worse(const judge *j, size_t e)
{
    const tm_mixed_mesh *now = &j->state->mesh;
    tm_mixed_mesh old = *now;
    old.xyz = j->before->xyz;
    const double is = tm_mixed_jens(now, e), was = tm_mixed_jens(&old, e);
    const double good =
        fmax(j->threshold, fmax(find_good(j, piece_of(j, e)), TM_REPAIR_FLAT));
    return fell(is, was, good) ||
           fell(tm_repair_quality(now, e, is), tm_repair_quality(&old, e, was), good);
}

/* Takes back the nodes of an element; says whether there was one. */
static bool take_back(const judge *j, size_t e)
{
    const tm_mixed_mesh *mesh = &j->state->mesh;
    bool any = false;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
        const uint32_t v = mesh->item[i];
        if (j->root[v] == TM_NONE || !has_moved(j, v))
            continue;
        restore(j, v);
        any = true;
    }
    return any;
}

/* In pieces that do not stay, what makes an element worse is taken back, until there is
 * none: at the latest all is. `list` is of their elements. */
static void take_back_worse(const judge *j, const uint32_t *list, size_t elements)
{
    for (bool any = true; any;) {
        any = false;
        for (size_t i = 0; i < elements; i++)
            if (is_worse(j, list[i]))
                any |= take_back(j, list[i]);
    }
}

tm_status tm_repair_take_back(tm_repair_state *state, const tm_repair_points *before,
                              double threshold, double worst, tm_error *error)
{
    const size_t nodes = state->mesh.nodes, elements = state->mesh.elements;
    judge j = {state,
               before,
               threshold,
               worst,
               tm_new(nodes, sizeof *j.root),
               tm_new(nodes, sizeof *j.score)};
    uint32_t *list = tm_new(elements, sizeof *list);
    size_t count = 0;
    tm_status status = j.root && j.score && list ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = take_back_doubles(&j, error);
    if (status == TM_OK) {
        find_pieces(&j);
        measure(&j);
        for (uint32_t e = 0; e < elements; e++) {
            const uint32_t piece = piece_of(&j, e);
            if (piece != TM_NONE && !is_kept(&j, piece))
                list[count++] = e;
        }
        take_back_worse(&j, list, count);
    }
    free(j.root);
    free(j.score);
    free(list);
    return status;
}
