/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "leaf_tree.h"

#include "../../base/array.h"
#include "leaf_list.h"

#include <stdlib.h>

enum { CHILDREN = 8 };

typedef struct maker {
    tm_leaf_tree *tree;
    const tm_octree *octree;
    size_t next; /* leaf */
    tm_error *error;
} maker;

/* Whether the next leaf is in an octant. */
static bool has_next(const maker *m, const uint32_t anchor[3], unsigned shift)
{
    if (m->next == m->octree->leaves)
        return false;
    for (int i = 0; i < 3; i++)
        if ((m->octree->leaf[m->next].anchor[i] ^ anchor[i]) >> shift)
            return false;
    return true;
}

static tm_status make(maker *m, const uint32_t anchor[3], unsigned shift, uint32_t *cell);

static tm_status make_children(maker *m, const uint32_t anchor[3], unsigned shift,
                               uint32_t octant)
{
    tm_status status = TM_OK;
    for (unsigned c = 0; c < CHILDREN && status == TM_OK; c++) {
        uint32_t low[3], cell = TM_NONE;
        tm_octree_child(anchor, shift, c, low);
        if (has_next(m, low, shift - 1))
            status = make(m, low, shift - 1, &cell);
        m->tree->child[octant][c] = cell;
    }
    return status;
}

static tm_status make(maker *m, const uint32_t anchor[3], unsigned shift, uint32_t *cell)
{
    if (shift <= TM_OCTREE_FINEST && tm_leaf_shift(&m->octree->leaf[m->next]) == shift) {
        *cell = TM_LEAF_BIT | (uint32_t)m->next++;
        return TM_OK;
    }
    tm_leaf_tree *tree = m->tree;
    void *grown =
        tm_grow(tree->child, &tree->room, tree->octants + 1, sizeof *tree->child);
    if (!grown)
        return tm_fail_memory(m->error);
    tree->child = grown;
    *cell = (uint32_t)tree->octants++;
    return make_children(m, anchor, shift, *cell);
}

tm_status tm_leaf_tree_make(tm_leaf_tree *tree, const tm_octree *octree, tm_error *error)
{
    *tree = (tm_leaf_tree){.top = TM_NONE};
    maker m = {.tree = tree, .octree = octree, .error = error};
    const uint32_t low[3] = {0, 0, 0};
    const unsigned shift = tm_octree_shift(octree);
    const tm_status status =
        has_next(&m, low, shift) ? make(&m, low, shift, &tree->top) : TM_OK;
    if (status != TM_OK)
        tm_leaf_tree_free(tree);
    return status;
}

void tm_leaf_tree_free(tm_leaf_tree *tree)
{
    free(tree->child);
    *tree = (tm_leaf_tree){.top = TM_NONE};
}
