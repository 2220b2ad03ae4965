/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The last step of the mesh: no element is inverted. */
#ifndef TM_LAYER_UNTANGLING_H
#define TM_LAYER_UNTANGLING_H

#include "octree_mesh.h"

/* Moves nodes around elements of low quality until these are better (optimise.h). Where
 * some are still not valid, their nodes go back towards the lattice, half of the way at a
 * time, until all elements are valid; on the lattice they are. Outer nodes that then are
 * not on the surface are marked as held and counted. TM_ERROR_SYSTEM where memory is
 * out. */
tm_status tm_untangle_layer(tm_octree_mesh *mesh, const tm_octree *octree,
                            const tm_surface *surface, tm_error *error);

#endif
