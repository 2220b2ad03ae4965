/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves that rules ask for, before balance. */
#ifndef TM_FOREST_DESCENT_H
#define TM_FOREST_DESCENT_H

#include "leaf_list.h"

/* Splits the roots of the octree's brick as the rules say, except those of TM_RULE_LEAVES
 * (see tm_octree_build), and appends the leaves to an empty list; each knows whether the
 * surface meets it. On its way down each octant has the lists of triangles that meet it,
 * of the surface and of every region: a list is made from the parent's. So the cost is
 * O(octants that are met × triangles in them). */
tm_status tm_octree_descend(tm_leaf_list *leaves, const tm_octree *octree,
                            const tm_surface *surface, const tm_octree_rule *rule,
                            size_t rules, tm_error *error);

/* Says of each leaf of the octree whether the surface meets it; the leaves must be in
 * order and fill the brick. The same cost. */
tm_status tm_octree_cross(tm_octree *octree, const tm_surface *surface, tm_error *error);

#endif
