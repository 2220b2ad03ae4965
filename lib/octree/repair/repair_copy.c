/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../../stream/stream.h"

#include <string.h>

tm_status tm_repair_allocate(tm_repair_state *to, size_t items, tm_error *error)
{
    to->mesh.xyz = tm_new(to->mesh.nodes, sizeof *to->mesh.xyz);
    to->rule = tm_new(to->mesh.nodes, sizeof *to->rule);
    to->on = tm_new(to->mesh.nodes, sizeof *to->on);
    to->mesh.start = tm_new(to->mesh.elements + 1, sizeof *to->mesh.start);
    to->mesh.item = tm_new(items, sizeof *to->mesh.item);
    to->octant = tm_new(to->mesh.elements, sizeof *to->octant);
    to->origin = tm_new(to->mesh.elements, sizeof *to->origin);
    return to->mesh.xyz && to->rule && to->on && to->mesh.start && to->mesh.item &&
                   to->octant && to->origin
               ? TM_OK
               : tm_fail_memory(error);
}

tm_status tm_repair_copy_mesh(tm_repair_state *to, const tm_repair_state *from,
                              tm_error *error)
{
    const size_t nodes = from->mesh.nodes, elements = from->mesh.elements;
    const size_t items = from->mesh.start[elements];
    to->mesh.nodes = nodes;
    to->mesh.elements = elements;
    to->mesh.threads = from->mesh.threads;
    to->divided = from->divided;
    to->progress = from->progress;
    to->stop = from->stop;
    to->rest = from->rest;
    to->lenient = from->lenient;
    const tm_status status = tm_repair_allocate(to, items, error);
    if (status != TM_OK)
        return status;
    memcpy(to->mesh.xyz, from->mesh.xyz, nodes * sizeof *to->mesh.xyz);
    memcpy(to->mesh.start, from->mesh.start, (elements + 1) * sizeof *to->mesh.start);
    memcpy(to->mesh.item, from->mesh.item, items * sizeof *to->mesh.item);
    memcpy(to->rule, from->rule, nodes * sizeof *to->rule);
    memcpy(to->on, from->on, nodes * sizeof *to->on);
    memcpy(to->octant, from->octant, elements * sizeof *to->octant);
    memcpy(to->origin, from->origin, elements * sizeof *to->origin);
    return TM_OK;
}

void tm_repair_take_mesh(tm_repair_state *state, tm_repair_state *by)
{
    by->octree = state->octree;
    by->row = state->row;
    by->id = state->id;
    by->remade = state->remade;
    state->octree = (tm_octree){.leaves = 0};
    state->row = NULL;
    state->id = NULL;
    tm_repair_state_free(state);
    *state = *by;
    *by = (tm_repair_state){0};
}
