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
                          .sends = calloc(ranks + 1, sizeof *g->sends),
                          .receives = calloc(ranks + 1, sizeof *g->receives),
                          .sends_count = tm_new(ranks, sizeof *g->sends_count),
                          .receives_count = tm_new(ranks, sizeof *g->receives_count)};
    return g->sends && g->receives && g->sends_count && g->receives_count;
}

/* When both lists are there. */
static bool finish(tm_mesh_ghosts *g)
{
    for (unsigned r = 0; r < g->ranks; r++) {
        g->sends_count[r] = g->sends[r + 1] - g->sends[r];
        g->receives_count[r] = g->receives[r + 1] - g->receives[r];
    }
    g->room = tm_new(g->sends[g->ranks] + g->receives[g->ranks], TM_GHOST_BYTES);
    return g->room != NULL;
}

tm_status tm_mesh_ghosts_find(tm_mesh_ghosts *g, const tm_octree_share *share,
                              const uint32_t *const *of_node, size_t lists,
                              const uint32_t *of_leaf, tm_error *error)
{
    bool done = start(g, share->ranks);
    list sent = {.item = &g->sent}, received = {.item = &g->received};
    for (unsigned r = 0; r < share->ranks && done; r++) {
        list_sent(&sent, share, r, of_node, lists, of_leaf);
        list_received(&received, share, r, of_node, lists, of_leaf);
        g->sends[r + 1] = sent.count;
        g->receives[r + 1] = received.count;
        done = !sent.failed && !received.failed;
    }
    return tm_ranks_enough(done && finish(g), error);
}

tm_status tm_mesh_ghosts_some(tm_mesh_ghosts *some, const tm_mesh_ghosts *all,
                              const bool *kept, tm_error *error)
{
    bool done = start(some, all->ranks);
    list sent = {.item = &some->sent}, received = {.item = &some->received};
    for (unsigned r = 0; r < all->ranks && done; r++) {
        for (size_t i = all->sends[r]; i < all->sends[r + 1]; i++)
            append(&sent, kept[all->sent[i]] ? all->sent[i] : TM_NONE);
        for (size_t i = all->receives[r]; i < all->receives[r + 1]; i++)
            append(&received, kept[all->received[i]] ? all->received[i] : TM_NONE);
        some->sends[r + 1] = sent.count;
        some->receives[r + 1] = received.count;
        done = !sent.failed && !received.failed;
    }
    return tm_ranks_enough(done && finish(some), error);
}

void tm_mesh_ghosts_free(tm_mesh_ghosts *g)
{
    free(g->sends);
    free(g->receives);
    free(g->sent);
    free(g->received);
    free(g->sends_count);
    free(g->receives_count);
    free(g->room);
    *g = (tm_mesh_ghosts){0};
}

/* Sends value[item[…]], count[r] of them to rank r; returns where what comes is. */
static const char *swap(const tm_mesh_ghosts *g, const uint32_t *item,
                        const size_t *count, const size_t *got_count, const char *value,
                        size_t size)
{
    size_t all = 0;
    for (unsigned r = 0; r < g->ranks; r++)
        all += count[r];
    for (size_t i = 0; i < all; i++)
        memcpy(g->room + i * size, value + item[i] * size, size);
    tm_ranks_swap(g->room, count, size, g->room + all * size, got_count);
    return g->room + all * size;
}

void tm_mesh_ghosts_fill(const tm_mesh_ghosts *g, void *value, size_t size)
{
    const char *got = swap(g, g->sent, g->sends_count, g->receives_count, value, size);
    for (size_t i = 0; i < g->receives[g->ranks]; i++)
        memcpy((char *)value + g->received[i] * size, got + i * size, size);
}

void tm_mesh_ghosts_mark(const tm_mesh_ghosts *g, bool *mark)
{
    const char *got = swap(g, g->received, g->receives_count, g->sends_count,
                           (const char *)mark, sizeof *mark);
    for (size_t i = 0; i < g->sends[g->ranks]; i++)
        mark[g->sent[i]] |= ((const bool *)got)[i];
    tm_mesh_ghosts_fill(g, mark, sizeof *mark);
}
