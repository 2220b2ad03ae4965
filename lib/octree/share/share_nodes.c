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
    const tm_status status = tm_ranks_enough(done, error);
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

/* Nodes as the leaves that are here first are numbered by: own leaves have the first ones
 * of [own, past), and those below that are wanted. */
typedef struct {
    size_t own, past;
    uint8_t *wanted;  /* [own] */
    uint32_t *number; /* [own]: of those, in the whole octree, then here */
} numbering;

/* Goes over leaves in order, of which those before have `past` nodes; they are numbered
 * as leaves have them. */
static size_t count_nodes(const tm_octree *octree, size_t first, size_t end, size_t past,
                          uint8_t *wanted, size_t below)
{
    for (size_t l = first; l < end; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = octree->node[l][p];
            past += v != TM_NONE && v >= past;
            if (v < below)
                wanted[v] = 1;
        }
    return past;
}

static bool find_own(const tm_octree_share *s, numbering *n)
{
    n->own = count_nodes(&s->octree, 0, s->own_first, 0, NULL, 0);
    n->wanted = calloc(n->own + 1, 1);
    n->number = calloc(n->own + 1, sizeof *n->number);
    n->past = n->own;
    if (n->wanted)
        n->past =
            count_nodes(&s->octree, s->own_first, s->own_past, n->own, n->wanted, n->own);
    return n->wanted && n->number;
}

/* Point p of a leaf of another rank. */
typedef struct {
    uint32_t leaf, point;
} question;

/* To the ranks, in order. */
typedef struct {
    question *question;
    uint32_t *node; /* which one each is for */
    size_t count;
    size_t *counts; /* [ranks] */
} questions;

/* Ghosts before the own leaves are gone through in order, so in that of their ranks. */
static bool list_questions(const tm_octree_share *s, const numbering *n, questions *q)
{
    q->question = tm_new(n->own, sizeof *q->question);
    q->node = tm_new(n->own, sizeof *q->node);
    q->counts = calloc(s->ranks, sizeof *q->counts);
    unsigned rank = 0;
    if (!q->question || !q->node || !q->counts)
        return false;
    for (size_t l = 0; l < s->own_first; l++) {
        while (s->leaf_number[l] >= s->first[rank + 1])
            rank++;
        for (uint32_t p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = s->octree.node[l][p];
            if (v == TM_NONE || !n->wanted[v])
                continue;
            n->wanted[v] = 0;
            q->node[q->count] = v;
            q->question[q->count++] = (question){s->leaf_number[l], p};
            q->counts[rank]++;
        }
    }
    return true;
}

/* The number in the whole octree of a node of an own leaf. */
static uint32_t number_of(const tm_octree_share *s, const numbering *n, uint32_t node)
{
    return node == TM_NONE ? node
           : node < n->own ? n->number[node]
                           : (uint32_t)(node - n->own + s->first_node[s->rank]);
}

static tm_status ask(const tm_octree_share *s, const numbering *n, tm_error *error)
{
    questions q = {0};
    question *asked = NULL;
    uint32_t *answer = NULL, *got = NULL;
    const bool done = list_questions(s, n, &q);
    tm_status status = tm_share_exchange(done, q.question, q.counts, sizeof *q.question,
                                         (void **)&asked, error);
    if (status == TM_OK) {
        const size_t count = tm_share_total(s, q.counts);
        answer = tm_new(count, sizeof *answer);
        for (size_t i = 0; answer && i < count; i++) {
            const size_t l = asked[i].leaf - s->first[s->rank] + s->own_first;
            answer[i] = number_of(s, n, s->octree.node[l][asked[i].point]);
        }
        status = tm_share_exchange(answer, answer, q.counts, sizeof *answer,
                                   (void **)&got, error);
    }
    for (size_t i = 0; status == TM_OK && i < q.count; i++)
        n->number[q.node[i]] = got[i];
    free(q.question);
    free(q.node);
    free(q.counts);
    free(asked);
    free(answer);
    free(got);
    return status;
}

/* Numbers the nodes of own leaves in the whole octree. */
static tm_status number_own(tm_octree_share *s, numbering *n, tm_error *error)
{
    const bool found = find_own(s, n);
    const size_t before = tm_ranks_before(n->past - n->own, &s->all_nodes);
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
    if (grown) {
        s->first_node = grown;
        grown[s->ranks] = s->all_nodes;
    }
    if (status == TM_OK && (!grown || !found))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    return status == TM_OK ? ask(s, n, error) : status;
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

/* Ghosts' rows are those of their ranks, with numbers in the whole octree. */
static tm_status give_rows(const tm_octree_share *s, const numbering *n, tm_error *error)
{
    const tm_share_list *list = &s->leaves_sent;
    const tm_octree *o = &s->octree;
    const size_t after = o->leaves - s->own_past;
    uint32_t(*send)[TM_LEAF_NODES] = tm_new(list->start[s->ranks], sizeof *send);
    size_t *counts = tm_new(s->ranks, sizeof *counts);
    void *got = NULL;
    for (unsigned r = 0; counts && r < s->ranks; r++)
        counts[r] = list->start[r + 1] - list->start[r];
    for (size_t i = 0; send && i < list->start[s->ranks]; i++)
        for (int p = 0; p < TM_LEAF_NODES; p++)
            send[i][p] = number_of(s, n, o->node[list->item[i]][p]);
    const tm_status status =
        tm_share_exchange(send && counts, send, counts, sizeof *send, &got, error);
    if (status == TM_OK && s->own_first > 0)
        memcpy(o->node, got, s->own_first * sizeof *o->node);
    if (status == TM_OK && after > 0)
        memcpy(o->node + s->own_past, (uint32_t(*)[TM_LEAF_NODES])got + s->own_first,
               after * sizeof *o->node);
    free(send);
    free(counts);
    free(got);
    return status;
}

/* The first ghost from that local leaf on. */
static size_t next_ghost(const tm_octree_share *s, size_t l)
{
    return l == s->own_first ? s->own_past : l;
}

static bool is_own(const tm_octree_share *s, uint32_t number)
{
    return number >= s->first_node[s->rank] && number < s->first_node[s->rank + 1];
}

/* The numbers of all nodes here, ascending: those of others are those of ghosts. */
static bool list_nodes(tm_octree_share *s)
{
    const size_t own = s->first_node[s->rank + 1] - s->first_node[s->rank];
    size_t count = 0, room = 0, n = 0, once = 0;
    uint32_t *foreign = NULL;
    for (size_t l = next_ghost(s, 0); l < s->octree.leaves; l = next_ghost(s, l + 1))
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t v = s->octree.node[l][p];
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
    s->octree.nodes = own + once;
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
    return s->node_number;
}

/* The local number of a node. */
static uint32_t node_here(const tm_octree_share *s, uint32_t number)
{
    return is_own(s, number)
               ? (uint32_t)(number - s->first_node[s->rank] + s->own_node_first)
               : (uint32_t)tm_first_not_below(s->node_number, s->octree.nodes, number);
}

/* Moves own nodes to where they are now. */
static bool place_own_nodes(tm_octree_share *s, const numbering *n)
{
    tm_octree *o = &s->octree;
    const size_t own = n->past - n->own;
    const size_t room = o->nodes > n->past ? o->nodes : n->past;
    void *grown = realloc(o->grid, (room + 1) * sizeof *o->grid);
    if (!grown)
        return false;
    o->grid = grown;
    memmove(o->grid + s->own_node_first, o->grid + n->own, own * sizeof *o->grid);
    for (size_t v = 0; v < n->own; v++)
        n->number[v] = node_here(s, n->number[v]);
    for (size_t l = s->own_first; l < s->own_past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &o->node[l][p];
            if (*v != TM_NONE)
                *v = *v < n->own ? n->number[*v]
                                 : (uint32_t)(*v - n->own + s->own_node_first);
        }
    return true;
}

/* Gives ghosts local numbers of their nodes, and says where these are. */
static void place_ghost_nodes(tm_octree_share *s)
{
    tm_octree *o = &s->octree;
    for (size_t l = next_ghost(s, 0); l < o->leaves; l = next_ghost(s, l + 1))
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &o->node[l][p];
            if (*v == TM_NONE)
                continue;
            *v = node_here(s, *v);
            const tm_leaf *leaf = &o->leaf[l];
            for (int k = 0; k < 3; k++)
                o->grid[*v][k] =
                    leaf->anchor[k] + ((uint32_t)tm_leaf_point[p][k]
                                       << (TM_OCTREE_LEVEL_MAX - leaf->level));
        }
}

static tm_status make(tm_octree_share *s, const tm_ghost_list *ghosts, numbering *n,
                      tm_error *error)
{
    tm_status status = number_own(s, n, error);
    if (status != TM_OK)
        return status;
    if (place_ghosts(s, ghosts) != TM_OK)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tell_ranks(s, s->leaf_number, s->octree.leaves, s->own_first,
                            s->own_past, s->first, &s->leaves_sent, error);
    if (status == TM_OK)
        status = give_rows(s, n, error);
    if (status == TM_OK && !(list_nodes(s) && place_own_nodes(s, n)))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK)
        return status;
    place_ghost_nodes(s);
    return tell_ranks(s, s->node_number, s->octree.nodes, s->own_node_first,
                      s->own_node_past, s->first_node, &s->nodes_sent, error);
}

tm_status tm_share_number_nodes(tm_octree_share *share, const tm_ghost_list *ghosts,
                                tm_error *error)
{
    numbering n = {.own = 0};
    const tm_status status = make(share, ghosts, &n, error);
    free(n.wanted);
    free(n.number);
    return status;
}
