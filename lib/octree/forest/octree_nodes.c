/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A node is a corner of all leaves around it; or the middle of an edge that some leaves
 * around it have and others have halves of; or the middle of a face that a leaf on one
 * side has and four on the other have a quarter of. Each of them is met once on a walk
 * over the faces, edges and corners between octants of the same size, from the largest
 * down, as T. Ju, F. Losasso, S. Schaefer and J. Warren walk in Dual contouring of
 * Hermite data, 2002, and the leaves around it are then known: no table of nodes is
 * needed.
 *
 * Parts of the octree are walked at the same time: what is inside of each, and then what
 * is between them. Nodes have numbers of the part first, those between parts such from
 * above. */
#include "octree_parts.h"

#include "../../base/array.h"
#include "../../base/ids.h"
#include "../../base/parallel.h"
#include "leaf_tree.h"

#include <stdlib.h>

enum { CHILDREN = 8, AXES = 3, AROUND_EDGE = 4 };

/* Leaves of a part, at most. */
enum { PART_LEAVES = 8192 };

/* Over a part, or, with `between`, over what is between parts. */
typedef struct walk {
    uint32_t (*child)[CHILDREN];
    uint32_t (*node)[TM_LEAF_NODES];
    size_t nodes; /* so far */
    bool between;
    size_t room;
    uint32_t *leaf; /* [nodes] between parts: the first one that has it */
    bool failed;
} walk;

typedef struct part {
    uint32_t cell;
    size_t first, past; /* leaves */
    size_t nodes;       /* in it */
    size_t start;       /* nodes that leaves before it have */
} part;

/* The two other axes, the lower first. */
static const uint8_t other_axes[AXES][2] = {{1, 2}, {0, 2}, {0, 1}};

static uint32_t child(const walk *w, uint32_t cell, unsigned corner)
{
    return cell == TM_NONE ? TM_NONE : w->child[cell][corner];
}

/* Of a leaf that is not there, as where a part of an octree ends, it is nobody's. */
static void put(walk *w, uint32_t leaf, unsigned point, uint32_t id)
{
    if (leaf == TM_NONE)
        return;
    const uint32_t l = leaf & ~TM_LEAF_BIT;
    w->node[l][point] = id;
    if (w->between && !w->failed && l < w->leaf[w->nodes])
        w->leaf[w->nodes] = l;
}

/* The number that the next node has, if there is one. */
static uint32_t next_id(walk *w)
{
    if (!w->between)
        return (uint32_t)w->nodes;
    uint32_t *leaf = tm_grow(w->leaf, &w->room, w->nodes + 1, sizeof *leaf);
    w->failed |= !leaf;
    w->leaf = leaf ? leaf : w->leaf;
    if (leaf)
        leaf[w->nodes] = TM_NONE;
    return TM_NONE - 1 - (uint32_t)w->nodes;
}

/* Cell i around a corner (as corners of a cube are numbered) has it as its
 * corner 7 - i, and so has the leaf in it that touches it. */
static void walk_corner(walk *w, const uint32_t cell[CHILDREN])
{
    const uint32_t id = next_id(w);
    bool outside = true;
    for (unsigned i = 0; i < CHILDREN; i++) {
        const unsigned corner = CHILDREN - 1 - i;
        uint32_t c = cell[i];
        while (tm_is_split(c))
            c = w->child[c][corner];
        if (c == TM_NONE)
            continue;
        put(w, c, TM_LEAF_CORNER + corner, id);
        outside = false;
    }
    w->nodes += !outside;
}

/* The corner of cell i around an edge at which the edge begins. */
static unsigned edge_corner(unsigned axis, unsigned i)
{
    return (i & 1 ? 0 : 1U << other_axes[axis][0]) |
           (i & 2 ? 0 : 1U << other_axes[axis][1]);
}

/* The middle of an edge that leaves have on one side and pairs of leaves on another. */
static void number_edge(walk *w, unsigned axis, const uint32_t cell[AROUND_EDGE])
{
    const uint32_t id = next_id(w);
    for (unsigned i = 0; i < AROUND_EDGE; i++) {
        if (tm_is_leaf(cell[i]))
            put(w, cell[i], TM_LEAF_EDGE + 4 * axis + (3 - i), id);
        if (!tm_is_split(cell[i]))
            continue;
        const unsigned low = edge_corner(axis, i), high = low | 1U << axis;
        put(w, w->child[cell[i]][low], TM_LEAF_CORNER + high, id);
        put(w, w->child[cell[i]][high], TM_LEAF_CORNER + low, id);
    }
    w->nodes++;
}

/* An edge along axis with four cells around it: number i is at the high side of the lower
 * of the other axes where bit 0 is set, of the upper where bit 1 is. */
static void walk_edge(walk *w, unsigned axis, const uint32_t cell[AROUND_EDGE])
{
    bool split = false, leaf = false;
    for (unsigned i = 0; i < AROUND_EDGE; i++) {
        split |= tm_is_split(cell[i]);
        leaf |= tm_is_leaf(cell[i]);
    }
    if (!split)
        return;
    if (leaf) {
        number_edge(w, axis, cell);
        return;
    }
    uint32_t half[2][AROUND_EDGE], around[CHILDREN];
    for (unsigned i = 0; i < AROUND_EDGE; i++) {
        const unsigned opposite = edge_corner(axis, 3 - i);
        for (unsigned t = 0; t < 2; t++)
            around[opposite | t << axis] = half[t][i] =
                child(w, cell[i], edge_corner(axis, i) | t << axis);
    }
    walk_edge(w, axis, half[0]);
    walk_edge(w, axis, half[1]);
    walk_corner(w, around);
}

/* The edges between the eight cells around a point that are along axis: the halves before
 * and behind it. */
static void walk_edges_around(walk *w, unsigned axis, const uint32_t around[CHILDREN])
{
    for (unsigned t = 0; t < 2; t++) {
        uint32_t cell[AROUND_EDGE];
        for (unsigned i = 0; i < AROUND_EDGE; i++)
            cell[i] = around[edge_corner(axis, 3 - i) | t << axis];
        walk_edge(w, axis, cell);
    }
}

/* The middle of a face that a leaf has; beyond it are the children of a split cell whose
 * corners have `side` in the bit of the axis. */
static void number_face(walk *w, unsigned axis, uint32_t leaf, uint32_t split,
                        unsigned side)
{
    const uint32_t id = next_id(w);
    const unsigned across = (CHILDREN - 1) ^ 1U << axis;
    put(w, leaf, TM_LEAF_FACE + 2 * axis + (side ? 0 : 1), id);
    for (unsigned c = 0; c < CHILDREN; c++)
        if ((c >> axis & 1) == side)
            put(w, w->child[split][c], TM_LEAF_CORNER + (c ^ across), id);
    w->nodes++;
}

/* A face across axis between a low and a high cell. */
static void walk_face(walk *w, unsigned axis, uint32_t low, uint32_t high)
{
    if (!tm_is_split(low) && !tm_is_split(high))
        return;
    if (tm_is_leaf(low)) {
        number_face(w, axis, low, high, 0);
        return;
    }
    if (tm_is_leaf(high)) {
        number_face(w, axis, high, low, 1);
        return;
    }
    /* Of each cell the children at the other; they are at the other's side. */
    uint32_t around[CHILDREN];
    const unsigned bit = 1U << axis;
    for (unsigned c = 0; c < CHILDREN; c++)
        around[c] = child(w, c & bit ? high : low, c ^ bit);
    for (unsigned c = 0; c < CHILDREN; c++)
        if (!(c & bit))
            walk_face(w, axis, around[c], around[c | bit]);
    walk_edges_around(w, other_axes[axis][0], around);
    walk_edges_around(w, other_axes[axis][1], around);
    walk_corner(w, around);
}

/* What is between the children of a cell. */
static void walk_between(walk *w, const uint32_t around[CHILDREN])
{
    for (unsigned axis = 0; axis < AXES; axis++)
        for (unsigned c = 0; c < CHILDREN; c++)
            if (!(c >> axis & 1))
                walk_face(w, axis, around[c], around[c | 1U << axis]);
    for (unsigned axis = 0; axis < AXES; axis++)
        walk_edges_around(w, axis, around);
    walk_corner(w, around);
}

/* All that is inside a cell. */
static void walk_cell(walk *w, uint32_t cell)
{
    if (cell == TM_NONE)
        return;
    if (tm_is_leaf(cell)) {
        uint32_t *node = w->node[cell & ~TM_LEAF_BIT];
        for (unsigned point = TM_LEAF_EDGE; point < TM_LEAF_NODES; point++)
            node[point] = TM_NONE;
        return;
    }
    for (unsigned c = 0; c < CHILDREN; c++)
        walk_cell(w, w->child[cell][c]);
    walk_between(w, w->child[cell]);
}

/* The faces, edges and corners of the cell that has all roots. */
static void walk_border(walk *w, uint32_t top)
{
    for (unsigned axis = 0; axis < AXES; axis++) {
        walk_face(w, axis, TM_NONE, top);
        walk_face(w, axis, top, TM_NONE);
        for (unsigned i = 0; i < AROUND_EDGE; i++) {
            uint32_t cell[AROUND_EDGE] = {TM_NONE, TM_NONE, TM_NONE, TM_NONE};
            cell[i] = top;
            walk_edge(w, axis, cell);
        }
    }
    for (unsigned i = 0; i < CHILDREN; i++) {
        uint32_t cell[CHILDREN] = {TM_NONE, TM_NONE, TM_NONE, TM_NONE,
                                   TM_NONE, TM_NONE, TM_NONE, TM_NONE};
        cell[i] = top;
        walk_corner(w, cell);
    }
}

typedef struct numbering {
    tm_octree *octree;
    const tm_leaf_tree *tree;
    size_t parts, room;
    part *part; /* in the order of their leaves */
    walk between;
    uint32_t *number; /* [nodes between parts]: in the end */
    bool *failed;     /* [parts] */
} numbering;

/* The first or the last leaf of a cell. */
static size_t end_leaf(const numbering *n, uint32_t cell, bool last)
{
    while (!tm_is_leaf(cell)) {
        const uint32_t *child = n->tree->child[cell];
        unsigned c = last ? CHILDREN - 1 : 0;
        while (child[c] == TM_NONE)
            c = last ? c - 1 : c + 1;
        cell = child[c];
    }
    return cell & ~TM_LEAF_BIT;
}

/* Cuts a cell into parts. */
static bool cut(numbering *n, uint32_t cell)
{
    if (cell == TM_NONE)
        return true;
    const size_t first = end_leaf(n, cell, false), past = end_leaf(n, cell, true) + 1;
    bool done = true;
    if (past - first > PART_LEAVES) {
        for (unsigned c = 0; c < CHILDREN && done; c++)
            done = cut(n, n->tree->child[cell][c]);
        return done;
    }
    part *grown = tm_grow(n->part, &n->room, n->parts + 1, sizeof *grown);
    if (!grown)
        return false;
    n->part = grown;
    grown[n->parts++] = (part){.cell = cell, .first = first, .past = past};
    return true;
}

static void walk_part(void *context, size_t i)
{
    const numbering *n = context;
    walk w = {.child = n->tree->child, .node = n->octree->node};
    walk_cell(&w, n->part[i].cell);
    n->part[i].nodes = w.nodes;
}

/* What is between the parts of a cell; *next is the first of these. */
static void walk_between_parts(numbering *n, uint32_t cell, size_t *next)
{
    if (cell == TM_NONE)
        return;
    if (n->part[*next].cell == cell) {
        ++*next;
        return;
    }
    for (unsigned c = 0; c < CHILDREN; c++)
        walk_between_parts(n, n->tree->child[cell][c], next);
    walk_between(&n->between, n->tree->child[cell]);
}

/* How many nodes the leaves before each part have. */
static void count_nodes(numbering *n)
{
    for (size_t k = 0; k < n->between.nodes; k++) {
        size_t begin = 0, end = n->parts;
        while (end - begin > 1) {
            const size_t middle = begin + (end - begin) / 2;
            if (n->part[middle].first <= n->between.leaf[k])
                begin = middle;
            else
                end = middle;
        }
        n->part[begin].nodes++;
    }
    size_t start = 0;
    for (size_t i = 0; i < n->parts; i++) {
        n->part[i].start = start;
        start += n->part[i].nodes;
    }
    n->octree->nodes = start;
}

static bool is_between(const numbering *n, uint32_t id)
{
    return id >= TM_NONE - n->between.nodes;
}

/* Gives the node at a point of leaf i that number, and says where it is. */
static void give_number(const numbering *n, size_t i, int p, uint32_t number)
{
    const tm_leaf *leaf = &n->octree->leaf[i];
    const unsigned half = TM_OCTREE_LEVEL_MAX - leaf->level;
    for (int k = 0; k < AXES; k++)
        n->octree->grid[number][k] =
            leaf->anchor[k] + ((uint32_t)tm_leaf_point[p][k] << half);
}

/* Numbers the nodes that leaves of a part have first, in the order in which these have
 * them. */
static void number_part(void *context, size_t i)
{
    const numbering *n = context;
    const part *own = &n->part[i];
    uint32_t next = (uint32_t)own->start;
    uint32_t *number = tm_new(own->nodes, sizeof *number);
    n->failed[i] = !number;
    for (size_t v = 0; number && v < own->nodes; v++)
        number[v] = TM_NONE;
    for (size_t l = own->first; number && l < own->past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &n->octree->node[l][p];
            if (*v == TM_NONE)
                continue;
            if (is_between(n, *v)) {
                const uint32_t k = TM_NONE - 1 - *v;
                if (n->between.leaf[k] != l)
                    continue;
                n->number[k] = next;
                give_number(n, l, p, next++);
                continue;
            }
            if (number[*v] == TM_NONE) {
                number[*v] = next;
                give_number(n, l, p, next++);
            }
            *v = number[*v];
        }
    free(number);
}

static void number_between(void *context, size_t i)
{
    const numbering *n = context;
    for (size_t l = n->part[i].first; l < n->part[i].past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &n->octree->node[l][p];
            if (*v != TM_NONE && is_between(n, *v))
                *v = n->number[TM_NONE - 1 - *v];
        }
}

/* Numbers the nodes anew in the order in which the leaves have them, and says where each
 * is. */
static tm_status order_nodes(numbering *n, tm_error *error)
{
    tm_octree *octree = n->octree;
    count_nodes(n);
    if (octree->nodes + n->between.nodes >= TM_IDS)
        return tm_fail(error, TM_ERROR_INPUT, "the octree has more than %u nodes",
                       TM_IDS);
    octree->grid = tm_new(octree->nodes, sizeof *octree->grid);
    n->number = tm_new(n->between.nodes, sizeof *n->number);
    n->failed = calloc(n->parts + 1, sizeof *n->failed);
    bool done = octree->grid && n->number && n->failed;
    if (done)
        tm_parallel(octree->threads, n->parts, number_part, n);
    for (size_t i = 0; i < n->parts && done; i++)
        done = !n->failed[i];
    if (done)
        tm_parallel(octree->threads, n->parts, number_between, n);
    return done ? TM_OK : tm_fail_memory(error);
}

static tm_status walk_all(numbering *n, tm_error *error)
{
    const tm_leaf_tree *tree = n->tree;
    size_t next = 0;
    n->octree->node = tm_new(n->octree->leaves, sizeof *n->octree->node);
    if (!n->octree->node || !cut(n, tree->top))
        return tm_fail_memory(error);
    n->between = (walk){.child = tree->child, .node = n->octree->node, .between = true};
    tm_parallel(n->octree->threads, n->parts, walk_part, n);
    walk_between_parts(n, tree->top, &next);
    walk_border(&n->between, tree->top);
    return n->between.failed ? tm_fail_memory(error) : TM_OK;
}

tm_status tm_octree_number_nodes(tm_octree *octree, tm_error *error)
{
    tm_leaf_tree tree;
    tm_status status = tm_leaf_tree_make(&tree, octree, error);
    if (status != TM_OK)
        return status;
    numbering n = {.octree = octree, .tree = &tree};
    status = walk_all(&n, error);
    tm_leaf_tree_free(&tree);
    if (status == TM_OK)
        status = order_nodes(&n, error);
    free(n.part);
    free(n.between.leaf);
    free(n.number);
    free(n.failed);
    return status;
}
