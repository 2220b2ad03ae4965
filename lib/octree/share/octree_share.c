/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_share.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

static void free_list(tm_share_list *list)
{
    free(list->start);
    free(list->item);
}

void tm_octree_share_free(tm_octree_share *share)
{
    tm_octree_free(&share->octree);
    free(share->leaf_number);
    free(share->first);
    free(share->node_number);
    free(share->first_node);
    free_list(&share->leaves_sent);
    free_list(&share->nodes_sent);
    *share = (tm_octree_share){.ranks = 0};
}

/* Ghosts come from the ranks in order, those of ranks before this one in front of its own
 * items [first, past) of `count`, the others behind. */
static tm_status fill(const tm_octree_share *share, const tm_share_list *list,
                      char *value, size_t size, size_t first, size_t past, size_t count,
                      tm_error *error)
{
    if (share->ranks == 1)
        return TM_OK;
    char *send = tm_new(list->start[share->ranks], size);
    size_t *counts = tm_new(share->ranks, sizeof *counts);
    void *got = NULL;
    tm_status status = send && counts ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK && send && counts) { /* as all say */
        for (size_t i = 0; i < list->start[share->ranks]; i++)
            memcpy(send + i * size, value + list->item[i] * size, size);
        for (unsigned r = 0; r < share->ranks; r++)
            counts[r] = list->start[r + 1] - list->start[r];
        status = tm_ranks_exchange(send, counts, size, &got, counts, error);
    }
    if (got && first > 0)
        memcpy(value, got, first * size);
    if (got && count > past)
        memcpy(value + past * size, (char *)got + first * size, (count - past) * size);
    free(send);
    free(counts);
    free(got);
    return status;
}

tm_status tm_share_fill_leaves(const tm_octree_share *share, void *value, size_t size,
                               tm_error *error)
{
    return fill(share, &share->leaves_sent, value, size, share->own_first,
                share->own_past, share->octree.leaves, error);
}

tm_status tm_share_fill_nodes(const tm_octree_share *share, void *value, size_t size,
                              tm_error *error)
{
    return fill(share, &share->nodes_sent, value, size, share->own_node_first,
                share->own_node_past, share->octree.nodes, error);
}

/* A copy of `count` items. */
static void *copy_of(const void *items, size_t count, size_t size)
{
    void *copy = tm_new(count, size);
    if (copy && count > 0)
        memcpy(copy, items, count * size);
    return copy;
}

tm_status tm_octree_share_copy(tm_octree_share *copy, const tm_octree_share *share,
                               tm_error *error)
{
    const size_t ranks = (size_t)share->ranks + 1;
    const tm_share_list *lists[] = {&share->leaves_sent, &share->nodes_sent};
    tm_share_list *to[] = {&copy->leaves_sent, &copy->nodes_sent};
    bool done = true;
    *copy = *share;
    copy->leaf_number =
        copy_of(share->leaf_number, share->octree.leaves, sizeof *copy->leaf_number);
    copy->node_number =
        copy_of(share->node_number, share->octree.nodes, sizeof *copy->node_number);
    copy->first = copy_of(share->first, ranks, sizeof *copy->first);
    copy->first_node = copy_of(share->first_node, ranks, sizeof *copy->first_node);
    for (int i = 0; i < 2; i++) {
        to[i]->start = copy_of(lists[i]->start, ranks, sizeof *to[i]->start);
        to[i]->item =
            copy_of(lists[i]->item, lists[i]->start[share->ranks], sizeof *to[i]->item);
        done &= to[i]->start && to[i]->item;
    }
    const tm_status status = tm_octree_copy(&copy->octree, &share->octree, error);
    done &= copy->leaf_number && copy->node_number && copy->first && copy->first_node;
    return done ? status : tm_fail_memory(error);
}
