/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_ghosts.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

/* A list in the making. */
typedef struct {
    uint32_t **item;
    size_t count, room;
    bool failed;
} list;

static void append(list *l, uint32_t item)
{
    if (item != TM_NONE && !l->failed)
        l->failed = !tm_append(l->item, &l->count, &l->room, item);
}

/* The local leaves or nodes of rank r among ghosts: `number` is ascending. */
static size_t place_of(const uint32_t *number, size_t count, size_t first)
{
    return tm_first_not_below(number, count, (uint32_t)first);
}

static void list_sent(list *l, const tm_octree_share *s, unsigned r,
                      const uint32_t *const *of_node, size_t lists,
                      const uint32_t *of_leaf)
{
    for (size_t i = 0; i < lists; i++)
        for (size_t k = s->nodes_sent.start[r]; k < s->nodes_sent.start[r + 1]; k++)
            append(l, of_node[i][s->nodes_sent.item[k]]);
    for (size_t k = s->leaves_sent.start[r]; of_leaf && k < s->leaves_sent.start[r + 1];
         k++)
        append(l, of_leaf[s->leaves_sent.item[k]]);
}

static void list_received(list *l, const tm_octree_share *s, unsigned r,
                          const uint32_t *const *of_node, size_t lists,
                          const uint32_t *of_leaf)
{
    const size_t nodes = s->octree.nodes, leaves = s->octree.leaves;
    const size_t end = place_of(s->node_number, nodes, s->first_node[r + 1]);
    const size_t leaf_end = place_of(s->leaf_number, leaves, s->first[r + 1]);
    if (r == s->rank)
        return;
    for (size_t i = 0; i < lists; i++)
        for (size_t n = place_of(s->node_number, nodes, s->first_node[r]); n < end; n++)
            append(l, of_node[i][n]);
    for (size_t k = place_of(s->leaf_number, leaves, s->first[r]);
         of_leaf && k < leaf_end; k++)
        append(l, of_leaf[k]);
}

static bool start(tm_mesh_ghosts *g, unsigned ranks)
{
    *g = (tm_mesh_ghosts){.ranks = ranks,
                          .sends = calloc(ranks, sizeof *g->sends),
                          .receives = calloc(ranks, sizeof *g->receives)};
    return g->sends && g->receives;
}

/* When both lists are there. */
static bool finish(tm_mesh_ghosts *g, const list *sent, const list *received)
{
    g->all_received = received->count;
    g->all_sent = sent->count;
    g->room = tm_new(g->all_sent + g->all_received, TM_GHOST_BYTES);
    return g->room != NULL;
}

tm_status tm_mesh_ghosts_find(tm_mesh_ghosts *g, const tm_octree_share *share,
                              const uint32_t *const *of_node, size_t lists,
                              const uint32_t *of_leaf, tm_error *error)
{
    bool done = start(g, share->ranks);
    list sent = {.item = &g->sent}, received = {.item = &g->received};
    for (unsigned r = 0; r < share->ranks && done; r++) {
        const size_t sends = sent.count, receives = received.count;
        list_sent(&sent, share, r, of_node, lists, of_leaf);
        list_received(&received, share, r, of_node, lists, of_leaf);
        g->sends[r] = sent.count - sends;
        g->receives[r] = received.count - receives;
        done = !sent.failed && !received.failed;
    }
    return tm_ranks_enough(done && finish(g, &sent, &received), error);
}

/* Adds those of `count` items that are kept; returns how many. */
static size_t append_kept(list *l, const uint32_t *item, size_t count, const bool *kept)
{
    const size_t before = l->count;
    for (size_t i = 0; i < count; i++)
        append(l, kept[item[i]] ? item[i] : TM_NONE);
    return l->count - before;
}

tm_status tm_mesh_ghosts_some(tm_mesh_ghosts *some, const tm_mesh_ghosts *all,
                              const bool *kept, tm_error *error)
{
    bool done = start(some, all->ranks);
    list sent = {.item = &some->sent}, received = {.item = &some->received};
    const uint32_t *to = all->sent, *from = all->received;
    for (unsigned r = 0; r < all->ranks && done; r++) {
        some->sends[r] = append_kept(&sent, to, all->sends[r], kept);
        some->receives[r] = append_kept(&received, from, all->receives[r], kept);
        to += all->sends[r];
        from += all->receives[r];
        done = !sent.failed && !received.failed;
    }
    return tm_ranks_enough(done && finish(some, &sent, &received), error);
}

void tm_mesh_ghosts_free(tm_mesh_ghosts *g)
{
    free(g->sends);
    free(g->receives);
    free(g->sent);
    free(g->received);
    free(g->room);
    *g = (tm_mesh_ghosts){0};
}

/* Sends value[item[…]], `all` of them, count[r] to rank r; returns where what comes is.
 */
static const char *swap(const tm_mesh_ghosts *g, const uint32_t *item, size_t all,
                        const size_t *count, const size_t *got_count, const char *value,
                        size_t size)
{
    for (size_t i = 0; i < all; i++)
        memcpy(g->room + i * size, value + item[i] * size, size);
    tm_ranks_swap(g->room, count, size, g->room + all * size, got_count);
    return g->room + all * size;
}

void tm_mesh_ghosts_fill(const tm_mesh_ghosts *g, void *value, size_t size)
{
    const char *got = swap(g, g->sent, g->all_sent, g->sends, g->receives, value, size);
    for (size_t i = 0; i < g->all_received; i++)
        memcpy((char *)value + g->received[i] * size, got + i * size, size);
}

void tm_mesh_ghosts_mark(const tm_mesh_ghosts *g, bool *mark)
{
    const char *got = swap(g, g->received, g->all_received, g->receives, g->sends,
                           (const char *)mark, sizeof *mark);
    for (size_t i = 0; i < g->all_sent; i++)
        mark[g->sent[i]] |= ((const bool *)got)[i];
    tm_mesh_ghosts_fill(g, mark, sizeof *mark);
}
