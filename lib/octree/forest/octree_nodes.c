/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A node is a corner of all leaves around it; or the middle of an edge that some leaves
 * around it have and others have halves of; or the middle of a face that a leaf on one
 * side has and four on the other have a quarter of. Each of them is met once on a walk
 * over the faces, edges and corners between octants of the same size, from the largest
 * down, as T. Ju, F. Losasso, S. Schaefer and J. Warren walk in Dual contouring of
 * Hermite data, 2002, and the leaves around it are then known: no table of nodes is
 * needed. */
#include "octree_parts.h"

#include "../../base/array.h"
#include "leaf_tree.h"

#include <stdlib.h>

enum { CHILDREN = 8, AXES = 3, AROUND_EDGE = 4 };

typedef struct walk {
    uint32_t (*child)[CHILDREN];
    uint32_t (*node)[TM_LEAF_NODES];
    size_t nodes;
} walk;

/* The two other axes, the lower first. */
static const uint8_t other_axes[AXES][2] = {{1, 2}, {0, 2}, {0, 1}};

static uint32_t child(const walk *w, uint32_t cell, unsigned corner)
{
    return cell == TM_NONE ? TM_NONE : w->child[cell][corner];
}

static void put(walk *w, uint32_t leaf, unsigned point, uint32_t id)
{
    w->node[leaf & ~TM_LEAF_BIT][point] = id;
}

/* Cell i around a corner (as corners of a cube are numbered) has it as its
 * corner 7 - i, and so has the leaf in it that touches it. */
static void walk_corner(walk *w, const uint32_t cell[CHILDREN])
{
    const uint32_t id = (uint32_t)w->nodes;
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
    const uint32_t id = (uint32_t)w->nodes++;
    for (unsigned i = 0; i < AROUND_EDGE; i++) {
        if (tm_is_leaf(cell[i]))
            put(w, cell[i], TM_LEAF_EDGE + 4 * axis + (3 - i), id);
        if (!tm_is_split(cell[i]))
            continue;
        const unsigned low = edge_corner(axis, i), high = low | 1U << axis;
        put(w, w->child[cell[i]][low], TM_LEAF_CORNER + high, id);
        put(w, w->child[cell[i]][high], TM_LEAF_CORNER + low, id);
    }
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
    const uint32_t id = (uint32_t)w->nodes++;
    const unsigned across = (CHILDREN - 1) ^ 1U << axis;
    put(w, leaf, TM_LEAF_FACE + 2 * axis + (side ? 0 : 1), id);
    for (unsigned c = 0; c < CHILDREN; c++)
        if ((c >> axis & 1) == side)
            put(w, w->child[split][c], TM_LEAF_CORNER + (c ^ across), id);
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

/* All that is inside a cell. */
static void walk_cell(walk *w, uint32_t cell)
{
    if (cell == TM_NONE)
        return;
    if (tm_is_leaf(cell)) {
        for (unsigned point = TM_LEAF_EDGE; point < TM_LEAF_NODES; point++)
            put(w, cell, point, TM_NONE);
        return;
    }
    const uint32_t *around = w->child[cell];
    for (unsigned c = 0; c < CHILDREN; c++)
        walk_cell(w, around[c]);
    for (unsigned axis = 0; axis < AXES; axis++)
        for (unsigned c = 0; c < CHILDREN; c++)
            if (!(c >> axis & 1))
                walk_face(w, axis, around[c], around[c | 1U << axis]);
    for (unsigned axis = 0; axis < AXES; axis++)
        walk_edges_around(w, axis, around);
    walk_corner(w, around);
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

/* Numbers the nodes anew in the order in which the leaves have them, and says where each
 * is. */
static void order_nodes(tm_octree *octree, uint32_t *number)
{
    uint32_t next = 0;
    for (size_t i = 0; i < octree->leaves; i++) {
        const tm_leaf *leaf = &octree->leaf[i];
        const unsigned half = TM_OCTREE_LEVEL_MAX - leaf->level;
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            uint32_t *v = &octree->node[i][p];
            if (*v == TM_NONE)
                continue;
            if (number[*v] == TM_NONE) {
                for (int k = 0; k < AXES; k++)
                    octree->grid[next][k] =
                        leaf->anchor[k] + ((uint32_t)tm_leaf_point[p][k] << half);
                number[*v] = next++;
            }
            *v = number[*v];
        }
    }
}

static tm_status set_grid(tm_octree *octree, tm_error *error)
{
    uint32_t *number = tm_new(octree->nodes, sizeof *number);
    octree->grid = tm_new(octree->nodes, sizeof *octree->grid);
    if (!number || !octree->grid) {
        free(number);
        return tm_fail_memory(error);
    }
    for (size_t v = 0; v < octree->nodes; v++)
        number[v] = TM_NONE;
    order_nodes(octree, number);
    free(number);
    return TM_OK;
}

tm_status tm_octree_number_nodes(tm_octree *octree, tm_error *error)
{
    tm_leaf_tree tree;
    const tm_status status = tm_leaf_tree_make(&tree, octree, error);
    if (status != TM_OK)
        return status;
    octree->node = tm_new(octree->leaves, sizeof *octree->node);
    if (!octree->node) {
        tm_leaf_tree_free(&tree);
        return tm_fail_memory(error);
    }
    walk w = {.child = tree.child, .node = octree->node};
    walk_cell(&w, tree.top);
    walk_border(&w, tree.top);
    tm_leaf_tree_free(&tree);
    octree->nodes = w.nodes;
    if (w.nodes >= TM_NONE)
        return tm_fail(error, TM_ERROR_INPUT, "the octree has more than %u nodes",
                       TM_NONE);
    return set_grid(octree, error);
}
