/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of tm_octree_build(), a file each. */
#ifndef TM_FOREST_OCTREE_PARTS_H
#define TM_FOREST_OCTREE_PARTS_H

#include "leaf_list.h"
#include "brick.h"
#include "octree.h"
#include "rank_cuts.h"

/* descent.c: the leaves that rules ask for, before balance. */

/* Splits the roots of the octree's brick as the rules say, except those of TM_RULE_LEAVES
 * (see tm_octree_build), and appends the leaves to an empty list; each knows whether the
 * surface meets it. On its way down each octant has the lists of triangles that meet it,
 * of the surface and of every region: a list is made from the parent's. So the cost is
 * O(octants that are met × triangles in them). With `together` all ranks call it, with
 * the same surface and rules; what each gets is next to each other in the order of all.
 */
tm_status tm_octree_descend(tm_leaf_list *leaves, const tm_octree *octree,
                            const tm_surface *surface, const tm_octree_rule *rule,
                            size_t rules, bool together, tm_error *error);

/* Says of each leaf of the octree whether the surface meets it; the leaves must be in
 * order and fill the brick. The same cost. */
tm_status tm_octree_cross(tm_octree *octree, const tm_surface *surface, tm_error *error);

/* octree_build.c: what other ways to make an octree share with it. */

/* An octree without leaves. */
tm_octree tm_octree_on_brick(const tm_brick *brick, unsigned threads);

/* Appends leaves of the octree, those with split[leaf] != 0 as their children.
 * TM_ERROR_INPUT where one is too deep for that. */
tm_status tm_octree_split_leaves(tm_leaf_list *out, const tm_octree *octree,
                                 const tm_surface *surface, const tm_leaf *leaf,
                                 size_t leaves, const uint8_t *split, tm_error *error);

/* crowding.c: more of a surface in an octant than one of the mesh can hold. */

/* Whether the solid, or a gap in it, is thinner than two sides of an octant where that
 * has surface, or the triangles that it meets look in opposite directions, are of three
 * patches that do not meet at one corner, or have two corners in it. is_corner[nodes of
 * the surface]. O(count), and some queries of the surface. */
bool tm_octant_is_crowded(const tm_surface *surface, const bool *is_corner,
                          const uint32_t *triangle, size_t count, const double low[3],
                          double side);

/* Levels that an octant in one that is crowded gets more. */
enum { TM_CROWDED_LEVELS = 2 };

/* Whether the solid, or a gap in it, ends within two such sides behind or before a point
 * of a triangle; false of one without area. */
bool tm_octant_is_thin_at(const tm_surface *surface, uint32_t triangle,
                          const double point[3], double side);

/* octree_estimate.c: sizes as levels. */

/* The least size that a rule has; 0 where none has any. */
double tm_octree_least_size(const tm_octree_rule *rule, size_t rules);

/* Copies the rules to out[rules], with the level that makes leaves no larger than the
 * size where one has that; `side` is that of the root cubes. TM_ERROR_INPUT where that is
 * too deep. */
tm_status tm_octree_set_levels(const tm_octree_rule *rule, size_t rules, double side,
                               tm_octree_rule *out, tm_error *error);

/* balance.c: 2:1 balance. */

/* Splits as few leaves as can be until two that share a face or some of an edge differ by
 * one level at most. The leaves are in order and fill the brick, before and after; a new
 * one knows whether the surface meets it (which is only asked where its parent says that
 * the surface meets that; `surface` may be NULL where none does). With `cuts` the leaves
 * are those of one of several ranks, which all call it; else that is NULL. The errors of
 * tm_leaf_list_check(). O(leaves), 0.05 µs per leaf. */
tm_status tm_balance(tm_leaf_list *leaves, const tm_octree *octree,
                     const tm_rank_cuts *cuts, const tm_surface *surface,
                     tm_error *error);

/* octree_nodes.c: the nodes of an octree. */

/* Fills nodes, grid and node of an octree whose leaves are in order and are balanced over
 * faces and edges. Where they do not fill the brick the middles of edges and faces that
 * only leaves which are not there would have are missing. TM_ERROR_INPUT: 32-bit ids do
 * not do. O(leaves). */
tm_status tm_octree_number_nodes(tm_octree *octree, tm_error *error);

#endif
