/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A rank knows where others begin, so it knows which of its leaves touch a cell of
 * theirs: these are their ghosts. What touches a ghost its rank knows, when that has
 * ghosts. */
#include "share_parts.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../forest/leaf_tree.h"

#include <stdlib.h>
#include <string.h>

enum { CHILDREN = 8, AXES = 3, DIRECTIONS = 27 };

bool tm_ghost_list_add(tm_ghost_list *list, const tm_leaf *leaf, uint32_t number)
{
    tm_ghost *grown =
        tm_grow(list->ghost, &list->room, list->count + 1, sizeof *list->ghost);
    if (!grown)
        return false;
    list->ghost = grown;
    grown[list->count++] = (tm_ghost){*leaf, number};
    return true;
}

typedef struct {
    const tm_octree *brick;
    const tm_rank_cuts *cuts;
    size_t *seen;        /* [ranks]: one more than the last leaf that is theirs, too */
    tm_ghost_list *send; /* [ranks] */
} sender;

/* Marks the ranks that have cells of an octant of 2^shift units which touch the leaf that
 * is beside it, in that direction of each axis, -1, 0 or 1. */
static void mark_ranks(const sender *s, const uint32_t anchor[AXES], unsigned shift,
                       const int direction[AXES], size_t leaf)
{
    const uint32_t most = ((uint32_t)1 << shift) - 1;
    const uint32_t last[AXES] = {anchor[0] + most, anchor[1] + most, anchor[2] + most};
    const unsigned rank = tm_rank_cuts_at(s->cuts, anchor);
    if (rank == tm_rank_cuts_at(s->cuts, last)) {
        s->seen[rank] = leaf + 1;
        return;
    }
    for (unsigned c = 0; c < CHILDREN; c++) {
        uint32_t child[AXES];
        bool touches = true;
        for (unsigned i = 0; i < AXES; i++)
            touches &= direction[i] == 0 || (c >> i & 1) == (direction[i] < 0);
        tm_octree_child(anchor, shift, c, child);
        if (touches)
            mark_ranks(s, child, shift - 1, direction, leaf);
    }
}

/* The octant of a leaf's size in a direction; false outside the brick. */
static bool find_beside(const sender *s, const tm_leaf *leaf, const int direction[AXES],
                        uint32_t anchor[AXES])
{
    const uint32_t side = (uint32_t)1 << tm_leaf_shift(leaf);
    for (int i = 0; i < AXES; i++) {
        if (direction[i] < 0 && leaf->anchor[i] == 0)
            return false;
        anchor[i] = direction[i] < 0   ? leaf->anchor[i] - side
                    : direction[i] > 0 ? leaf->anchor[i] + side
                                       : leaf->anchor[i];
        if (anchor[i] >> TM_OCTREE_FINEST >= s->brick->roots[i])
            return false;
    }
    return true;
}

/* Whether all that can touch a leaf is this rank's: between the corners of a box in Z
 * order is all that is in it. */
static bool is_within(const sender *s, const tm_leaf *leaf)
{
    const uint32_t side = (uint32_t)1 << tm_leaf_shift(leaf);
    uint32_t low[AXES], high[AXES];
    for (int i = 0; i < AXES; i++) {
        const uint32_t end = s->brick->roots[i] << TM_OCTREE_FINEST;
        low[i] = leaf->anchor[i] - (leaf->anchor[i] > 0);
        high[i] = leaf->anchor[i] + side - (leaf->anchor[i] + side == end);
    }
    return tm_rank_cuts_at(s->cuts, low) == s->cuts->rank &&
           tm_rank_cuts_at(s->cuts, high) == s->cuts->rank;
}

/* Lists a leaf for the ranks that have some beside it. */
static bool list_leaf(const sender *s, const tm_leaf *leaf, size_t l, size_t before)
{
    for (int d = 0; d < DIRECTIONS; d++) {
        const int direction[AXES] = {d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
        uint32_t anchor[AXES];
        if (find_beside(s, leaf, direction, anchor))
            mark_ranks(s, anchor, tm_leaf_shift(leaf), direction, l);
    }
    for (unsigned r = 0; r < s->cuts->ranks; r++)
        if (s->seen[r] == l + 1 && r != s->cuts->rank &&
            !tm_ghost_list_add(&s->send[r], leaf, (uint32_t)(before + l)))
            return false;
    return true;
}

/* One list of those for each rank; these are freed. */
static bool join(tm_ghost_list *all, tm_ghost_list *of, unsigned ranks, size_t *count)
{
    bool done = true;
    for (unsigned r = 0; r < ranks; r++) {
        count[r] = of[r].count;
        for (size_t i = 0; i < of[r].count && done; i++)
            done = tm_ghost_list_add(all, &of[r].ghost[i].leaf, of[r].ghost[i].number);
        free(of[r].ghost);
    }
    return done;
}

tm_status tm_share_find_ghosts(tm_ghost_list *ghosts, const tm_octree *brick,
                               const tm_leaf_list *own, const size_t *first,
                               const tm_rank_cuts *cuts, tm_error *error)
{
    const unsigned ranks = cuts->ranks;
    sender s = {brick, cuts, calloc(ranks, sizeof *s.seen),
                calloc(ranks, sizeof *s.send)};
    size_t *count = calloc(ranks, sizeof *count);
    tm_ghost_list all = {0};
    bool done = s.seen && s.send && count;
    for (size_t l = 0; l < own->count && done; l++)
        if (!is_within(&s, &own->leaf[l]))
            done = list_leaf(&s, &own->leaf[l], l, first[cuts->rank]);
    if (s.send && count)
        done &= join(&all, s.send, ranks, count);
    *ghosts = (tm_ghost_list){0};
    const tm_status status = tm_share_exchange(done, all.ghost, count, sizeof *all.ghost,
                                               (void **)&ghosts->ghost, error);
    for (unsigned r = 0; status == TM_OK && r < ranks; r++)
        ghosts->count += count[r];
    ghosts->room = ghosts->count;
    free(s.seen);
    free(s.send);
    free(count);
    free(all.ghost);
    return status;
}

/* What touches leaves that other ranks ask for. */
typedef struct {
    const tm_octree_share *share;
    tm_leaf_tree tree;
    unsigned rank; /* that asks */
    uint8_t *told; /* [local leaves]: to this rank */
    tm_ghost_list send;
    bool failed;
} teller;

/* Tells of all leaves in a cell of the tree that touch one, and are not the asker's. */
static void tell(teller *t, const tm_leaf *leaf, uint32_t cell,
                 const uint32_t anchor[AXES], unsigned shift)
{
    const uint32_t side = (uint32_t)1 << shift;
    const uint32_t own = (uint32_t)1 << tm_leaf_shift(leaf);
    if (cell == TM_NONE)
        return;
    for (int i = 0; i < AXES; i++)
        if (anchor[i] > leaf->anchor[i] + own || leaf->anchor[i] > anchor[i] + side)
            return;
    if (tm_is_leaf(cell)) {
        const tm_octree_share *s = t->share;
        const size_t l = cell & ~TM_LEAF_BIT;
        const uint32_t number = s->leaf_number[l];
        if (t->told[l] || (number >= s->first[t->rank] && number < s->first[t->rank + 1]))
            return;
        t->told[l] = 1;
        t->failed |= !tm_ghost_list_add(&t->send, &s->octree.leaf[l], number);
        return;
    }
    for (unsigned c = 0; c < CHILDREN; c++) {
        uint32_t low[AXES];
        tm_octree_child(anchor, shift, c, low);
        tell(t, leaf, t->tree.child[cell][c], low, shift - 1);
    }
}

/* Answers a rank that has asked for so many. */
static void answer(teller *t, const uint32_t *asked, size_t count)
{
    static const uint32_t low[AXES] = {0, 0, 0};
    const tm_octree_share *s = t->share;
    const size_t begin = t->send.count;
    for (size_t i = 0; i < count && !t->failed; i++) {
        const size_t l = asked[i] - s->first[s->rank] + s->own_first;
        tell(t, &s->octree.leaf[l], t->tree.top, low, tm_octree_shift(&s->octree));
    }
    for (size_t i = begin; i < t->send.count; i++)
        t->told[tm_first_not_below(s->leaf_number, s->octree.leaves,
                                   t->send.ghost[i].number)] = 0;
}

static int compare_ghosts(const void *a, const void *b)
{
    const uint32_t p = ((const tm_ghost *)a)->number, q = ((const tm_ghost *)b)->number;
    return (p > q) - (p < q);
}

/* Adds those that are new to ascending ghosts; *fresh has the numbers of these. */
static bool merge(tm_ghost_list *ghosts, tm_ghost *got, size_t count, uint32_t **fresh,
                  size_t *news)
{
    const size_t before = ghosts->count;
    size_t room = 0;
    *news = 0;
    if (count > 0)
        qsort(got, count, sizeof *got, compare_ghosts);
    for (size_t i = 0; i < count; i++) {
        if ((i > 0 && got[i].number == got[i - 1].number) ||
            bsearch(&got[i], ghosts->ghost, before, sizeof *got, compare_ghosts))
            continue;
        if (!tm_ghost_list_add(ghosts, &got[i].leaf, got[i].number) ||
            !tm_append(fresh, news, &room, got[i].number))
            return false;
    }
    if (ghosts->count > before)
        qsort(ghosts->ghost, ghosts->count, sizeof *got, compare_ghosts);
    return true;
}

/* Asks the ranks of leaves, ascending, for what touches them. */
static tm_status ask(teller *t, tm_ghost_list *ghosts, uint32_t **asked, size_t *count,
                     tm_error *error)
{
    const tm_octree_share *s = t->share;
    size_t *counts = calloc(s->ranks, sizeof *counts);
    uint32_t *got = NULL;
    tm_ghost *told = NULL;
    for (size_t i = 0, r = 0; counts && i < *count; i++) {
        while ((*asked)[i] >= s->first[r + 1])
            r++;
        counts[r]++;
    }
    tm_status status =
        tm_share_exchange(counts, *asked, counts, sizeof *got, (void **)&got, error);
    t->send.count = 0;
    for (size_t at = 0; status == TM_OK && t->rank < s->ranks; t->rank++) {
        const size_t begin = t->send.count;
        answer(t, got + at, counts[t->rank]);
        at += counts[t->rank];
        counts[t->rank] = t->send.count - begin;
    }
    t->rank = 0;
    if (status == TM_OK)
        status = tm_share_exchange(!t->failed, t->send.ghost, counts, sizeof *told,
                                   (void **)&told, error);
    free(*asked);
    *asked = NULL;
    if (status == TM_OK && !merge(ghosts, told, tm_share_total(s, counts), asked, count))
        status = tm_fail_memory(error);
    free(counts);
    free(got);
    free(told);
    return tm_ranks_agree(status, error);
}

tm_status tm_share_add_rings(tm_ghost_list *ghosts, const tm_octree_share *share,
                             unsigned more, tm_error *error)
{
    teller t = {.share = share, .told = calloc(share->octree.leaves + 1, 1)};
    uint32_t *asked = tm_new(ghosts->count, sizeof *asked);
    size_t count = ghosts->count;
    tm_status status = tm_leaf_tree_make(&t.tree, &share->octree, error);
    if (status == TM_OK && (!t.told || !asked))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    for (size_t i = 0; status == TM_OK && i < count; i++)
        asked[i] = ghosts->ghost[i].number;
    for (unsigned ring = 0; ring < more && status == TM_OK; ring++)
        status = ask(&t, ghosts, &asked, &count, error);
    tm_leaf_tree_free(&t.tree);
    free(t.told);
    free(t.send.ghost);
    free(asked);
    return status;
}
