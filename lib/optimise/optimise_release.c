/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The last resort: where an element stays inverted because its nodes have to be on curves
 * and corners that are too close together for the mesh, they may leave them. */
#include "optimise_parts.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "../stream/stream.h"

#include <stdlib.h>
#include <string.h>

/* Nodes are released in steps: of bad elements those on curves and patches, then those at
 * corners too, then all of the elements around. */
enum { STEPS = 3, CORNERS_FROM = 1, AROUND_FROM = 2 };

typedef struct released {
    uint32_t node;
    tm_node_rule rule;
    double xyz[3];
} released;

typedef struct list {
    released *item;
    size_t count, room;
} list;

static bool can_be_released(const tm_node_rule *rule, size_t step)
{
    if (rule->off_surface)
        return false;
    if (rule->freedom == TM_MOVES_ON_SURFACE)
        return rule->where != TM_NONE;
    return rule->freedom == TM_MOVES_ON_CURVE ||
           (rule->freedom == TM_MOVES_AT_CORNER && step >= CORNERS_FROM);
}

static tm_status release_nodes(tm_optimise_work *w, size_t e, size_t step, list *nodes,
                               tm_error *error)
{
    const tm_mixed_mesh *mesh = w->mesh;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
        const uint32_t v = mesh->item[i];
        if (!can_be_released(&w->rule[v], step))
            continue;
        released *grown =
            tm_grow(nodes->item, &nodes->room, nodes->count + 1, sizeof *nodes->item);
        if (!grown)
            return tm_fail_memory(error);
        nodes->item = grown;
        released *one = &nodes->item[nodes->count++];
        *one = (released){.node = v, .rule = w->rule[v]};
        memcpy(one->xyz, mesh->xyz[v], sizeof one->xyz);
        w->rule[v] = (tm_node_rule){TM_NONE, TM_MOVES_ON_SURFACE, false};
    }
    return TM_OK;
}

static tm_status release_around(tm_optimise_work *w, size_t e, size_t step, list *nodes,
                                tm_error *error)
{
    const tm_mixed_mesh *mesh = w->mesh;
    const tm_vicinity *vicinity = &w->vicinity;
    tm_status status = TM_OK;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
        const uint32_t row = vicinity->row[mesh->item[i]];
        for (size_t j = vicinity->start[row];
             j < vicinity->start[row + 1] && status == TM_OK; j++)
            status = release_nodes(w, vicinity->element[j], step, nodes, error);
    }
    return status;
}

/* Releases nodes, and mends if there were any. Only the last time with full effort. */
static tm_status make_step(tm_optimise_work *w, size_t step, list *nodes, tm_error *error)
{
    tm_status status = TM_OK;
    const size_t before = nodes->count;
    for (size_t b = 0; b < w->bads && status == TM_OK; b++) {
        const uint32_t e = w->bad[b];
        if (w->jens[e] >= w->options->release_threshold)
            continue;
        status = step >= AROUND_FROM ? release_around(w, e, step, nodes, error)
                                     : release_nodes(w, e, step, nodes, error);
    }
    const bool last = step + 1 == STEPS;
    if (status != TM_OK || (nodes->count == before && !last))
        return status;
    return tm_optimise_mend(w, last ? w->options->effort : 0, error);
}

/* Nodes that did not move have their rules again. */
static void take_back(tm_optimise_work *w, const list *nodes)
{
    for (size_t i = 0; i < nodes->count; i++) {
        const released *one = &nodes->item[i];
        if (tm_distance2(w->mesh->xyz[one->node], one->xyz) == 0)
            w->rule[one->node] = one->rule;
        else
            w->report->released++;
    }
}

tm_status tm_optimise_release(tm_optimise_work *w, tm_error *error)
{
    list nodes = {0};
    tm_status status = TM_OK;
    for (size_t step = 0;
         step < STEPS && status == TM_OK && w->bads > 0 && !tm_optimise_is_spent(w);
         step++)
        status = make_step(w, step, &nodes, error);
    take_back(w, &nodes);
    free(nodes.item);
    return status;
}
