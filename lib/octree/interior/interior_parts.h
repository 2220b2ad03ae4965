/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of choosing leaves (interior_leaves.c), which one process makes of all of an
 * octree, and each of several ranks of its share (interior_share.c). */
#ifndef TM_INTERIOR_INTERIOR_PARTS_H
#define TM_INTERIOR_INTERIOR_PARTS_H

#include "contacts.h"
#include "interior_leaves.h"

/* Chooses those of the leaves [first, past) whose centres are inside the surface. */
void tm_interior_classify(const tm_interior *interior, const tm_octree *octree,
                          const tm_surface *surface, size_t first, size_t past);

/* Sets the octants of all chosen leaves in masks that are empty; those of a leaf's nodes
 * to whether it is chosen. */
void tm_interior_fill_masks(const tm_interior *interior, const tm_octree *octree);
void tm_interior_put_in_masks(const tm_interior *interior, const tm_octree *octree,
                              size_t leaf);

/* Changes leaves at nodes whose mask is not good, one after the other in the order of
 * nodes, until that was done at each; *contacts has the leaves at those that there were,
 * none where all masks are good. bad[nodes] is room. TM_ERROR_SYSTEM where memory is out.
 */
tm_status tm_interior_clean_round(tm_interior *interior, const tm_octree *octree,
                                  const tm_surface *surface, int round,
                                  tm_contacts *contacts, bool *bad, tm_error *error);

/* Marks as used the corners of chosen leaves, and no others; then the middles of edges
 * that these ask for. */
void tm_interior_use_nodes(const tm_interior *interior, const tm_octree *octree);
void tm_interior_use_middles(const tm_interior *interior, const tm_octree *octree);

/* Whether a leaf is at the border of the brick, or a hole is in it. */
bool tm_leaf_is_outside(const tm_octree *octree, const tm_leaf *leaf,
                        const tm_surface *surface);

#endif
