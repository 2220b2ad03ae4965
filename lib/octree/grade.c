/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "grade.h"

#include <stdlib.h>

enum { LEAF_FACES = 6 };

/* Where a node is pushed: bit f where face f of some large leaf has it, and the level of
 * the smallest of these leaves. */
typedef struct {
    uint8_t faces;
    uint8_t level;
} push;

static bool is_on_face(unsigned place, unsigned f)
{
    return tm_leaf_place[place][f / 2] == (f % 2 ? 2 : 0);
}

static void push_face(const tm_octree *octree, size_t l, unsigned f, push *pushes)
{
    const uint8_t level = octree->leaf[l].level;
    for (unsigned p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = octree->node[l][p];
        if (node == TM_NONE || !is_on_face(p, f))
            continue;
        pushes[node].faces |= (uint8_t)(1u << f);
        if (level > pushes[node].level)
            pushes[node].level = level;
    }
}

/* Puts the middles of leaves to the means of their corners again. */
static void centre_middles(tm_assembly *a, const tm_octree *octree)
{
    enum { CORNERS = TM_LEAF_EDGE };
    double(*xyz)[3] = a->mesh.xyz;
    for (size_t m = 0; m < a->middles; m++) {
        const uint32_t *corner = octree->node[a->middle_leaf[m]];
        double *middle = xyz[a->mesh.nodes - a->middles + m];
        for (int i = 0; i < 3; i++) {
            double sum = 0;
            for (unsigned c = 0; c < CORNERS; c++)
                sum += xyz[a->core_node[corner[c]]][i];
            middle[i] = sum / CORNERS;
        }
    }
}

tm_status tm_grade(tm_assembly *assembly, const tm_octree *octree, const tm_solid *solid,
                   tm_error *error)
{
    const double share = 0.1;
    push *pushes = calloc(octree->nodes + 1, sizeof *pushes);
    if (!pushes)
        return tm_fail_memory(error);
    for (size_t l = 0; l < octree->leaves; l++)
        for (unsigned f = 0; solid->chosen[l] && f < LEAF_FACES; f++) {
            const uint32_t centre = octree->node[l][TM_LEAF_FACE + f];
            if (centre != TM_NONE && solid->used[centre])
                push_face(octree, l, f, pushes);
        }
    for (size_t n = 0; n < assembly->core; n++) {
        const uint32_t node = assembly->grid_node[n];
        if (solid->mask[node] != TM_ALL_OCTANTS)
            continue;
        const push at = pushes[node];
        const double step = share * octree->side / (double)((uint32_t)1 << at.level);
        for (unsigned axis = 0; axis < 3; axis++) {
            /* From the low face of a leaf upwards, from the high one downwards. */
            const int up = at.faces >> 2 * axis & 1;
            const int down = at.faces >> (2 * axis + 1) & 1;
            assembly->mesh.xyz[n][axis] += (up - down) * step;
        }
    }
    free(pushes);
    centre_middles(assembly, octree);
    return TM_OK;
}
