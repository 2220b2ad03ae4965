/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many elements rules ask for, before anything is made. */
#ifndef TM_FOREST_OCTREE_ESTIMATE_H
#define TM_FOREST_OCTREE_ESTIMATE_H

#include "../../base/extern_c.h"
#include "octree.h"

TM_EXTERN_C_BEGIN

/* About how many elements octree_mesh.h makes of tm_octree_build()'s octree of these
 * rules, if all leaves were `coarser` times as large; *side is that of the smallest
 * leaves. From areas and the volume, and where a rule is for a part of the space from
 * points of that. On solids that are some leaves thick it is within a factor of two, as
 * measured; more is said for thinner ones, and what lists of leaves and balance split is
 * not counted. TM_ERROR_INPUT as of tm_octree_build(). O(triangles + 40 000 × rules);
 * with larger leaves where the surface bends less it is asked as often how thin it is. */
tm_status tm_octree_estimate(const tm_surface *surface, const tm_octree_rule *rule,
                             size_t rules, double coarser, double *elements, double *side,
                             tm_error *error);

/* The level that a rule asks for in roots of that side: its own, or that of the largest
 * leaves that are no larger than its size. */
unsigned tm_octree_rule_level(const tm_octree_rule *rule, double side);

/* Whether a rule for a box or a region can hold for any octant that is not outside of the
 * surface. Says so, too, where the surfaces only come close to each other. Expected
 * O(triangles of the region). */
bool tm_octree_rule_reaches(const tm_octree_rule *rule, const tm_surface *surface);

TM_EXTERN_C_END

#endif
