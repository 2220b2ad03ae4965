/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts into which feature paths divide an interior boundary, and the patch of each.
 */
#ifndef TM_LAYER_FEATURE_REGION_H
#define TM_LAYER_FEATURE_REGION_H

#include "feature.h"

/* Sets feature->of for the nodes that are on no path: the patch of most of the nodes of
 * their region, by the closest triangles; TM_NONE where there is no clear majority.
 * on_path[f] has bit i set where the edge from corner i of face f is on a path; the
 * diagonals along which faces are cut are on paths too. O(n). */
tm_status tm_feature_regions(tm_feature *feature, const tm_interior_boundary *boundary,
                             const tm_surface *surface, const uint8_t *on_path,
                             const tm_surface_point *at, tm_error *error);

#endif
