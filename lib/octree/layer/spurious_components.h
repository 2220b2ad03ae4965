/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pieces of the mesh, and hollows in it, that the surface does not have: they come off
 * where a part of it is thinner than a leaf. */
#ifndef TM_LAYER_SPURIOUS_COMPONENTS_H
#define TM_LAYER_SPURIOUS_COMPONENTS_H

#include "interior_boundary.h"

/* Each piece of the interior boundary belongs to the shell of the surface that most of it
 * is closest to; of those of a shell only the largest stays. The leaves inside of another
 * one are taken away, or, where it is the interior boundary of a hollow, added. at[s] is
 * the place of the surface that is closest to interior boundary node s. *changed says
 * whether any leaf was; then the interior boundary must be found again. TM_ERROR_SYSTEM
 * where memory is out. O(leaves). */
tm_status tm_spurious_components_remove(tm_interior *interior, const tm_octree *octree,
                                        const tm_interior_boundary *boundary,
                                        const tm_surface *surface,
                                        const tm_surface_point *at, bool *changed,
                                        tm_error *error);

#endif
