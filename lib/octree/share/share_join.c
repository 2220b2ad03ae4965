/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A set of one rank is named by its smallest node. Where a node's own rank has it in one
 * set, and a rank where it is a ghost in another, both are one: these pairs, each once,
 * all ranks have, and join them in the same way. */
#include "octree_share.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

/* Of two sets. */
typedef struct {
    uint32_t own, other;
} pair;

static int compare_pairs(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    if (p->own != q->own)
        return p->own < q->own ? -1 : 1;
    return (p->other > q->other) - (p->other < q->other);
}

/* The pairs of different sets that local nodes are in, each once. */
static bool list_pairs(const uint32_t *own, const uint32_t *other, size_t nodes,
                       pair **list, size_t *count)
{
    size_t room = 0, once = 0;
    *count = 0;
    *list = NULL;
    for (size_t n = 0; n < nodes; n++) {
        if (own[n] == other[n])
            continue;
        pair *grown = tm_grow(*list, &room, *count + 1, sizeof *grown);
        if (!grown)
            return false;
        *list = grown;
        grown[(*count)++] = (pair){own[n], other[n]};
    }
    if (*count > 0)
        qsort(*list, *count, sizeof **list, compare_pairs);
    for (size_t i = 0; i < *count; i++)
        if (i == 0 || compare_pairs(&(*list)[once - 1], &(*list)[i]) != 0)
            (*list)[once++] = (*list)[i];
    *count = once;
    return true;
}

/* The names that pairs have, ascending, and the set of each: *set[i] is that of *name[i].
 */
static bool join(const pair *all, size_t count, uint32_t **name, uint32_t **set,
                 size_t *names)
{
    *name = tm_new(2 * count, sizeof **name);
    *set = tm_new(2 * count, sizeof **set);
    if (!*name || !*set)
        return false;
    for (size_t i = 0; i < count; i++) {
        (*name)[2 * i] = all[i].own;
        (*name)[2 * i + 1] = all[i].other;
    }
    if (count > 0)
        qsort(*name, 2 * count, sizeof **name, tm_compare_numbers);
    *names = 0;
    for (size_t i = 0; i < 2 * count; i++)
        if (i == 0 || (*name)[*names - 1] != (*name)[i])
            (*name)[(*names)++] = (*name)[i];
    for (size_t i = 0; i < *names; i++)
        (*set)[i] = (uint32_t)i;
    for (size_t i = 0; i < count; i++)
        tm_set_unite(*set, (uint32_t)tm_first_not_below(*name, *names, all[i].own),
                     (uint32_t)tm_first_not_below(*name, *names, all[i].other));
    return true;
}

tm_status tm_share_join_sets(const tm_octree_share *share, uint32_t *parent,
                             tm_error *error)
{
    const size_t nodes = share->octree.nodes;
    uint32_t *other = tm_new(nodes, sizeof *other), *name = NULL, *set = NULL;
    pair *list = NULL, *all = NULL;
    size_t count = 0, names = 0;
    tm_status status = tm_ranks_enough(other, error);
    for (size_t n = 0; status == TM_OK && n < nodes; n++)
        other[n] = share->node_number[tm_set_root(parent, (uint32_t)n)];
    if (status == TM_OK && other) { /* as all say */
        memcpy(parent, other, nodes * sizeof *other);
        status = tm_share_fill_nodes(share, other, sizeof *other, error);
    }
    if (status == TM_OK && !list_pairs(parent, other, nodes, &list, &count))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_ranks_share(list, count, sizeof *list, (void **)&all, &count, error);
    if (status == TM_OK && !join(all, count, &name, &set, &names))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    for (size_t n = 0; status == TM_OK && n < nodes; n++) {
        const size_t i = tm_first_not_below(name, names, parent[n]);
        if (i < names && name[i] == parent[n])
            parent[n] = name[tm_set_root(set, (uint32_t)i)];
    }
    free(other);
    free(list);
    free(all);
    free(name);
    free(set);
    return status;
}
