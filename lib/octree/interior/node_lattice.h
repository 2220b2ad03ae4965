/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nodes of an octree as a graph: which leaves are around each, and which node is next
 * in each of the six directions. */
#ifndef TM_INTERIOR_NODE_LATTICE_H
#define TM_INTERIOR_NODE_LATTICE_H

#include "../forest/leaf_tree.h"

typedef struct tm_node_lattice {
    const tm_octree *octree;
    tm_leaf_tree tree;
    uint32_t (*leaf)[8]; /* [nodes]: the leaf that each octant (octant_mask.h) is in;
                            TM_NONE beyond the brick */
    uint32_t (*next)[6]; /* [nodes]: the other end of the shortest edge down (2 a) and up
                            (2 a + 1) axis a; TM_NONE where there is none */
} tm_node_lattice;

/* TM_ERROR_SYSTEM where memory is out; to be freed, after an error too. O(leaves). */
tm_status tm_node_lattice_make(tm_node_lattice *lattice, const tm_octree *octree,
                               tm_error *error);
void tm_node_lattice_free(tm_node_lattice *lattice);

/* The leaf that a point is in; TM_NONE beyond the brick. O(levels). */
uint32_t tm_node_lattice_leaf_at(const tm_node_lattice *lattice, const double point[3]);

enum { TM_NEAR_NODES = 343 };

/* Nodes around a point: the corners of the leaf that it is in, and those that are no more
 * than `steps` (up to 3) edges from one; 0 beyond the brick. Returns how many. */
unsigned tm_node_lattice_near(const tm_node_lattice *lattice, const double point[3],
                              unsigned steps, uint32_t near[TM_NEAR_NODES]);

/* The shortest edge at a node. */
double tm_node_lattice_size(const tm_node_lattice *lattice, uint32_t node);

/* Whether a leaf is larger than an edge, and no surface meets it. */
bool tm_node_lattice_is_large(const tm_node_lattice *lattice, uint32_t leaf, double edge);

#endif
