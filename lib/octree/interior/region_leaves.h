/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where regions touch: which one each leaf is in, so that the boundary of each is a
 * manifold on which a layer of elements can be put; and leaves in parts. */
#ifndef TM_INTERIOR_REGION_LEAVES_H
#define TM_INTERIOR_REGION_LEAVES_H

#include "../../base/extern_c.h"
#include "interior_leaves.h"

TM_EXTERN_C_BEGIN

/* tm_interior_choose() of a surface with walls. Gives each leaf the region that its
 * centre is in, with `lay_out` others to those at corners and curves (region_layout.h),
 * then others to some until at each node the octants of each region, and
 * those of none, are a good mask (octant_mask.h). Fills label and octant, too; chosen are
 * the leaves of any region. Expected O(leaves). */
tm_status tm_interior_label(tm_interior *interior, const tm_octree *octree,
                            const tm_surface *surface, bool lay_out, tm_error *error);

/* Divides what tm_interior_label() filled, **part, an array of one: afterwards those are
 * *parts, each with the leaves of regions that have no node in common, and all with the
 * nodes `used` that one of them has. The first one keeps label and octant. The regions
 * are coloured in their order, with the first colour that is free. TM_ERROR_SYSTEM where
 * memory is out. O(parts * leaves). */
tm_status tm_interior_divide(tm_interior **part, size_t *parts, const tm_octree *octree,
                             size_t regions, tm_error *error);

TM_EXTERN_C_END

#endif
