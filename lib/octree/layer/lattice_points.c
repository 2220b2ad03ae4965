/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_CORNERS = 8 };

/* The level of the smallest leaf of the mesh at each node of the octree; one more than
 * that of a leaf which has it in the middle of an edge or a face. */
static uint8_t *find_levels(const tm_octree *octree, const tm_interior *part,
                            size_t parts)
{
    uint8_t *level = calloc(octree->nodes + 1, 1);
    for (size_t l = 0; level && l < octree->leaves; l++) {
        if (tm_interior_part_of(part, parts, l) == parts)
            continue;
        for (unsigned p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t node = octree->node[l][p];
            const unsigned here = octree->leaf[l].level + (p < TM_LEAF_EDGE ? 0u : 1u);
            if (node != TM_NONE && here > level[node])
                level[node] = (uint8_t)here;
        }
    }
    return level;
}

static void set_middles(const tm_assembly *a, const tm_octree *octree,
                        const tm_interior *part, double (*xyz)[3])
{
    for (size_t m = 0; m < a->middles; m++) {
        const size_t leaf = a->middle_leaf[m];
        const uint32_t *corner = octree->node[leaf];
        const uint32_t *core_node =
            a->core_node[tm_interior_part_of(part, a->parts, leaf)];
        double *middle = xyz[a->mesh.nodes - a->middles + m];
        for (int i = 0; i < 3; i++) {
            double sum = 0;
            for (unsigned c = 0; c < LEAF_CORNERS; c++)
                sum += xyz[core_node[corner[c]]][i];
            middle[i] = sum / LEAF_CORNERS;
        }
    }
}

tm_status tm_lattice_points(const tm_assembly *assembly, const tm_octree *octree,
                            const tm_interior *part, size_t parts,
                            const tm_interior_boundary *boundary, double (*xyz)[3],
                            tm_error *error)
{
    const double share = 0.08;
    uint8_t *level = find_levels(octree, part, parts);
    if (!level)
        return tm_fail_memory(error);
    for (size_t n = 0; n < assembly->core; n++)
        tm_octree_point(octree, octree->grid[assembly->grid_node[n]], xyz[n]);
    for (size_t s = 0; s < boundary->nodes; s++) {
        const uint32_t node = boundary->grid_node[s];
        const double step = share * octree->side / (double)((uint32_t)1 << level[node]);
        tm_boundary_node_point(boundary, s, xyz[assembly->outer + s]);
        for (size_t p = 0; p < parts; p++) {
            const uint32_t inner = assembly->inner[p][s];
            int outward[3];
            tm_octant_mask_outward(part[p].mask[node], outward);
            for (int i = 0; inner != TM_NONE && i < 3; i++)
                xyz[inner][i] -= step * outward[i];
        }
    }
    set_middles(assembly, octree, part, xyz);
    free(level);
    return TM_OK;
}
