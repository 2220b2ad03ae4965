/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_steps.h"

#include "../../base/array.h"
#include "../forest/octree_build.h"
#include "../layer/octree_mesh.h"
#include "../layer/octree_mesh_stream.h"
#include "repair_boundary.h"

#include <stdlib.h>
#include <string.h>

/* How many leaves the layer of elements spans, at most: a corner of the surface is that
 * far from the leaves inside. */
enum { LAYER = 4 };

/* Marks leaves with surface but no element as well, as far as the layer goes from those
 * that are marked: else the leaves inside get smaller, and what of the surface they reach
 * with them, but not closer to it, and corners and sharp edges are lost. */
static tm_status mark_layer(const tm_octree *octree, const bool *filled, uint8_t *marked,
                            tm_error *error)
{
    bool *near = calloc(octree->nodes + 1, sizeof *near);
    if (!near)
        return tm_fail_memory(error);
    for (int ring = 0; ring <= LAYER; ring++) {
        for (size_t l = 0; ring > 0 && l < octree->leaves; l++)
            for (int p = 0; octree->leaf[l].crossed && !filled[l] && p < TM_LEAF_NODES;
                 p++)
                marked[l] |= octree->node[l][p] != TM_NONE && near[octree->node[l][p]];
        for (size_t l = 0; l < octree->leaves; l++)
            for (int p = 0; marked[l] && p < TM_LEAF_NODES; p++)
                if (octree->node[l][p] != TM_NONE)
                    near[octree->node[l][p]] = true;
    }
    free(near);
    return TM_OK;
}

static tm_status split(tm_octree *octree, const tm_repair_state *from,
                       const tm_surface *surface, const uint32_t *octant, size_t count,
                       bool layer, tm_error *error)
{
    uint8_t *marked = calloc(octree->leaves + 1, 1);
    bool *filled = calloc(octree->leaves + 1, sizeof *filled);
    bool *by_row = calloc(octree->leaves + 1, sizeof *by_row);
    tm_status status = marked && filled && by_row ? TM_OK : tm_fail_memory(error);
    for (size_t e = 0; status == TM_OK && e < from->mesh.elements; e++)
        if (from->octant[e] != TM_NONE)
            by_row[from->octant[e]] = true;
    for (size_t l = 0; status == TM_OK && l < octree->leaves; l++) {
        filled[l] = from->row[l] != TM_NONE && by_row[from->row[l]];
        marked[l] = count > 0 && bsearch(&from->row[l], octant, count, sizeof *octant,
                                         tm_compare_numbers) != NULL;
    }
    if (status == TM_OK && layer)
        status = mark_layer(octree, filled, marked, error);
    if (status == TM_OK)
        status = tm_octree_refine(octree, surface, marked, error);
    free(marked);
    free(filled);
    free(by_row);
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
                           bool layer, tm_error *error)
{
    tm_octree_mesh made = {0};
    to->remade = true;
    to->progress = from->progress;
    to->stop = from->stop;
    tm_progress_within within;
    const tm_progress *inner =
        tm_progress_begin_within(&within, to->progress, "splitting octants");
    tm_status status = tm_octree_copy(&to->octree, &from->octree, error);
    if (status == TM_OK)
        status = split(&to->octree, from, surface, octant, count, layer, error);
    if (status != TM_OK)
        return status;
    status = tm_octree_mesh_make(&made, &to->octree, surface, inner, error);
    if (status == TM_OK)
        status = take_mesh(to, &made, surface, error);
    tm_octree_mesh_free(&made);
    return status;
}
