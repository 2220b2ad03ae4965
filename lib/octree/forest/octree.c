/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_octree_free(tm_octree *octree)
{
    free(octree->leaf);
    free(octree->grid);
    free(octree->node);
    *octree = (tm_octree){.leaves = 0};
}

unsigned tm_octree_deepest(const tm_octree *octree)
{
    unsigned deepest = 0;
    for (size_t l = 0; l < octree->leaves; l++)
        if (octree->leaf[l].level > deepest)
            deepest = octree->leaf[l].level;
    return deepest;
}

tm_status tm_octree_copy(tm_octree *copy, const tm_octree *octree, tm_error *error)
{
    *copy = *octree;
    copy->leaf = tm_new(octree->leaves, sizeof *copy->leaf);
    copy->grid = tm_new(octree->nodes, sizeof *copy->grid);
    copy->node = tm_new(octree->leaves, sizeof *copy->node);
    if (!copy->leaf || !copy->grid || !copy->node)
        return tm_fail_memory(error);
    memcpy(copy->leaf, octree->leaf, octree->leaves * sizeof *copy->leaf);
    memcpy(copy->grid, octree->grid, octree->nodes * sizeof *copy->grid);
    memcpy(copy->node, octree->node, octree->leaves * sizeof *copy->node);
    return TM_OK;
}
