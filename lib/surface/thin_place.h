/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a solid, or a gap in it, is thin. */
#ifndef TM_SURFACE_THIN_PLACE_H
#define TM_SURFACE_THIN_PLACE_H

#include "surface.h"

/* Looks for a triangle from whose centre the surface is left again within a distance,
 * along its normal to either side: first within an eighth of `most`, then a quarter, a
 * half, all of it. Fills place with the first such centre; false where there is none.
 * O(triangles) queries. */
bool tm_surface_thin_place(const tm_surface *surface, double most, double place[3]);

#endif
