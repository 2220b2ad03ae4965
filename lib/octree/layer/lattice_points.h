/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places of a mesh's nodes at which every element is valid. */
#ifndef TM_LAYER_LATTICE_POINTS_H
#define TM_LAYER_LATTICE_POINTS_H

#include "assemble.h"

/* Fills xyz[assembly->mesh.nodes]: nodes of the lattice as they are on it, but the inner
 * ones 0.08 of the side of the smallest leaf around them inside: outward of the interior
 * boundary (octant_mask.h) is a direction in which all of it can be seen, and nothing is
 * tilted by so much that it would turn: as measured, J_ENS is above 0.09. (With 0.1 a
 * pyramid with three of them can be flat.) Middles are at the means of their leaf's
 * corners. TM_ERROR_SYSTEM where memory is out. O(leaves). */
tm_status tm_lattice_points(const tm_assembly *assembly, const tm_octree *octree,
                            const tm_interior *interior,
                            const tm_interior_boundary *boundary, double (*xyz)[3],
                            tm_error *error);

#endif
