/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choice of leaves of a share: all ranks choose of the whole octree. */
#include "octree_mesh_ranks.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../forest/octree_build.h"

#include <stdlib.h>

static tm_status whole_of(tm_octree *whole, const tm_octree_share *s,
                          const tm_surface *surface, tm_error *error)
{
    void *leaf = NULL;
    uint32_t *order = NULL;
    const tm_octree *o = &s->octree;
    *whole = (tm_octree){.side = o->side, .threads = o->threads};
    for (int i = 0; i < 3; i++) {
        whole->low[i] = o->low[i];
        whole->roots[i] = o->roots[i];
    }
    tm_status status = tm_ranks_share(o->leaf + s->own_first, s->own_past - s->own_first,
                                      sizeof *o->leaf, &leaf, NULL, error);
    if (status == TM_OK)
        status =
            tm_octree_from_leaves(whole, leaf, s->all_leaves, surface, &order, error);
    free(leaf);
    free(order);
    return tm_ranks_agree(status, error);
}

static tm_status cut(tm_interior *to, const tm_interior *from, const tm_octree_share *s,
                     tm_error *error)
{
    to->chosen = tm_new(s->octree.leaves, sizeof *to->chosen);
    to->mask = tm_new(s->octree.nodes, sizeof *to->mask);
    to->used = tm_new(s->octree.nodes, sizeof *to->used);
    if (!to->chosen || !to->mask || !to->used)
        return tm_fail_memory(error);
    for (size_t l = 0; l < s->octree.leaves; l++) {
        to->chosen[l] = from->chosen[s->leaf_number[l]];
        to->count += to->chosen[l];
    }
    for (size_t n = 0; n < s->octree.nodes; n++) {
        to->mask[n] = from->mask[s->node_number[n]];
        to->used[n] = from->used[s->node_number[n]];
    }
    return TM_OK;
}

tm_status tm_interior_choose_on_ranks(tm_interior *interior, const tm_octree_share *share,
                                      const tm_surface *surface, tm_error *error)
{
    tm_octree whole;
    tm_interior all = {0};
    *interior = (tm_interior){0};
    tm_status status = whole_of(&whole, share, surface, error);
    if (status == TM_OK)
        status = tm_interior_choose(&all, &whole, surface, error);
    if (status == TM_OK)
        status = cut(interior, &all, share, error);
    tm_interior_free(&all);
    tm_octree_free(&whole);
    return tm_ranks_agree(status, error);
}
