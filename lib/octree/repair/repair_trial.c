/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_trial.h"

#include "../../base/array.h"
#include "../../stream/stream.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_NODES = 8 };

tm_status tm_node_elements_find(tm_node_elements *around, const tm_mixed_mesh *mesh,
                                tm_error *error)
{
    const size_t items = mesh->start[mesh->elements];
    around->start = calloc(mesh->nodes + 2, sizeof *around->start);
    around->element = tm_new(items, sizeof *around->element);
    if (!around->start || !around->element)
        return tm_fail_memory(error);
    size_t *end = around->start + 1;
    for (size_t i = 0; i < items; i++)
        end[mesh->item[i] + 1]++;
    for (size_t v = 0; v < mesh->nodes; v++)
        end[v + 1] += end[v];
    for (size_t e = 0; e < mesh->elements; e++)
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            around->element[end[mesh->item[i]]++] = (uint32_t)e;
    return TM_OK;
}

void tm_node_elements_free(tm_node_elements *around)
{
    free(around->start);
    free(around->element);
    *around = (tm_node_elements){0};
}

static tm_status start(tm_trial *t, tm_error *error)
{
    const size_t nodes = t->whole->mesh.nodes;
    t->local = tm_new(nodes, sizeof *t->local);
    t->taken = calloc(t->whole->mesh.elements + 1, sizeof *t->taken);
    if (!t->local || !t->taken)
        return tm_fail_memory(error);
    memset(t->local, 0xff, nodes * sizeof *t->local);
    return TM_OK;
}

static tm_status add_element(tm_trial *t, uint32_t e, tm_error *error)
{
    if (t->taken[e])
        return TM_OK;
    uint32_t *grown =
        tm_grow(t->element, &t->element_room, t->elements + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    t->element = grown;
    grown[t->elements++] = e;
    t->taken[e] = true;
    return TM_OK;
}

static tm_status add_rings(tm_trial *t, unsigned rings, tm_error *error)
{
    const tm_mixed_mesh *mesh = &t->whole->mesh;
    tm_status status = TM_OK;
    size_t first = 0;
    for (unsigned r = 0; r < rings; r++) {
        const size_t end = t->elements;
        for (size_t i = first; i < end; i++)
            for (size_t j = mesh->start[t->element[i]];
                 j < mesh->start[t->element[i] + 1]; j++) {
                const uint32_t v = mesh->item[j];
                for (size_t a = t->around->start[v];
                     a < t->around->start[v + 1] && status == TM_OK; a++)
                    status = add_element(t, t->around->element[a], error);
            }
        first = end;
    }
    return status;
}

static tm_status add_nodes(tm_trial *t, tm_error *error)
{
    const tm_mixed_mesh *mesh = &t->whole->mesh;
    t->nodes = 0;
    for (size_t i = 0; i < t->elements; i++)
        for (size_t j = mesh->start[t->element[i]]; j < mesh->start[t->element[i] + 1];
             j++) {
            const uint32_t v = mesh->item[j];
            if (t->local[v] != TM_NONE)
                continue;
            uint32_t *grown =
                tm_grow(t->node, &t->node_room, t->nodes + 1, sizeof *grown);
            if (!grown)
                return tm_fail_memory(error);
            t->node = grown;
            t->local[v] = (uint32_t)t->nodes;
            grown[t->nodes++] = v;
        }
    return TM_OK;
}

/* Whether all elements at the nodes are in this part of the mesh. */
static tm_status check_end(const tm_trial *t, tm_error *error)
{
    tm_repair_rest *rest = t->whole->rest;
    for (size_t n = 0; rest && n < t->nodes; n++)
        if (t->node[n] < rest->nodes && rest->end[t->node[n]])
            return tm_repair_fail_part(&rest->reached, error);
    return TM_OK;
}

static bool has_outside(const tm_trial *t, uint32_t v)
{
    for (size_t a = t->around->start[v]; a < t->around->start[v + 1]; a++)
        if (!t->taken[t->around->element[a]])
            return true;
    return false;
}

static tm_status fill(tm_trial *t, tm_error *error)
{
    const tm_mixed_mesh *mesh = &t->whole->mesh;
    tm_repair_state *p = &t->part;
    p->lenient = t->whole->lenient;
    p->mesh.nodes = t->nodes;
    p->mesh.elements = t->elements;
    p->mesh.xyz = tm_new(t->nodes, sizeof *p->mesh.xyz);
    p->rule = tm_new(t->nodes, sizeof *p->rule);
    p->mesh.start = tm_new(t->elements + TM_TRIAL_ROOM + 1, sizeof *p->mesh.start);
    p->mesh.item =
        tm_new((t->elements + TM_TRIAL_ROOM) * MOST_NODES, sizeof *p->mesh.item);
    if (!p->mesh.xyz || !p->rule || !p->mesh.start || !p->mesh.item)
        return tm_fail_memory(error);
    for (size_t n = 0; n < t->nodes; n++) {
        memcpy(p->mesh.xyz[n], mesh->xyz[t->node[n]], sizeof *p->mesh.xyz);
        p->rule[n] = t->whole->rule[t->node[n]];
        if (has_outside(t, t->node[n]))
            p->rule[n] = (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_NOT};
    }
    size_t items = 0;
    for (size_t e = 0; e < t->elements; e++) {
        p->mesh.start[e] = items;
        for (size_t j = mesh->start[t->element[e]]; j < mesh->start[t->element[e] + 1];
             j++)
            p->mesh.item[items++] = t->local[mesh->item[j]];
    }
    p->mesh.start[t->elements] = items;
    return TM_OK;
}

static void end_gather(tm_trial *t)
{
    for (size_t n = 0; n < t->nodes; n++)
        t->local[t->node[n]] = TM_NONE;
    for (size_t e = 0; e < t->elements; e++)
        t->taken[t->element[e]] = false;
}

tm_status tm_trial_gather(tm_trial *trial, const uint32_t *core, size_t cores,
                          unsigned rings, tm_error *error)
{
    tm_status status = trial->local ? TM_OK : start(trial, error);
    tm_repair_state_free(&trial->part);
    trial->nodes = trial->elements = 0;
    for (size_t i = 0; i < cores && status == TM_OK; i++)
        status = add_element(trial, core[i], error);
    if (status == TM_OK)
        status = add_rings(trial, rings, error);
    if (status == TM_OK)
        status = add_nodes(trial, error);
    if (status == TM_OK)
        status = check_end(trial, error);
    if (status == TM_OK)
        status = fill(trial, error);
    if (status == TM_OK)
        end_gather(trial);
    return status;
}

void tm_trial_commit(const tm_trial *t)
{
    for (size_t n = 0; n < t->nodes; n++) {
        memcpy(t->whole->mesh.xyz[t->node[n]], t->part.mesh.xyz[n],
               sizeof *t->part.mesh.xyz);
        if (t->part.rule[n].freedom != TM_MOVES_NOT)
            t->whole->rule[t->node[n]] = t->part.rule[n];
    }
}

void tm_trial_free(tm_trial *trial)
{
    tm_repair_state_free(&trial->part);
    free(trial->node);
    free(trial->element);
    free(trial->local);
    free(trial->taken);
    *trial = (tm_trial){0};
}
