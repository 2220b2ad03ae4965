/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two leaves that share a face or some of an edge differ by one level at most just if
 * every octant that is split has all neighbours of its size beyond its faces and edges,
 * as leaves or split: their parents are split, too. Of these only some are not its own:
 * its parent's neighbours on the side where it is. So levels are gone through from the
 * deepest up; a split that is missing is of a level that is still to come. Which those
 * are is asked in chunks, by several threads; there are few, and they are made one after
 * the other. Of an octant that another rank has this one does not know whether it is
 * split, and tells that rank that it must be, level by level. The result is the only one
 * with as few leaves as can be, which p4est's balance finds too. */
#include "octree_parts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../ranks/ranks.h"
#include "leaf_tree.h"

#include <stdlib.h>
#include <string.h>

enum { CHILDREN = 8, AXES = 3, SIDES = 6 };

typedef struct anchors {
    size_t count, room;
    uint32_t (*anchor)[AXES];
} anchors;

/* Cells of the tree that are leaves have the numbers of those that are given, then of
 * those that are added. */
typedef struct balancer {
    tm_octree octree;         /* with the leaves that are given */
    const tm_rank_cuts *cuts; /* NULL: these fill the brick */
    tm_leaf_tree tree;
    anchors split[TM_OCTREE_FINEST]; /* octants that are, by level */
    unsigned level;                  /* of those that are looked at */
    anchors *missing;                /* [chunks]: octants of a level less that must be */
    anchors *away;                   /* [ranks]: of these, those that others have */
    size_t added, room;
    uint32_t *origin; /* [added]: the leaf that it is a part of */
    const tm_surface *surface;
    tm_leaf *now; /* all leaves, in the end */
    size_t leaves;
    size_t fresh; /* the number of parts among them */
    size_t *part; /* [fresh]: these, where the surface meets what they are a part of */
    bool failed;
} balancer;

static bool note(anchors *list, const uint32_t anchor[AXES])
{
    void *grown =
        tm_grow(list->anchor, &list->room, list->count + 1, sizeof *list->anchor);
    if (!grown)
        return false;
    list->anchor = grown;
    memcpy(list->anchor[list->count++], anchor, sizeof *list->anchor);
    return true;
}

/* Notes all octants that are split, of roots and below. */
static bool note_splits(balancer *b, uint32_t cell, const uint32_t anchor[AXES],
                        unsigned shift)
{
    if (!tm_is_split(cell))
        return true;
    bool done =
        shift > TM_OCTREE_FINEST || note(&b->split[TM_OCTREE_FINEST - shift], anchor);
    for (unsigned c = 0; c < CHILDREN && done; c++) {
        uint32_t low[AXES];
        tm_octree_child(anchor, shift, c, low);
        done = note_splits(b, b->tree.child[cell][c], low, shift - 1);
    }
    return done;
}

/* The child of an octant of 2^shift units that a point is in. */
static unsigned child_at(const uint32_t point[AXES], unsigned shift)
{
    unsigned c = 0;
    for (unsigned i = 0; i < AXES; i++)
        c |= (point[i] >> (shift - 1) & 1) << i;
    return c;
}

/* Whether the octant of 2^shift units at that place is there and split. */
static bool is_split(const balancer *b, const uint32_t anchor[AXES], unsigned shift)
{
    uint32_t cell = b->tree.top;
    for (unsigned s = tm_octree_shift(&b->octree); s > shift && tm_is_split(cell); s--)
        cell = b->tree.child[cell][child_at(anchor, s)];
    return tm_is_split(cell);
}

/* The neighbour of an octant's parent, of 2^shift units, on the sides where the octant
 * is, along those axes; false where it is outside of the brick. */
static bool find_neighbour(const balancer *b, const uint32_t octant[AXES], unsigned shift,
                           const bool along[AXES], uint32_t neighbour[AXES])
{
    const uint32_t side = (uint32_t)1 << shift;
    for (int i = 0; i < AXES; i++) {
        const bool high = octant[i] & side >> 1;
        neighbour[i] = octant[i] & ~(side - 1);
        if (!along[i])
            continue;
        if (!high && neighbour[i] == 0)
            return false;
        neighbour[i] = high ? neighbour[i] + side : neighbour[i] - side;
        if (neighbour[i] >> TM_OCTREE_FINEST >= b->octree.roots[i])
            return false;
    }
    return true;
}

static void look_at(void *context, size_t first, size_t past)
{
    static const bool along[SIDES][AXES] = {{true, false, false}, {false, true, false},
                                            {false, false, true}, {true, true, false},
                                            {true, false, true},  {false, true, true}};
    balancer *b = context;
    const unsigned shift = TM_OCTREE_FINEST + 1 - b->level; /* of parents */
    anchors *missing = &b->missing[first / TM_CHUNK];
    for (size_t i = first; i < past; i++)
        for (int s = 0; s < SIDES; s++) {
            uint32_t neighbour[AXES];
            if (find_neighbour(b, b->split[b->level].anchor[i], shift, along[s],
                               neighbour) &&
                !is_split(b, neighbour, shift) && !note(missing, neighbour))
                tm_mark(&b->failed);
        }
}

/* Splits the leaf that is a child of an octant, of 2^shift units at that place. */
static bool split_child(balancer *b, uint32_t octant, unsigned c,
                        const uint32_t anchor[AXES], unsigned shift)
{
    const uint32_t leaf = b->tree.child[octant][c] & ~TM_LEAF_BIT;
    const size_t given = b->octree.leaves;
    void *child =
        tm_grow(b->tree.child, &b->tree.room, b->tree.octants + 1, sizeof *b->tree.child);
    b->tree.child = child ? child : b->tree.child;
    uint32_t *origin =
        tm_grow(b->origin, &b->room, b->added + CHILDREN, sizeof *b->origin);
    b->origin = origin ? origin : b->origin;
    if (!child || !origin)
        return false;
    const uint32_t of = leaf < given ? leaf : origin[leaf - given];
    const uint32_t cell = (uint32_t)b->tree.octants++;
    b->tree.child[octant][c] = cell;
    for (unsigned i = 0; i < CHILDREN; i++) {
        origin[b->added] = of;
        b->tree.child[cell][i] = TM_LEAF_BIT | (uint32_t)(given + b->added++);
    }
    return note(&b->split[TM_OCTREE_FINEST - shift], anchor);
}

/* Splits what is at that place down to octants of 2^shift units, and these. Roots can be
 * leaves, what is above is split. */
static bool split_at(balancer *b, const uint32_t anchor[AXES], unsigned shift)
{
    uint32_t cell = b->tree.top;
    for (unsigned s = tm_octree_shift(&b->octree); s > shift; s--) {
        const unsigned c = child_at(anchor, s);
        const uint32_t low[AXES] = {anchor[0] >> (s - 1) << (s - 1),
                                    anchor[1] >> (s - 1) << (s - 1),
                                    anchor[2] >> (s - 1) << (s - 1)};
        if (!tm_is_split(b->tree.child[cell][c]) && !split_child(b, cell, c, low, s - 1))
            return false;
        cell = b->tree.child[cell][c];
    }
    return true;
}

/* Makes the splits of a list, of 2^shift units. */
static bool make_splits(balancer *b, const anchors *list, unsigned shift)
{
    bool done = true;
    for (size_t i = 0; i < list->count && done; i++) {
        const unsigned at = b->cuts ? tm_rank_cuts_at(b->cuts, list->anchor[i]) : 0;
        done = b->cuts && at != b->cuts->rank ? note(&b->away[at], list->anchor[i])
                                              : split_at(b, list->anchor[i], shift);
    }
    return done;
}

/* Makes the splits that are missing for those of a level. */
static bool complete(balancer *b, unsigned level)
{
    const unsigned threads = b->octree.threads;
    const size_t count = b->split[level].count;
    const size_t chunks = tm_parallel_chunks(count, TM_CHUNK);
    b->level = level;
    b->missing = calloc(chunks + 1, sizeof *b->missing);
    b->failed = !b->missing;
    if (b->missing)
        tm_parallel_runs(threads, count, TM_CHUNK, look_at, b);
    for (size_t c = 0; b->missing && c < chunks; c++) {
        if (!b->failed)
            b->failed = !make_splits(b, &b->missing[c], TM_OCTREE_FINEST + 1 - level);
        free(b->missing[c].anchor);
    }
    free(b->missing);
    return !b->failed;
}

static int compare_anchors(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(uint32_t[AXES]));
}

/* All that is noted for other ranks, each octant once, rank by rank, and no more noted:
 * to be freed. */
static void *collect_away(balancer *b, size_t *count)
{
    size_t all = 0, n = 0;
    for (unsigned r = 0; r < b->cuts->ranks; r++)
        all += b->away[r].count;
    uint32_t(*list)[AXES] = tm_new(all, sizeof *list);
    for (unsigned r = 0; list && r < b->cuts->ranks; r++) {
        anchors *away = &b->away[r];
        const size_t first = n;
        if (away->count > 0)
            qsort(away->anchor, away->count, sizeof *away->anchor, compare_anchors);
        for (size_t i = 0; i < away->count; i++)
            if (i == 0 || compare_anchors(away->anchor[i - 1], away->anchor[i]) != 0)
                memcpy(list[n++], away->anchor[i], sizeof *list);
        count[r] = n - first;
        away->count = 0;
    }
    return list;
}

/* Tells other ranks which octants of theirs must be split, of a level less, and splits
 * those that they tell. */
static tm_status complete_together(balancer *b, unsigned level, tm_error *error)
{
    const unsigned ranks = b->cuts->ranks;
    size_t *count = tm_new(ranks, sizeof *count), all = 0;
    void *send = count ? collect_away(b, count) : NULL;
    anchors told = {0};
    tm_status status = tm_ranks_enough(send && !b->failed, error);
    if (status == TM_OK)
        status = tm_ranks_exchange(send, count, sizeof *told.anchor,
                                   (void **)&told.anchor, count, error);
    for (unsigned r = 0; status == TM_OK && r < ranks; r++)
        all += count[r];
    told.count = all;
    if (status == TM_OK && !make_splits(b, &told, TM_OCTREE_FINEST + 1 - level))
        b->failed = true; /* of which the others hear with the next level */
    free(count);
    free(send);
    free(told.anchor);
    return status;
}

/* Level by level. */
static tm_status complete_all(balancer *b, tm_error *error)
{
    static const uint32_t low[AXES] = {0, 0, 0};
    tm_status status = TM_OK;
    b->failed = !note_splits(b, b->tree.top, low, tm_octree_shift(&b->octree));
    for (unsigned level = TM_OCTREE_FINEST - 1; level > 0 && status == TM_OK; level--) {
        if (!b->failed)
            b->failed = !complete(b, level);
        if (b->cuts)
            status = complete_together(b, level, error);
        else if (b->failed)
            status = tm_fail_memory(error);
    }
    return status == TM_OK && b->failed ? tm_fail_memory(error) : status;
}

/* The leaves of a cell. */
static void list_leaves(balancer *b, uint32_t cell, const uint32_t anchor[AXES],
                        unsigned shift)
{
    if (cell == TM_NONE)
        return;
    if (tm_is_leaf(cell)) {
        const size_t leaf = cell & ~TM_LEAF_BIT, given = b->octree.leaves;
        const bool is_part = leaf >= given;
        const tm_leaf *of = &b->octree.leaf[is_part ? b->origin[leaf - given] : leaf];
        if (is_part && of->crossed)
            b->part[b->fresh++] = b->leaves;
        b->now[b->leaves++] = (tm_leaf){.anchor = {anchor[0], anchor[1], anchor[2]},
                                        .level = (uint8_t)(TM_OCTREE_FINEST - shift),
                                        .crossed = of->crossed};
        return;
    }
    for (unsigned c = 0; c < CHILDREN; c++) {
        uint32_t low[AXES];
        tm_octree_child(anchor, shift, c, low);
        list_leaves(b, b->tree.child[cell][c], low, shift - 1);
    }
}

/* Whether the surface meets parts of leaves that it meets. */
static void cross_parts(void *context, size_t first, size_t past)
{
    const balancer *b = context;
    for (size_t i = first; i < past; i++) {
        tm_leaf *leaf = &b->now[b->part[i]];
        double low[3], high[3];
        tm_octree_box(&b->octree, leaf->anchor, tm_leaf_shift(leaf), low, high);
        leaf->crossed = tm_surface_meets_box(b->surface, low, high);
    }
}

static tm_status replace(balancer *b, tm_leaf_list *leaves, tm_error *error)
{
    static const uint32_t low[AXES] = {0, 0, 0};
    const size_t count = leaves->count + b->added - b->added / CHILDREN;
    const tm_status status = tm_leaf_list_check(count, error);
    if (status != TM_OK)
        return status;
    b->now = tm_new(count, sizeof *b->now);
    b->part = tm_new(b->added, sizeof *b->part);
    if (!b->now || !b->part) {
        free(b->now);
        return tm_fail_memory(error);
    }
    list_leaves(b, b->tree.top, low, tm_octree_shift(&b->octree));
    tm_parallel_runs(b->octree.threads, b->fresh, TM_CHUNK, cross_parts, b);
    free(leaves->leaf);
    *leaves = (tm_leaf_list){.count = count, .room = count, .leaf = b->now};
    return TM_OK;
}

tm_status tm_balance(tm_leaf_list *leaves, const tm_octree *octree,
                     const tm_rank_cuts *cuts, const tm_surface *surface, tm_error *error)
{
    balancer b = {.octree = *octree, .cuts = cuts, .surface = surface};
    b.octree.leaf = leaves->leaf;
    b.octree.leaves = leaves->count;
    tm_status status = tm_leaf_tree_make(&b.tree, &b.octree, error);
    if (cuts)
        b.away = calloc(cuts->ranks, sizeof *b.away);
    if (status == TM_OK && cuts && !b.away)
        status = tm_fail_memory(error);
    if (cuts)
        status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = complete_all(&b, error);
    if (status == TM_OK && b.added > 0)
        status = replace(&b, leaves, error);
    if (cuts)
        status = tm_ranks_agree(status, error);
    tm_leaf_tree_free(&b.tree);
    for (unsigned level = 0; level < TM_OCTREE_FINEST; level++)
        free(b.split[level].anchor);
    for (unsigned r = 0; b.away && r < cuts->ranks; r++)
        free(b.away[r].anchor);
    free(b.away);
    free(b.origin);
    free(b.part);
    return status;
}
