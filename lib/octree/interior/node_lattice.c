/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "node_lattice.h"
#include "octant_mask.h"

#include "../../base/array.h"
#include "../forest/leaf_list.h"

#include <stdlib.h>
#include <string.h>

enum { OCTANTS = 8, SIDES = 6, EDGES = 12 };

static void join(tm_node_lattice *lattice, uint32_t low, uint32_t high, unsigned axis)
{
    lattice->next[low][2 * axis + 1] = high;
    lattice->next[high][2 * axis] = low;
}

/* Of edges that leaves have whole, and others halves of, there are only the halves. */
static void join_edges(tm_node_lattice *lattice, const uint32_t node[TM_LEAF_NODES])
{
    for (unsigned e = 0; e < EDGES; e++) {
        const unsigned axis = e / 4, i = e % 4;
        const unsigned low = axis == 0   ? (i & 1) << 1 | i >> 1 << 2
                             : axis == 1 ? (i & 1) | i >> 1 << 2
                                         : (i & 1) | i >> 1 << 1;
        const uint32_t from = node[low], to = node[low | 1u << axis];
        const uint32_t middle = node[TM_LEAF_EDGE + e];
        if (middle == TM_NONE) {
            join(lattice, from, to, axis);
        } else {
            join(lattice, from, middle, axis);
            join(lattice, middle, to, axis);
        }
    }
}

tm_status tm_node_lattice_make(tm_node_lattice *lattice, const tm_octree *octree,
                               tm_error *error)
{
    *lattice = (tm_node_lattice){.octree = octree};
    lattice->leaf = tm_new(octree->nodes, sizeof *lattice->leaf);
    lattice->next = tm_new(octree->nodes, sizeof *lattice->next);
    if (!lattice->leaf || !lattice->next)
        return tm_fail_memory(error);
    memset(lattice->leaf, 0xff, octree->nodes * sizeof *lattice->leaf);
    memset(lattice->next, 0xff, octree->nodes * sizeof *lattice->next);
    for (size_t l = 0; l < octree->leaves; l++) {
        join_edges(lattice, octree->node[l]);
        for (int p = 0; p < TM_LEAF_NODES; p++)
            if (octree->node[l][p] != TM_NONE)
                tm_octants_set(lattice->leaf[octree->node[l][p]], p, (uint32_t)l);
    }
    return tm_leaf_tree_make(&lattice->tree, octree, error);
}

void tm_node_lattice_free(tm_node_lattice *lattice)
{
    free(lattice->leaf);
    free(lattice->next);
    tm_leaf_tree_free(&lattice->tree);
    *lattice = (tm_node_lattice){0};
}

uint32_t tm_node_lattice_leaf_at(const tm_node_lattice *lattice, const double point[3])
{
    const tm_octree *octree = lattice->octree;
    const double units = (double)((uint32_t)1 << octree->finest) / octree->side;
    uint32_t grid[3];
    for (int i = 0; i < 3; i++) {
        const double at = (point[i] - octree->low[i]) * units;
        if (!(at >= 0 && at < (double)(octree->roots[i] << octree->finest)))
            return TM_NONE;
        grid[i] = (uint32_t)at;
    }
    unsigned shift = tm_octree_shift(octree);
    uint32_t cell = lattice->tree.top;
    while (tm_is_split(cell)) {
        shift--;
        cell = lattice->tree
                   .child[cell][(grid[0] >> shift & 1) | (grid[1] >> shift & 1) << 1 |
                                (grid[2] >> shift & 1) << 2];
    }
    return cell == TM_NONE ? TM_NONE : cell & ~TM_LEAF_BIT;
}

static void add(uint32_t near[TM_NEAR_NODES], unsigned *count, uint32_t node)
{
    if (node == TM_NONE || *count == TM_NEAR_NODES)
        return;
    for (unsigned i = 0; i < *count; i++)
        if (near[i] == node)
            return;
    near[(*count)++] = node;
}

unsigned tm_node_lattice_near(const tm_node_lattice *lattice, const double point[3],
                              unsigned steps, uint32_t near[TM_NEAR_NODES])
{
    const uint32_t leaf = tm_node_lattice_leaf_at(lattice, point);
    unsigned count = 0;
    if (leaf == TM_NONE)
        return 0;
    for (int c = 0; c < OCTANTS; c++)
        add(near, &count, lattice->octree->node[leaf][c]);
    for (unsigned step = 0, begin = 0; step < steps; step++) {
        const unsigned end = count;
        for (; begin < end; begin++)
            for (int side = 0; side < SIDES; side++)
                add(near, &count, lattice->next[near[begin]][side]);
    }
    return count;
}

double tm_node_lattice_size(const tm_node_lattice *lattice, uint32_t node)
{
    const tm_octree *octree = lattice->octree;
    uint32_t least = UINT32_MAX;
    for (unsigned side = 0; side < SIDES; side++) {
        const uint32_t next = lattice->next[node][side];
        const unsigned axis = side / 2;
        if (next == TM_NONE)
            continue;
        const uint32_t a = octree->grid[node][axis], b = octree->grid[next][axis];
        const uint32_t length = a < b ? b - a : a - b;
        least = length < least ? length : least;
    }
    return least * octree->side / (double)((uint32_t)1 << octree->finest);
}

bool tm_node_lattice_is_large(const tm_node_lattice *lattice, uint32_t leaf, double edge)
{
    const double more = 1.5; /* sides are edges times powers of 2 */
    const tm_leaf *of = &lattice->octree->leaf[leaf];
    return !of->crossed && tm_leaf_side(lattice->octree, of) > more * edge;
}
