/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All leaves that have a node touch each other. So of the nodes of a rank's own leaves
 * that others have first, one of these says the number, and which one, the first ring of
 * ghosts tells; the nodes of ghosts are then what their ranks say. */
#include "share_parts.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

tm_status tm_share_exchange(bool done, const void *send, size_t *count, size_t size,
                            void **got, tm_error *error)
{
    const tm_status status = tm_ranks_agree(done ? TM_OK : tm_fail_memory(error), error);
    return status == TM_OK ? tm_ranks_exchange(send, count, size, got, count, error)
                           : status;
}

size_t tm_share_total(const tm_octree_share *share, const size_t *count)
{
    size_t total = 0;
    for (unsigned r = 0; r < share->ranks; r++)
        total += count[r];
    return total;
}

/* How many nodes the leaves up to that one have, if those before it have `past`; they are
 * numbered as leaves have them. */
static size_t count_nodes(const tm_octree *octree, size_t first, size_t end, size_t past)
{
    for (size_t l = first; l < end; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = octree->node[l][p];
            past += v != TM_NONE && v >= past;
        }
    return past;
}

/* Point p of a leaf of another rank. */
typedef struct {
    uint32_t leaf, point;
} question;

/* Asks for the numbers of the nodes below own_node_first that own leaves have:
 * number[own_node_first]. */
typedef struct {
    question *question;
    uint32_t *node; /* which one each is for */
    size_t count;
    size_t *counts; /* [ranks] */
} questions;

/* Marks those nodes. */
static void mark_foreign(const tm_octree_share *s, uint8_t *wanted)
{
    for (size_t l = s->own_first; l < s->own_past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = s->octree.node[l][p];
            if (v != TM_NONE && v < s->own_node_first)
                wanted[v] = 1;
        }
}

/* Ghosts before the own leaves are gone through in order, so in that of their ranks. */
static bool list_questions(const tm_octree_share *s, questions *q)
{
    uint8_t *wanted = calloc(s->own_node_first + 1, 1);
    q->question = tm_new(s->own_node_first, sizeof *q->question);
    q->node = tm_new(s->own_node_first, sizeof *q->node);
    q->counts = calloc(s->ranks, sizeof *q->counts);
    const bool done = wanted && q->question && q->node && q->counts;
    if (done)
        mark_foreign(s, wanted);
    unsigned rank = 0;
    for (size_t l = 0; done && l < s->own_first; l++) {
        while (s->leaf_number[l] >= s->first[rank + 1])
            rank++;
        for (uint32_t p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = s->octree.node[l][p];
            if (v == TM_NONE || !wanted[v])
                continue;
            wanted[v] = 0;
            q->node[q->count] = v;
            q->question[q->count++] = (question){s->leaf_number[l], p};
            q->counts[rank]++;
        }
    }
    free(wanted);
    return done;
}

/* The number of a local node that is this rank's own. */
static uint32_t own_number(const tm_octree_share *s, uint32_t node)
{
    return (uint32_t)(node - s->own_node_first + s->first_node[s->rank]);
}

static tm_status ask(const tm_octree_share *s, uint32_t *number, tm_error *error)
{
    questions q = {0};
    question *asked = NULL;
    uint32_t *answer = NULL, *got = NULL;
    bool done = list_questions(s, &q);
    tm_status status = tm_share_exchange(done, q.question, q.counts, sizeof *q.question,
                                         (void **)&asked, error);
    if (status == TM_OK) {
        const size_t count = tm_share_total(s, q.counts);
        answer = tm_new(count, sizeof *answer);
        for (size_t i = 0; answer && i < count; i++) {
            const size_t l = asked[i].leaf - s->first[s->rank] + s->own_first;
            answer[i] = own_number(s, s->octree.node[l][asked[i].point]);
        }
        status = tm_share_exchange(answer, answer, q.counts, sizeof *answer,
                                   (void **)&got, error);
    }
    for (size_t i = 0; status == TM_OK && i < q.count; i++)
        number[q.node[i]] = got[i];
    free(q.question);
    free(q.node);
    free(q.counts);
    free(asked);
    free(answer);
    free(got);
    return status;
}

/* Gives own leaves the numbers of their nodes in the whole octree. */
static tm_status number_own(tm_octree_share *s, tm_error *error)
{
    tm_octree *o = &s->octree;
    s->own_node_first = count_nodes(o, 0, s->own_first, 0);
    s->own_node_past = count_nodes(o, s->own_first, s->own_past, s->own_node_first);
    const size_t before =
        tm_ranks_before(s->own_node_past - s->own_node_first, &s->all_nodes);
    tm_status status = TM_OK;
    if (s->all_nodes >= TM_NONE)
        status =
            tm_fail(error, TM_ERROR_INPUT, "the octree has more than %u nodes", TM_NONE);
    if (status == TM_OK)
        status = tm_ranks_share(&before, 1, sizeof before, (void **)&s->first_node, NULL,
                                error);
    size_t *grown =
        status == TM_OK
            ? realloc(s->first_node, (s->ranks + (size_t)1) * sizeof *s->first_node)
            : NULL;
    uint32_t *number = tm_new(s->own_node_first, sizeof *number);
    if (grown) {
        s->first_node = grown;
        grown[s->ranks] = s->all_nodes;
    }
    if (status == TM_OK && (!grown || !number))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = ask(s, number, error);
    for (size_t l = s->own_first; status == TM_OK && l < s->own_past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &o->node[l][p];
            if (*v != TM_NONE)
                *v = *v < s->own_node_first ? number[*v] : own_number(s, *v);
        }
    free(number);
    return status;
}

/* Puts these ghosts, ascending, around the own leaves, and drops the others. */
static tm_status place_ghosts(tm_octree_share *s, const tm_ghost_list *ghosts)
{
    tm_octree *o = &s->octree;
    const size_t own = s->own_past - s->own_first, count = own + ghosts->count;
    size_t before = 0;
    while (before < ghosts->count && ghosts->ghost[before].number < s->first[s->rank])
        before++;
    tm_leaf *leaf = realloc(o->leaf, (count + 1) * sizeof *leaf);
    o->leaf = leaf ? leaf : o->leaf;
    void *node = realloc(o->node, (count + 1) * sizeof *o->node);
    o->node = node ? node : o->node;
    uint32_t *number = realloc(s->leaf_number, (count + 1) * sizeof *number);
    s->leaf_number = number ? number : s->leaf_number;
    if (!leaf || !node || !number)
        return TM_ERROR_SYSTEM;
    memmove(leaf + before, leaf + s->own_first, own * sizeof *leaf);
    memmove(o->node + before, o->node + s->own_first, own * sizeof *o->node);
    for (size_t l = 0; l < count; l++) {
        const bool is_own = l >= before && l < before + own;
        const tm_ghost *g = &ghosts->ghost[l < before ? l : l - own];
        if (!is_own)
            leaf[l] = g->leaf;
        number[l] = is_own ? (uint32_t)(s->first[s->rank] + l - before) : g->number;
    }
    o->leaves = count;
    s->own_first = before;
    s->own_past = before + own;
    return TM_OK;
}

/* Tells the ranks of numbers in an ascending list, without those from own_first to
 * own_past, that this one has them: `list` becomes what others have of its own, where
 * first[ranks + 1] are the first numbers of ranks. */
static tm_status tell_ranks(const tm_octree_share *s, const uint32_t *number,
                            size_t count, size_t own_first, size_t own_past,
                            const size_t *first, tm_share_list *list, tm_error *error)
{
    size_t *counts = calloc(s->ranks, sizeof *counts);
    uint32_t *send = tm_new(count, sizeof *send);
    size_t n = 0;
    list->start = calloc(s->ranks + (size_t)1, sizeof *list->start);
    const bool done = counts && send && list->start;
    for (size_t i = 0, r = 0; done && i < count; i++) {
        if (i >= own_first && i < own_past)
            continue;
        while (number[i] >= first[r + 1])
            r++;
        counts[r]++;
        send[n++] = number[i];
    }
    const tm_status status =
        tm_share_exchange(done, send, counts, sizeof *send, (void **)&list->item, error);
    for (unsigned r = 0; status == TM_OK && r < s->ranks; r++)
        list->start[r + 1] = list->start[r] + counts[r];
    for (size_t i = 0; status == TM_OK && i < list->start[s->ranks]; i++)
        list->item[i] = (uint32_t)(list->item[i] - first[s->rank] + own_first);
    free(counts);
    free(send);
    return status;
}

static bool is_own(const tm_octree_share *s, uint32_t number)
{
    return number >= s->first_node[s->rank] && number < s->first_node[s->rank + 1];
}

/* The numbers of all nodes of local leaves, ascending. */
static bool list_nodes(tm_octree_share *s, size_t *nodes)
{
    const tm_octree *o = &s->octree;
    const size_t own = s->own_node_past - s->own_node_first;
    size_t count = 0, room = 0, n = 0, once = 0;
    uint32_t *foreign = NULL;
    for (size_t l = 0; l < o->leaves; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = o->node[l][p];
            if (v != TM_NONE && !is_own(s, v) && !tm_append(&foreign, &count, &room, v)) {
                free(foreign);
                return false;
            }
        }
    if (count > 0)
        qsort(foreign, count, sizeof *foreign, tm_compare_numbers);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || foreign[i] != foreign[once - 1])
            foreign[once++] = foreign[i];
    s->node_number = tm_new(own + once, sizeof *s->node_number);
    while (n < once && foreign[n] < s->first_node[s->rank])
        n++;
    s->own_node_first = n;
    s->own_node_past = n + own;
    for (size_t i = 0; s->node_number && i < own + once; i++)
        s->node_number[i] = i < n         ? foreign[i]
                            : i < n + own ? (uint32_t)(s->first_node[s->rank] + i - n)
                                          : foreign[i - own];
    free(foreign);
    *nodes = own + once;
    return s->node_number;
}

/* Gives leaves local numbers of their nodes, and says where these are. */
static void place_nodes(tm_octree_share *s)
{
    tm_octree *o = &s->octree;
    for (size_t l = 0; l < o->leaves; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &o->node[l][p];
            if (*v == TM_NONE)
                continue;
            if (is_own(s, *v))
                *v = (uint32_t)(*v - s->first_node[s->rank] + s->own_node_first);
            else
                *v = (uint32_t)tm_first_not_below(s->node_number, o->nodes, *v);
            const tm_leaf *leaf = &o->leaf[l];
            for (int k = 0; k < 3; k++)
                o->grid[*v][k] =
                    leaf->anchor[k] + ((uint32_t)tm_leaf_point[p][k]
                                       << (TM_OCTREE_LEVEL_MAX - leaf->level));
        }
}

tm_status tm_share_number_nodes(tm_octree_share *share, const tm_ghost_list *ghosts,
                                tm_error *error)
{
    tm_octree *o = &share->octree;
    tm_status status = number_own(share, error);
    if (status != TM_OK)
        return status;
    free(o->grid);
    o->grid = NULL;
    if (place_ghosts(share, ghosts) != TM_OK)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tell_ranks(share, share->leaf_number, o->leaves, share->own_first,
                            share->own_past, share->first, &share->leaves_sent, error);
    if (status == TM_OK)
        status = tm_share_fill_leaves(share, o->node, sizeof *o->node, error);
    if (status == TM_OK && list_nodes(share, &o->nodes))
        o->grid = tm_new(o->nodes, sizeof *o->grid);
    if (status == TM_OK && !o->grid)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK)
        return status;
    place_nodes(share);
    return tell_ranks(share, share->node_number, o->nodes, share->own_node_first,
                      share->own_node_past, share->first_node, &share->nodes_sent, error);
}
