/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A triangle surface as the boundary that nodes slide on. */
#ifndef TM_OPTIMISE_OPTIMISE_SURFACE_H
#define TM_OPTIMISE_OPTIMISE_SURFACE_H

#include "../surface/surface.h"
#include "optimise.h"

/* Rules name patches, curves and corners by their numbers in the surface, which must be
 * there as long as the boundary is. */
tm_boundary tm_boundary_of_surface(const tm_surface *surface);

#endif
