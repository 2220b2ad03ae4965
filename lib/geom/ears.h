/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polygons into triangles by cutting off ears (G. H. Meisters, Polygons have ears, The
 * American Mathematical Monthly 82, 1975), the one with the shortest diagonal first. What
 * is an ear is seen in the coordinate plane that the polygon is nearest to. */
#ifndef TM_GEOM_EARS_H
#define TM_GEOM_EARS_H

#include "../base/extern_c.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* Cuts the polygon through k nodes of xyz into at most k - 2 triangles, which turn as it
 * does; returns how many. A corner that is the node before again is none. Corners may
 * be in one place, where the polygon is slit open to its holes. aside: room for
 * k items, apart from node. A flat triangle is made only where nothing else is left.
 * O(k^2) for convex ones, O(k^3) at most. */
size_t tm_cut_ears(const double (*xyz)[3], const uint32_t *node, size_t k,
                   uint32_t *aside, uint32_t (*triangle)[3]);

TM_EXTERN_C_END

#endif
