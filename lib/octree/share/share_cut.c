/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_share.h"

#include "../../base/array.h"
#include "../forest/rank_cuts.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    const tm_octree *whole;
    const size_t *first; /* [ranks + 1] */
    unsigned ranks, rings;
    bool *leaf, *node; /* [leaves], [nodes]: that a rank has */
} cutter;

void tm_share_leaves_of(const tm_octree *whole, unsigned ranks, size_t *first)
{
    size_t all = 0, before = 0;
    for (size_t l = 0; l < whole->leaves; l++)
        all += tm_leaf_weight(&whole->leaf[l]);
    for (unsigned r = 0; r <= ranks; r++)
        first[r] = r == 0 ? 0 : whole->leaves;
    unsigned rank = 0;
    for (size_t l = 0; l < whole->leaves; l++) {
        const unsigned own = tm_rank_of_weight(before, all, ranks);
        while (rank < own)
            first[++rank] = l;
        before += tm_leaf_weight(&whole->leaf[l]);
    }
}

/* Marks the nodes of marked leaves. */
static void mark_nodes(const cutter *c)
{
    for (size_t l = 0; l < c->whole->leaves; l++)
        for (int p = 0; c->leaf[l] && p < TM_LEAF_NODES; p++)
            if (c->whole->node[l][p] != TM_NONE)
                c->node[c->whole->node[l][p]] = true;
}

/* Marks what a rank has. Leaves that touch have a node in common. */
static void mark(const cutter *c, unsigned rank)
{
    memset(c->node, false, c->whole->nodes);
    for (size_t l = 0; l < c->whole->leaves; l++)
        c->leaf[l] = l >= c->first[rank] && l < c->first[rank + 1];
    mark_nodes(c);
    for (unsigned ring = 0; ring < c->rings; ring++) {
        for (size_t l = 0; l < c->whole->leaves; l++)
            for (int p = 0; !c->leaf[l] && p < TM_LEAF_EDGE; p++)
                c->leaf[l] = c->node[c->whole->node[l][p]];
        mark_nodes(c);
    }
}

/* The numbers of what is marked, ascending; those below `own` go before the rank's own.
 */
static uint32_t *list_marked(const bool *marked, size_t count, size_t *listed)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        n += marked[i];
    uint32_t *list = tm_new(n, sizeof *list);
    *listed = n;
    n = 0;
    for (size_t i = 0; list && i < count; i++)
        if (marked[i])
            list[n++] = (uint32_t)i;
    return list;
}

/* The number of the first node of each rank: nodes come in the order of leaves. */
static void find_first_nodes(const cutter *c, size_t *first_node)
{
    size_t past = 0;
    for (unsigned r = 0; r < c->ranks; r++) {
        first_node[r] = past;
        for (size_t l = c->first[r]; l < c->first[r + 1]; l++)
            for (int p = 0; p < TM_LEAF_NODES; p++) {
                const uint32_t v = c->whole->node[l][p];
                past += v != TM_NONE && v >= past;
            }
    }
    first_node[c->ranks] = past;
}

/* Copies leaves and their rows; nodes get local numbers. */
static tm_status copy(tm_octree_share *s, const tm_octree *whole, tm_error *error)
{
    tm_octree *o = &s->octree;
    o->leaf = tm_new(o->leaves, sizeof *o->leaf);
    o->node = tm_new(o->leaves, sizeof *o->node);
    o->grid = tm_new(o->nodes, sizeof *o->grid);
    if (!o->leaf || !o->node || !o->grid)
        return tm_fail_memory(error);
    for (size_t l = 0; l < o->leaves; l++) {
        o->leaf[l] = whole->leaf[s->leaf_number[l]];
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = whole->node[s->leaf_number[l]][p];
            o->node[l][p] =
                v == TM_NONE ? v
                             : (uint32_t)tm_first_not_below(s->node_number, o->nodes, v);
        }
    }
    for (size_t n = 0; n < o->nodes; n++)
        memcpy(o->grid[n], whole->grid[s->node_number[n]], sizeof o->grid[n]);
    return TM_OK;
}

/* Appends the rank's own of what is marked, by local number. */
static bool append(tm_share_list *list, size_t *room, unsigned to, const bool *marked,
                   const uint32_t *number, size_t first, size_t past)
{
    size_t count = list->start[to];
    for (size_t i = first; i < past; i++)
        if (marked[number[i]] && !tm_append(&list->item, &count, room, (uint32_t)i))
            return false;
    list->start[to + 1] = count;
    return true;
}

static tm_status list_sent(cutter *c, tm_octree_share *s, tm_error *error)
{
    size_t room[2] = {0, 0};
    s->leaves_sent.start = calloc(s->ranks + 1, sizeof *s->leaves_sent.start);
    s->nodes_sent.start = calloc(s->ranks + 1, sizeof *s->nodes_sent.start);
    bool done = s->leaves_sent.start && s->nodes_sent.start;
    for (unsigned r = 0; r < s->ranks && done; r++) {
        if (r != s->rank)
            mark(c, r);
        const size_t none = r == s->rank;
        done = append(&s->leaves_sent, &room[0], r, c->leaf, s->leaf_number,
                      none ? s->own_past : s->own_first, s->own_past) &&
               append(&s->nodes_sent, &room[1], r, c->node, s->node_number,
                      none ? s->own_node_past : s->own_node_first, s->own_node_past);
    }
    return done ? TM_OK : tm_fail_memory(error);
}

static tm_status cut(cutter *c, tm_octree_share *s, tm_error *error)
{
    const unsigned r = s->rank;
    tm_octree *o = &s->octree;
    mark(c, r);
    s->leaf_number = list_marked(c->leaf, c->whole->leaves, &o->leaves);
    s->node_number = list_marked(c->node, c->whole->nodes, &o->nodes);
    if (!s->leaf_number || !s->node_number)
        return tm_fail_memory(error);
    find_first_nodes(c, s->first_node);
    s->own_first = tm_first_not_below(s->leaf_number, o->leaves, (uint32_t)s->first[r]);
    s->own_past = s->own_first + s->first[r + 1] - s->first[r];
    s->own_node_first =
        tm_first_not_below(s->node_number, o->nodes, (uint32_t)s->first_node[r]);
    s->own_node_past = s->own_node_first + s->first_node[r + 1] - s->first_node[r];
    const tm_status status = copy(s, c->whole, error);
    return status == TM_OK ? list_sent(c, s, error) : status;
}

tm_status tm_octree_share_cut(tm_octree_share *share, const tm_octree *whole,
                              unsigned rank, unsigned ranks, unsigned rings,
                              tm_error *error)
{
    *share = (tm_octree_share){.rank = rank,
                               .ranks = ranks,
                               .octree = *whole,
                               .all_leaves = whole->leaves,
                               .all_nodes = whole->nodes,
                               .first = tm_new(ranks + 1, sizeof *share->first),
                               .first_node = tm_new(ranks + 1, sizeof *share->first)};
    share->octree.leaf = NULL;
    share->octree.grid = NULL;
    share->octree.node = NULL;
    cutter c = {.whole = whole,
                .first = share->first,
                .ranks = ranks,
                .rings = rings,
                .leaf = tm_new(whole->leaves, sizeof *c.leaf),
                .node = tm_new(whole->nodes, sizeof *c.node)};
    tm_status status = TM_OK;
    if (share->first && share->first_node && c.leaf && c.node) {
        tm_share_leaves_of(whole, ranks, share->first);
        status = cut(&c, share, error);
    } else {
        status = tm_fail_memory(error);
    }
    free(c.leaf);
    free(c.node);
    if (status != TM_OK)
        tm_octree_share_free(share);
    return status;
}
