/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../forest/mpi_start.h"
#include "../forest/octree_parts.h"
#include "share_parts.h"

#include <stdlib.h>
#include <string.h>

/* The own leaves with the first ring of ghosts around them, and the nodes of these. */
static tm_status place_leaves(tm_octree_share *s, const tm_leaf_list *own,
                              const tm_ghost_list *ghosts, tm_error *error)
{
    tm_octree *o = &s->octree;
    while (s->own_first < ghosts->count &&
           ghosts->ghost[s->own_first].number < s->first[s->rank])
        s->own_first++;
    s->own_past = s->own_first + own->count;
    o->leaves = own->count + ghosts->count;
    const tm_status status = tm_leaf_list_check(o->leaves, error);
    if (status != TM_OK)
        return status;
    o->leaf = tm_new(o->leaves, sizeof *o->leaf);
    s->leaf_number = tm_new(o->leaves, sizeof *s->leaf_number);
    if (!o->leaf || !s->leaf_number)
        return tm_fail_memory(error);
    for (size_t l = 0; l < o->leaves; l++) {
        const bool is_own = l >= s->own_first && l < s->own_past;
        const tm_ghost *g = &ghosts->ghost[l < s->own_first ? l : l - own->count];
        o->leaf[l] = is_own ? own->leaf[l - s->own_first] : g->leaf;
        s->leaf_number[l] =
            is_own ? (uint32_t)(s->first[s->rank] + l - s->own_first) : g->number;
    }
    return tm_octree_number_nodes(o, error);
}

/* Where the leaves of each rank begin: in number, and in the brick. */
static tm_status find_first(tm_octree_share *s, const tm_leaf_list *own,
                            tm_rank_cuts *cuts, tm_error *error)
{
    const size_t before = tm_ranks_before(own->count, &s->all_leaves);
    tm_status status = tm_rank_cuts_make(cuts, own, error);
    if (status == TM_OK)
        status =
            tm_ranks_share(&before, 1, sizeof before, (void **)&s->first, NULL, error);
    size_t *grown = status == TM_OK
                        ? realloc(s->first, (s->ranks + (size_t)1) * sizeof *s->first)
                        : NULL;
    if (grown) {
        s->first = grown;
        grown[s->ranks] = s->all_leaves;
    }
    if (status == TM_OK && !grown)
        status = tm_fail_memory(error);
    return tm_ranks_agree(status, error);
}

/* The share of balanced leaves, in which only the brick is set yet. */
static tm_status make(tm_octree_share *s, tm_leaf_list *own, unsigned rings,
                      tm_error *error)
{
    tm_rank_cuts cuts = {0};
    tm_ghost_list ghosts = {0};
    tm_status status = tm_leaf_list_spread(own, error);
    if (status == TM_OK)
        status = find_first(s, own, &cuts, error);
    if (status == TM_OK)
        status = tm_share_find_ghosts(&ghosts, &s->octree, own, s->first, &cuts, error);
    tm_rank_cuts_free(&cuts);
    if (status == TM_OK)
        status = tm_ranks_agree(place_leaves(s, own, &ghosts, error), error);
    free(own->leaf);
    *own = (tm_leaf_list){.count = 0};
    if (status == TM_OK && rings > 1)
        status = tm_share_add_rings(&ghosts, s, rings - 1, error);
    if (status == TM_OK)
        status = tm_share_number_nodes(s, &ghosts, error);
    free(ghosts.ghost);
    return status;
}

static tm_status balance(tm_leaf_list *own, const tm_octree *brick,
                         const tm_surface *surface, tm_error *error)
{
    tm_rank_cuts cuts;
    tm_status status = tm_rank_cuts_make(&cuts, own, error);
    if (status == TM_OK)
        status = tm_balance(own, brick, &cuts, surface, error);
    tm_rank_cuts_free(&cuts);
    return status;
}

static tm_octree_share on_brick(const tm_brick *brick, unsigned threads)
{
    return (tm_octree_share){.rank = tm_rank(),
                             .ranks = tm_ranks_count(),
                             .octree = tm_octree_on_brick(brick, threads)};
}

tm_status tm_octree_share_build(tm_octree_share *share, const tm_surface *surface,
                                const tm_octree_rule *rule, size_t rules, unsigned rings,
                                tm_error *error)
{
    tm_brick brick = {.side = 0};
    tm_leaf_list own = {.count = 0};
    tm_octree_rule *levels = tm_new(rules, sizeof *levels);
    *share = (tm_octree_share){.ranks = 0};
    tm_status status = levels ? tm_mpi_start(error) : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_brick_over(&brick, surface->low, surface->high,
                               tm_octree_least_size(rule, rules), error);
    if (status == TM_OK)
        status = tm_octree_set_levels(rule, rules, brick.side, levels, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK) {
        *share = on_brick(&brick, surface->threads);
        status =
            tm_octree_descend(&own, &share->octree, surface, levels, rules, true, error);
    }
    if (status == TM_OK)
        status = balance(&own, &share->octree, surface, error);
    if (status == TM_OK)
        status = make(share, &own, rings, error);
    free(own.leaf);
    free(levels);
    tm_brick_free(&brick);
    if (status != TM_OK)
        tm_octree_share_free(share);
    return status;
}

tm_status tm_octree_share_refine(tm_octree_share *share, const tm_surface *surface,
                                 const uint8_t *split, unsigned rings, tm_error *error)
{
    const tm_octree *octree = &share->octree;
    const unsigned threads = octree->threads;
    tm_brick brick;
    tm_leaf_list own = {.count = 0};
    tm_status status = tm_brick_of(&brick, octree, error);
    if (status == TM_OK)
        status = tm_octree_split_leaves(
            &own, octree, surface, octree->leaf + share->own_first,
            share->own_past - share->own_first, split + share->own_first, error);
    status = tm_ranks_agree(status, error);
    tm_octree_share_free(share);
    if (status == TM_OK) {
        *share = on_brick(&brick, threads);
        status = balance(&own, &share->octree, surface, error);
    }
    if (status == TM_OK)
        status = make(share, &own, rings, error);
    tm_brick_free(&brick);
    free(own.leaf);
    if (status != TM_OK)
        tm_octree_share_free(share);
    return status;
}
