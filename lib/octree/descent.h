/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The leaves that rules ask for, before balance. */
#ifndef TM_OCTREE_DESCENT_H
#define TM_OCTREE_DESCENT_H

#include "brick.h"
#include "leaf_list.h"

/* Splits the roots as the rules say, except those of TM_RULE_LEAVES (see
 * tm_octree_build), and appends the leaves to an empty list; each knows whether the
 * surface meets it. `octree` says where the brick is. On its way down each octant has the
 * lists of triangles that meet it, of the surface and of every region: a list is made
 * from the parent's. So the cost is O(octants that are met × triangles in them), and of
 * the roots O(triangles). */
tm_status tm_octree_descend(tm_leaf_list *leaves, const tm_octree *octree,
                            const tm_brick *brick, const tm_surface *surface,
                            const tm_octree_rule *rule, size_t rules, tm_error *error);

#endif
