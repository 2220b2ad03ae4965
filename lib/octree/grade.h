/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Better proportions where small leaves meet a large one. */
#ifndef TM_OCTREE_GRADE_H
#define TM_OCTREE_GRADE_H

#include "assemble.h"

/* Moves the nodes of faces that are divided in four, below the skin, by a fifth of the
 * large leaf's side into it. A leaf with one such face is then 0.8 of a cube high: of its
 * seventeen elements the worst has J_ENS 0.47 in place of 0.37, the mean 0.56 in place of
 * 0.51, and the hexahedra of the small leaves, which become higher, stay at 1. The nodes
 * are to be on the lattice. TM_ERROR_SYSTEM where memory is out. O(leaves). */
tm_status tm_grade(tm_assembly *assembly, const tm_octree *octree, const tm_solid *solid,
                   tm_error *error);

#endif
