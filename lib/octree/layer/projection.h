/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layer's outer nodes go onto the surface, and the nodes below make room. */
#ifndef TM_LAYER_PROJECTION_H
#define TM_LAYER_PROJECTION_H

#include "assemble.h"
#include "feature.h"

/* Puts each outer node where its feature says: on its corner, on its curve, on its patch;
 * between these they are spread by averaging, so that no face is squashed. Then the inner
 * nodes and those next to them are averaged. at[s] is where outer node s is on the
 * surface, before and after. Elements may be inverted by this. TM_ERROR_SYSTEM where
 * memory is out. O(nodes of the interior boundary) queries of the surface, O(elements).
 */
tm_status tm_project_layer(tm_assembly *assembly, const tm_interior_boundary *boundary,
                           const tm_feature *feature, const tm_surface *surface,
                           tm_surface_point *at, tm_error *error);

#endif
