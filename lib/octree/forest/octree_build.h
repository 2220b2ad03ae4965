/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes an octree: by rules over a surface, from another one, of leaves that are given.
 */
#ifndef TM_FOREST_OCTREE_BUILD_H
#define TM_FOREST_OCTREE_BUILD_H

#include "../../base/extern_c.h"
#include "octree.h"

TM_EXTERN_C_BEGIN

/* The octree over a surface: root cubes as brick.h says, for the least size of a rule; a
 * leaf is split while its level
 * is below that of a rule that holds for it and some of it is inside the surface or meets
 * it (what is outside all over is never needed); then leaves are split until two that
 * share a face or some of an edge differ by one level at most. *octree is overwritten.
 * TM_ERROR_INPUT: a level over the limit, a leaf that is not there, a surface without
 * extent, more leaves or nodes than 32-bit ids have; TM_ERROR_SYSTEM: memory.
 * Starts MPI where it is not yet (mpi_start.h). O(leaves + triangles × roots), see
 * descent.c. */
tm_status tm_octree_build(tm_octree *octree, const tm_surface *surface,
                          const tm_octree_rule *rule, size_t rules, tm_error *error);

/* Splits each leaf with split[leaf] != 0 once, and what balance then asks for. All leaves
 * and nodes get new numbers. Errors as above; *octree is then as it was. */
tm_status tm_octree_refine(tm_octree *octree, const tm_surface *surface,
                           const uint8_t *split, tm_error *error);

/* The octree of the leaves that are given, in any order, with octree->low, side and roots
 * set and all else zero. What they leave of the brick is filled with leaves as large as
 * balance allows, and, where the surface meets them, no larger than the largest of those
 * given that it meets. TM_ERROR_INPUT says which of those given, by its number in the
 * list, overlaps another one or would have to be split for balance. (*order)[leaf] is the
 * leaf's number in the list, TM_NONE of one that was not; malloc'ed, NULL after an error.
 * With surface NULL no leaf is crossed. O(leaves log leaves), O(leaves) where they come
 * in order. */
tm_status tm_octree_from_leaves(tm_octree *octree, const tm_leaf *leaf, size_t leaves,
                                const tm_surface *surface, uint32_t **order,
                                tm_error *error);

TM_EXTERN_C_END

#endif
