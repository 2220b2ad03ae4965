/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"
#include "sharp_corner.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../stream/stream.h"

#include <stdlib.h>
#include <string.h>

/* How far around a tip nodes may move, and how many elements are at the middle. */
enum { RINGS = 2, CORE_MOST = 24, EFFORT = 1 };

typedef struct {
    tm_repair_state *state;
    const tm_surface *surface;
    double threshold;
    tm_node_elements around;
    tm_trial trial;
} corners;

static bool is_bad_at(const corners *t, uint32_t v)
{
    const tm_mixed_mesh *mesh = &t->state->mesh;
    for (size_t a = t->around.start[v]; a < t->around.start[v + 1]; a++) {
        const size_t e = t->around.element[a];
        const double jens = tm_mixed_jens(mesh, e);
        if (tm_repair_is_bad(mesh, e, jens, t->threshold))
            return true;
    }
    return false;
}

static bool has_node(const tm_mixed_mesh *mesh, size_t e, uint32_t v)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (mesh->item[i] == v)
            return true;
    return false;
}

/* The node inside that all elements at a node of the boundary have; TM_NONE where there
 * is none, or there are many. */
static uint32_t find_middle(const corners *t, uint32_t corner)
{
    enum { FEW = 4 };
    const tm_mixed_mesh *mesh = &t->state->mesh;
    const size_t from = t->around.start[corner], to = t->around.start[corner + 1];
    if (to - from < 3 || to - from > FEW)
        return TM_NONE;
    const size_t first = t->around.element[from];
    for (size_t i = mesh->start[first]; i < mesh->start[first + 1]; i++) {
        const uint32_t v = mesh->item[i];
        bool all = t->state->rule[v].freedom == TM_MOVES_FREELY;
        for (size_t a = from; a < to && all; a++)
            all = has_node(mesh, t->around.element[a], v);
        if (all && t->around.start[v + 1] - t->around.start[v] <= CORE_MOST)
            return v;
    }
    return TM_NONE;
}

static uint32_t local_of(const tm_trial *trial, uint32_t v)
{
    uint32_t i = 0;
    while (trial->node[i] != v)
        i++;
    return i;
}

/* Puts parts in place of the first `cores` elements of a mesh; the arrays are large
 * enough. */
static void replace_first(tm_mixed_mesh *mesh, size_t cores, const tm_sharp_corner *parts)
{
    const size_t old = mesh->start[cores], now = parts->start[parts->parts];
    const size_t rest = mesh->elements - cores;
    memmove(mesh->item + now, mesh->item + old,
            (mesh->start[mesh->elements] - old) * sizeof *mesh->item);
    memcpy(mesh->item, parts->item, now * sizeof *mesh->item);
    memmove(mesh->start + parts->parts, mesh->start + cores,
            (rest + 1) * sizeof *mesh->start);
    for (size_t e = 0; e <= rest; e++)
        mesh->start[parts->parts + e] += now - old;
    memcpy(mesh->start, parts->start, parts->parts * sizeof *mesh->start);
    mesh->elements = parts->parts + rest;
}

static bool is_in(const uint32_t *list, size_t count, size_t e)
{
    for (size_t i = 0; i < count; i++)
        if (list[i] == e)
            return true;
    return false;
}

static tm_status allocate(tm_repair_state *to, size_t elements, size_t items,
                          tm_error *error)
{
    to->mesh.start = tm_new(elements + 1, sizeof *to->mesh.start);
    to->mesh.item = tm_new(items, sizeof *to->mesh.item);
    to->octant = tm_new(elements, sizeof *to->octant);
    to->origin = tm_new(elements, sizeof *to->origin);
    return to->mesh.start && to->mesh.item && to->octant && to->origin
               ? TM_OK
               : tm_fail_memory(error);
}

static void copy_element(tm_repair_state *to, const tm_repair_state *from,
                         size_t octant_of, size_t k, const uint32_t *item)
{
    tm_mixed_mesh *mesh = &to->mesh;
    const size_t first = mesh->start[mesh->elements];
    memcpy(mesh->item + first, item, k * sizeof *item);
    to->octant[mesh->elements] = from->octant[octant_of];
    to->origin[mesh->elements] = from->origin[octant_of];
    mesh->start[++mesh->elements] = first + k;
}

/* Puts the parts, with nodes of the trial, in the place of the first element of `core`,
 * and drops the others. */
static tm_status replace(const corners *t, const uint32_t *core, size_t cores,
                         const tm_sharp_corner *parts, tm_error *error)
{
    tm_repair_state *state = t->state, to = {0};
    const tm_mixed_mesh *mesh = &state->mesh;
    const size_t items = parts->start[parts->parts];
    const tm_status status = allocate(&to, mesh->elements + parts->parts,
                                      mesh->start[mesh->elements] + items, error);
    if (status != TM_OK) {
        tm_repair_state_free(&to);
        return status;
    }
    to.mesh.start[0] = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        if (!is_in(core, cores, e)) {
            copy_element(&to, state, e, mesh->start[e + 1] - mesh->start[e],
                         mesh->item + mesh->start[e]);
            continue;
        }
        for (size_t p = 0; e == core[0] && p < parts->parts; p++) {
            uint32_t node[TM_ELEMENT_NODES];
            const size_t k = parts->start[p + 1] - parts->start[p];
            for (size_t i = 0; i < k; i++)
                node[i] = t->trial.node[parts->item[parts->start[p] + i]];
            copy_element(&to, state, e, k, node);
        }
    }
    free(state->mesh.start);
    free(state->mesh.item);
    free(state->octant);
    free(state->origin);
    state->mesh.start = to.mesh.start;
    state->mesh.item = to.mesh.item;
    state->mesh.elements = to.mesh.elements;
    state->octant = to.octant;
    state->origin = to.origin;
    state->divided = true;
    return TM_OK;
}

/* Tries one tip; *done says whether it is other now. */
static tm_status try_sharp_corner(corners *t, uint32_t corner, uint32_t middle,
                                  bool *done, tm_error *error)
{
    uint32_t core[CORE_MOST];
    const size_t from = t->around.start[middle];
    const size_t cores = t->around.start[middle + 1] - from;
    memcpy(core, t->around.element + from, cores * sizeof *core); /* ascending */
    tm_repair_state *part = &t->trial.part;
    tm_status status = tm_trial_gather(&t->trial, core, cores, RINGS, error);
    if (status != TM_OK)
        return status;
    tm_sharp_corner parts;
    uint32_t first[CORE_MOST];
    for (size_t i = 0; i < cores; i++)
        first[i] = (uint32_t)i;
    if (!tm_sharp_corner_divide(&parts, &part->mesh, first, cores,
                                local_of(&t->trial, corner), local_of(&t->trial, middle)))
        return TM_OK;
    const tm_repair_score before = tm_repair_measure(part, t->threshold);
    replace_first(&part->mesh, cores, &parts);
    tm_repair_score after = tm_repair_measure(part, t->threshold);
    status = tm_repair_move(part, t->surface, t->threshold, t->threshold, EFFORT, &after,
                            error);
    if (status != TM_OK || !tm_repair_better(&after, &before))
        return status;
    tm_trial_commit(&t->trial);
    *done = true;
    return replace(t, core, cores, &parts, error);
}

tm_status tm_repair_sharp_corners(tm_repair_state *state, const tm_surface *surface,
                                  double threshold, tm_repair_score *score, size_t *count,
                                  tm_error *error)
{
    corners t = {.state = state, .surface = surface, .threshold = threshold};
    bool any = false;
    tm_status status = tm_node_elements_find(&t.around, &state->mesh, error);
    t.trial = (tm_trial){.whole = state, .around = &t.around};
    for (uint32_t v = 0; status == TM_OK && v < state->mesh.nodes; v++) {
        if (state->place[v] == 0 || !is_bad_at(&t, v))
            continue;
        const uint32_t middle = find_middle(&t, v);
        bool done = false;
        if (middle != TM_NONE)
            status = try_sharp_corner(&t, v, middle, &done, error);
        if (!done || status != TM_OK)
            continue;
        any = true;
        (*count)++;
        tm_trial_free(&t.trial);
        t.trial = (tm_trial){.whole = state, .around = &t.around};
        tm_node_elements_free(&t.around);
        status = tm_node_elements_find(&t.around, &state->mesh, error);
    }
    tm_trial_free(&t.trial);
    tm_node_elements_free(&t.around);
    if (status == TM_OK && any)
        *score = tm_repair_measure(state, threshold);
    return status;
}
