/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Faces of the interior boundary that paths would flatten. */
#ifndef TM_LAYER_FEATURE_CUT_H
#define TM_LAYER_FEATURE_CUT_H

#include "feature.h"

/* Cuts the quadrilaterals that have two edges on paths which meet at a wide angle, from
 * the node where they do, so that each half has half of the angle. on_path and at as in
 * feature_region.h, which must be done before: these diagonals are on no path. O(faces).
 */
void tm_feature_cut_wide(const tm_feature *feature, tm_interior_boundary *boundary,
                         const tm_surface *surface, const uint8_t *on_path,
                         const tm_surface_point *at);

#endif
