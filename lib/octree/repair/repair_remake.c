/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../forest/octree_build.h"
#include "../layer/octree_mesh.h"
#include "../layer/octree_mesh_stream.h"
#include "repair_boundary.h"

#include <stdlib.h>
#include <string.h>

static tm_status split(tm_octree *octree, const uint32_t *row, const tm_surface *surface,
                       const uint32_t *octant, size_t count, tm_error *error)
{
    uint8_t *marked = calloc(octree->leaves + 1, 1);
    if (!marked)
        return tm_fail_memory(error);
    for (size_t l = 0; l < octree->leaves; l++)
        marked[l] = count > 0 && bsearch(&row[l], octant, count, sizeof *octant,
                                         tm_repair_compare_octants) != NULL;
    const tm_status status = tm_octree_refine(octree, surface, marked, error);
    free(marked);
    return status;
}

static tm_status take_mesh(tm_repair_state *to, tm_octree_mesh *made,
                           const tm_surface *surface, tm_error *error)
{
    to->mesh = made->assembly.mesh;
    made->assembly.mesh = (tm_mixed_mesh){0};
    const size_t nodes = to->mesh.nodes, elements = to->mesh.elements;
    to->rule = tm_new(nodes, sizeof *to->rule);
    to->on = calloc(nodes + 1, sizeof *to->on);
    to->octant = tm_new(elements, sizeof *to->octant);
    to->origin = tm_new(elements, sizeof *to->origin);
    to->row = tm_new(to->octree.leaves, sizeof *to->row);
    double *given = calloc(nodes + 1, sizeof *given);
    if (!to->rule || !to->on || !to->octant || !to->origin || !to->row || !given) {
        free(given);
        return tm_fail_memory(error);
    }
    for (size_t l = 0; l < to->octree.leaves; l++) {
        to->row[l] = (uint32_t)l;
        for (uint32_t e = made->assembly.first[l]; e < made->assembly.first[l + 1]; e++)
            to->octant[e] = (uint32_t)l;
    }
    for (size_t e = 0; e < elements; e++)
        to->origin[e] = (uint32_t)e;
    for (size_t s = 0; s < made->boundary.nodes; s++) {
        const double place = TM_NODE_ON_PATCH + made->feature.kind[s];
        given[made->assembly.outer + s] = made->off_surface[s] ? -place : place;
    }
    const tm_status status =
        tm_repair_find_rules(surface, nodes, (const double(*)[3])to->mesh.xyz, given,
                             NULL, to->rule, to->on, error);
    free(given);
    return status;
}

tm_status tm_repair_remake(tm_repair_state *to, const tm_repair_state *from,
                           tm_surface *surface, const uint32_t *octant, size_t count,
                           tm_error *error)
{
    tm_octree_mesh made = {0};
    to->remade = true;
    to->progress = from->progress;
    tm_progress_stage(to->progress, "splitting octants");
    tm_status status = tm_octree_copy(&to->octree, &from->octree, error);
    if (status == TM_OK)
        status = split(&to->octree, from->row, surface, octant, count, error);
    if (status != TM_OK)
        return status;
    status = tm_octree_mesh_make(&made, &to->octree, surface, to->progress, error);
    if (status == TM_OK)
        status = take_mesh(to, &made, surface, error);
    tm_octree_mesh_free(&made);
    return status;
}
