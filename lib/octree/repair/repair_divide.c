/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../../base/ids.h"
#include "../../element/shape.h"
#include "../../stream/stream.h"
#include "../../mesh/mixed_boundary.h"
#include "element_division.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Elements as good are not divided, whatever the threshold is: parts are no better. */
static const double not_divided = 0.5;

/* An element and its parts. */
typedef struct {
    uint32_t element;
    tm_division parts;
} division;

typedef struct {
    tm_repair_state *state;
    double threshold;
    uint32_t *face; /* those of the boundary */
    size_t faces;
    division *division; /* by element, ascending */
    size_t divisions, room;
} divider;

/* The faces of an element that are on the boundary, as bits; `next` is the first boundary
 * face that may be of it. */
static unsigned find_open(const divider *d, size_t e, size_t *next)
{
    unsigned open = 0;
    while (*next < d->faces && d->face[*next] >> TM_FACE_SHIFT < e)
        (*next)++;
    for (; *next < d->faces && d->face[*next] >> TM_FACE_SHIFT == e; (*next)++)
        open |= 1U << (d->face[*next] & ((1U << TM_FACE_SHIFT) - 1));
    return open;
}

static tm_status add_division(divider *d, size_t e, double jens, unsigned open,
                              tm_error *error)
{
    division *grown = tm_grow(d->division, &d->room, d->divisions + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    d->division = grown;
    division *here = &grown[d->divisions];
    here->element = (uint32_t)e;
    const tm_status status = tm_division_find(&here->parts, &d->state->mesh, e, open,
                                              fmax(d->threshold, TM_REPAIR_FLAT), error);
    const double quality = tm_repair_quality(&d->state->mesh, e, jens);
    d->divisions += here->parts.worst > quality &&
                    here->parts.worst >= fmin(jens, TM_REPAIR_FLAT) &&
                    (here->parts.low <= 1 || quality < TM_REPAIR_LEAST);
    return status;
}

static tm_status find_divisions(divider *d, tm_error *error)
{
    const tm_mixed_mesh *mesh = &d->state->mesh;
    size_t next = 0;
    tm_status status = tm_mixed_boundary_faces(mesh, &d->face, &d->faces, error);
    for (size_t e = 0;
         status == TM_OK && e < mesh->elements && !tm_stop_is_wanted(d->state->stop);
         e++) {
        const double jens = tm_mixed_jens(mesh, e);
        if (mesh->start[e + 1] - mesh->start[e] > TM_TET_NODES &&
            tm_repair_is_bad(mesh, e, jens, fmin(d->threshold, not_divided)))
            status = add_division(d, e, jens, find_open(d, e, &next), error);
    }
    return status;
}

static void add_element(tm_repair_state *to, size_t k, const uint32_t *item,
                        uint32_t middle, const tm_repair_state *from, size_t e)
{
    tm_mixed_mesh *mesh = &to->mesh;
    size_t end = mesh->start[mesh->elements];
    for (size_t i = 0; i < k; i++)
        mesh->item[end++] = item[i] == TM_NONE ? middle : item[i];
    to->octant[mesh->elements] = from->octant[e];
    to->origin[mesh->elements] = from->origin[e];
    mesh->start[++mesh->elements] = end;
}

/* The mesh with the divisions; octree and rows are not copied. */
static tm_status apply(const divider *d, tm_repair_state *to, tm_error *error)
{
    const tm_repair_state *from = d->state;
    const tm_mixed_mesh *mesh = &from->mesh;
    size_t items = mesh->start[mesh->elements];
    to->mesh.nodes = mesh->nodes + d->divisions;
    to->mesh.elements = mesh->elements;
    for (size_t i = 0; i < d->divisions; i++) {
        to->mesh.elements += d->division[i].parts.parts;
        items += d->division[i].parts.start[d->division[i].parts.parts];
    }
    if (to->mesh.nodes >= TM_IDS || to->mesh.elements >= TM_IDS)
        return tm_fail(error, TM_ERROR_SYSTEM, "the mesh has too many elements");
    const tm_status status = tm_repair_allocate(to, items, error);
    if (status != TM_OK)
        return status;
    memcpy(to->mesh.xyz, mesh->xyz, mesh->nodes * sizeof *mesh->xyz);
    memcpy(to->rule, from->rule, mesh->nodes * sizeof *from->rule);
    memcpy(to->on, from->on, mesh->nodes * sizeof *from->on);
    to->mesh.elements = 0;
    to->mesh.start[0] = 0;
    for (size_t e = 0, i = 0; e < mesh->elements; e++) {
        if (i == d->divisions || d->division[i].element != e) {
            add_element(to, mesh->start[e + 1] - mesh->start[e],
                        mesh->item + mesh->start[e], TM_NONE, from, e);
            continue;
        }
        const tm_division *parts = &d->division[i].parts;
        const size_t middle = mesh->nodes + i++;
        memcpy(to->mesh.xyz[middle], parts->middle, sizeof parts->middle);
        to->rule[middle] = (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_FREELY};
        to->on[middle] = 0;
        for (size_t p = 0; p < parts->parts; p++)
            add_element(to, parts->start[p + 1] - parts->start[p],
                        parts->item + parts->start[p], (uint32_t)middle, from, e);
    }
    return TM_OK;
}

tm_status tm_repair_divide(tm_repair_state *state, const tm_surface *surface,
                           double threshold, tm_repair_score *score, size_t *divided,
                           tm_error *error)
{
    const tm_repair_effort effort = {1, TM_REPAIR_GOOD, 1, 4000, 200000};
    divider d = {.state = state, .threshold = threshold};
    tm_repair_state made = {.progress = state->progress,
                            .stop = state->stop,
                            .rest = state->rest,
                            .lenient = state->lenient};
    tm_progress_stage(state->progress, "dividing elements");
    tm_status status = find_divisions(&d, error);
    if (status == TM_OK && d.divisions > 0)
        status = apply(&d, &made, error);
    if (status == TM_OK && d.divisions > 0) {
        tm_repair_score now = tm_repair_measure(&made, threshold);
        status = tm_repair_move(&made, surface, threshold, effort, &now, error);
        if (status == TM_OK && tm_repair_better(&now, score)) {
            *score = now;
            *divided += d.divisions;
            made.divided = true;
            tm_repair_take_mesh(state, &made);
        }
    }
    tm_repair_state_free(&made);
    free(d.face);
    free(d.division);
    return status;
}
