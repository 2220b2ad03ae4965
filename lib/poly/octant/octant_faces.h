/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes that smaller neighbours have on an octant's edges and faces put there, where they
 * have moved. */
#ifndef TM_POLY_OCTANT_FACES_H
#define TM_POLY_OCTANT_FACES_H

#include "octant_points.h"

#include <stddef.h>

/* Puts nodes in the middle of an edge between its ends, and those in the middle of a face
 * between its corners and, where these are in no plane, so far outward of the octant that
 * the four facets there are convex for it: d = |n · (x0 - x1 + x2 - x3)| / 4 makes them
 * just so, with the normal n of length 1. Octants from the largest to the smallest, since
 * a node between others may be a corner of smaller ones. xyz is of the nodes of .mix; no
 * node moves that is outer[], nor those of elements with such that would fall below a
 * J_ENS of 0.2 by it, and below what they are. *moved is how many did. TM_ERROR_SYSTEM
 * where memory is out: nothing has moved then. O(elements). */
tm_status tm_octant_faces_level(const tm_octant_points *points, double (*xyz)[3],
                                size_t nodes, const bool *outer, size_t *moved,
                                tm_error *error);

#endif
