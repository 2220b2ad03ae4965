/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The attributes of a surface's nodes as a function that is linear in each triangle. */
#ifndef TM_SURFACE_SURFACE_EVALUATE_H
#define TM_SURFACE_SURFACE_EVALUATE_H

#include "../surface.h"

TM_EXTERN_C_BEGIN

/* known[v] becomes whether node v of a block is where a node of the surface is; *unknown
 * is of how many that is not so. False where memory is out. Expected O(nodes). */
bool tm_surface_find_known(const tm_polygon_surface *polygons, const tm_block *node,
                           bool *known, size_t *unknown);

/* Sets the attributes of those nodes of a block that are on the surface, within 1e-8 of
 * its diagonal, and not known[v] yet; they are known then. The block has as many
 * attributes as the polygons that the surface was built of. O(nodes) queries. */
void tm_surface_evaluate(const tm_surface *surface, const tm_polygon_surface *polygons,
                         tm_block *node, bool *known);

TM_EXTERN_C_END

#endif
