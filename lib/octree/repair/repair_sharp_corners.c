/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"
#include "sharp_corner.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../stream/stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How far around a tip nodes may move, and how many elements are at the middle. */
enum { RINGS = 2, CORE_MOST = 24 };

/* Elements at a tip that are as good are not made anew, whatever the threshold is: it is
 * not sharp. */
static const double not_sharp = 0.3;
static const tm_repair_effort effort[] = {{1, TM_REPAIR_GOOD, 1, 0, 15000},
                                          {1, TM_REPAIR_GOOD, 1, 0, 20000}}; /* whole */

/* What comes in the place of one element, with nodes of the whole mesh. */
typedef struct {
    uint32_t first;
    tm_sharp_corner parts;
} replacement;

/* The mesh is made anew of all replacements at once, as soon as something is tried where
 * there is one already, and at the end. */
typedef struct {
    tm_repair_state *state;
    const tm_surface *surface;
    double threshold;
    tm_node_elements around; /* without the replacements */
    tm_trial trial;
    replacement *made;
    size_t count, room;
    bool *gone;    /* [elements]: replaced, or dropped */
    bool *touched; /* [nodes]: of an element that is gone */
} corners;

static bool is_bad(const corners *t, const tm_mixed_mesh *mesh, size_t e)
{
    return tm_repair_is_bad(mesh, e, tm_mixed_jens(mesh, e),
                            fmin(t->threshold, not_sharp));
}

static bool has_node(const tm_mixed_mesh *mesh, size_t e, uint32_t v)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (mesh->item[i] == v)
            return true;
    return false;
}

static bool is_bad_at(const corners *t, uint32_t v)
{
    const tm_mixed_mesh *mesh = &t->state->mesh;
    for (size_t a = t->around.start[v]; a < t->around.start[v + 1]; a++) {
        const size_t e = t->around.element[a];
        if (!t->gone[e] && is_bad(t, mesh, e))
            return true;
    }
    for (size_t i = 0; t->touched[v] && i < t->count; i++) {
        tm_sharp_corner *parts = &t->made[i].parts;
        const tm_mixed_mesh made = {.nodes = mesh->nodes,
                                    .xyz = mesh->xyz,
                                    .elements = parts->parts,
                                    .start = parts->start,
                                    .item = parts->item};
        for (size_t p = 0; p < parts->parts; p++)
            if (has_node(&made, p, v) && is_bad(t, &made, p))
                return true;
    }
    return false;
}

/* Whether an element at a node has a node that is touched. */
static bool is_touched_near(const corners *t, uint32_t v)
{
    const tm_mixed_mesh *mesh = &t->state->mesh;
    for (size_t a = t->around.start[v]; a < t->around.start[v + 1]; a++) {
        const size_t e = t->around.element[a];
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            if (t->touched[mesh->item[i]])
                return true;
    }
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

/* Appends element e, or a part of what comes in its place. */
static void add_element(tm_repair_state *to, const tm_repair_state *from, size_t e,
                        size_t k, const uint32_t *item)
{
    tm_mixed_mesh *mesh = &to->mesh;
    const size_t first = mesh->start[mesh->elements];
    memcpy(mesh->item + first, item, k * sizeof *item);
    to->octant[mesh->elements] = from->octant[e];
    to->origin[mesh->elements] = from->origin[e];
    mesh->start[++mesh->elements] = first + k;
}

static const replacement *find_made(const corners *t, size_t e)
{
    for (size_t i = 0; i < t->count; i++)
        if (t->made[i].first == e)
            return &t->made[i];
    return NULL;
}

/* The elements with their replacements; `to` has zeros. */
static tm_status apply(const corners *t, tm_repair_state *to, tm_error *error)
{
    const tm_repair_state *from = t->state;
    const tm_mixed_mesh *mesh = &from->mesh;
    size_t elements = mesh->elements, items = mesh->start[mesh->elements];
    for (size_t i = 0; i < t->count; i++) {
        elements += t->made[i].parts.parts;
        items += t->made[i].parts.start[t->made[i].parts.parts];
    }
    const tm_status status = allocate(to, elements, items, error);
    if (status != TM_OK)
        return status;
    to->mesh.start[0] = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        if (!t->gone[e])
            add_element(to, from, e, mesh->start[e + 1] - mesh->start[e],
                        mesh->item + mesh->start[e]);
        const replacement *made = t->gone[e] ? find_made(t, e) : NULL;
        for (size_t p = 0; made && p < made->parts.parts; p++)
            add_element(to, from, e, made->parts.start[p + 1] - made->parts.start[p],
                        made->parts.item + made->parts.start[p]);
    }
    return TM_OK;
}

/* Finds what is around nodes, without replacements. */
static tm_status begin(corners *t, tm_error *error)
{
    const tm_mixed_mesh *mesh = &t->state->mesh;
    t->count = 0;
    t->trial = (tm_trial){.whole = t->state, .around = &t->around};
    t->gone = calloc(mesh->elements + 1, sizeof *t->gone);
    t->touched = calloc(mesh->nodes + 1, sizeof *t->touched);
    return t->gone && t->touched ? tm_node_elements_find(&t->around, mesh, error)
                                 : tm_fail_memory(error);
}

static void end(corners *t)
{
    tm_trial_free(&t->trial);
    tm_node_elements_free(&t->around);
    free(t->gone);
    free(t->touched);
    t->gone = t->touched = NULL;
}

/* Makes the mesh anew if there are replacements. */
static tm_status renew(corners *t, tm_error *error)
{
    tm_repair_state *state = t->state, to = {0};
    if (t->count == 0)
        return TM_OK;
    tm_status status = apply(t, &to, error);
    if (status == TM_OK) {
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
        end(t);
        return begin(t, error);
    }
    tm_repair_state_free(&to);
    return status;
}

/* Notes that parts, with nodes of the trial, come in the place of the first element of
 * `core`, and nothing in that of the others. */
static tm_status add_replacement(corners *t, const uint32_t *core, size_t cores,
                                 const tm_sharp_corner *parts, tm_error *error)
{
    const tm_mixed_mesh *mesh = &t->state->mesh;
    replacement *grown = tm_grow(t->made, &t->room, t->count + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    t->made = grown;
    replacement *made = &grown[t->count++];
    *made = (replacement){.first = core[0], .parts = *parts};
    for (size_t i = 0; i < parts->start[parts->parts]; i++)
        made->parts.item[i] = t->trial.node[parts->item[i]];
    for (size_t c = 0; c < cores; c++) {
        t->gone[core[c]] = true;
        for (size_t i = mesh->start[core[c]]; i < mesh->start[core[c] + 1]; i++)
            t->touched[mesh->item[i]] = true;
    }
    return TM_OK;
}

/* Gathers the elements at a node, the core, and those around; in a mesh made anew if
 * there is a replacement. */
static tm_status gather(corners *t, uint32_t middle, uint32_t core[CORE_MOST],
                        size_t *cores, tm_error *error)
{
    for (;;) {
        const size_t from = t->around.start[middle];
        *cores = t->around.start[middle + 1] - from;
        memcpy(core, t->around.element + from, *cores * sizeof *core); /* ascending */
        tm_status status = tm_trial_gather(&t->trial, core, *cores, RINGS, error);
        size_t n = 0;
        while (status == TM_OK && n < t->trial.nodes && !t->touched[t->trial.node[n]])
            n++;
        if (status != TM_OK || n == t->trial.nodes)
            return status;
        status = renew(t, error);
        if (status != TM_OK)
            return status;
    }
}

/* Makes the elements of the trial at a tip anew, and moves nodes; *parts has none where
 * that cannot be. */
static tm_status make_tip(corners *t, uint32_t corner, uint32_t middle, size_t cores,
                          bool whole, tm_sharp_corner *parts, tm_repair_score *after,
                          tm_error *error)
{
    uint32_t first[CORE_MOST];
    tm_repair_state *part = &t->trial.part;
    for (size_t i = 0; i < cores; i++)
        first[i] = (uint32_t)i;
    if (!tm_sharp_corner_divide(parts, &part->mesh, first, cores,
                                local_of(&t->trial, corner), local_of(&t->trial, middle),
                                whole)) {
        parts->parts = 0;
        return TM_OK;
    }
    replace_first(&part->mesh, cores, parts);
    *after = tm_repair_measure(part, t->threshold);
    return tm_repair_move(part, t->surface, t->threshold, effort[whole], after, error);
}

/* Tries one corner, with one element on all of the tip, and, where that leaves some bad,
 * without; counts it if it is other then. */
static tm_status try_sharp_corner(corners *t, uint32_t corner, uint32_t middle,
                                  size_t *count, tm_error *error)
{
    uint32_t core[CORE_MOST];
    size_t cores;
    tm_repair_points kept = {0};
    tm_sharp_corner best = {.parts = 0};
    tm_status status = gather(t, middle, core, &cores, error);
    tm_repair_score score;
    if (status == TM_OK)
        score = tm_repair_measure(&t->trial.part, t->threshold);
    for (int whole = 1; whole >= 0 && status == TM_OK && score.bad > 0; whole--) {
        tm_sharp_corner parts = {.parts = 0};
        tm_repair_score after;
        if (whole == 0)
            status = tm_trial_gather(&t->trial, core, cores, RINGS, error);
        if (status == TM_OK)
            status = make_tip(t, corner, middle, cores, whole, &parts, &after, error);
        if (status != TM_OK || parts.parts == 0 || !tm_repair_better(&after, &score))
            continue;
        best = parts;
        score = after;
        tm_repair_points_free(&kept);
        status = tm_repair_save(&kept, &t->trial.part, error);
    }
    if (status == TM_OK && best.parts > 0) {
        tm_repair_restore(&kept, &t->trial.part);
        tm_trial_commit(&t->trial);
        (*count)++;
        status = add_replacement(t, core, cores, &best, error);
    }
    tm_repair_points_free(&kept);
    return status;
}

tm_status tm_repair_sharp_corners(tm_repair_state *state, const tm_surface *surface,
                                  double threshold, tm_repair_score *score, size_t *count,
                                  tm_error *error)
{
    corners t = {.state = state, .surface = surface, .threshold = threshold};
    const size_t old = *count;
    tm_progress_at at = {.what = "making sharp tips anew", .of = state->mesh.nodes};
    tm_status status = begin(&t, error);
    for (uint32_t v = 0;
         status == TM_OK && v < state->mesh.nodes && !tm_stop_is_wanted(state->stop);
         v++) {
        tm_progress_step(state->progress, &at, v);
        if (state->on[v] == 0 || !is_bad_at(&t, v))
            continue;
        if (is_touched_near(&t, v))
            status = renew(&t, error);
        const uint32_t middle = status == TM_OK ? find_middle(&t, v) : TM_NONE;
        if (middle != TM_NONE)
            status = try_sharp_corner(&t, v, middle, count, error);
    }
    if (status == TM_OK && *count > old) {
        status = renew(&t, error);
        *score = tm_repair_measure(state, threshold);
    }
    end(&t);
    free(t.made);
    return status;
}
