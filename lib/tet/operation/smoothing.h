/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where to put a node: the place at which the worst tetrahedron around it is best. An
 * active set method: L. A. Freitag and C. Ollivier-Gooch, Tetrahedral mesh improvement
 * using swapping and smoothing, International Journal for Numerical Methods in
 * Engineering 40 (1997), section 3. */
#ifndef TM_OPERATION_SMOOTHING_H
#define TM_OPERATION_SMOOTHING_H

#include "cavity_boundary.h"

/* How a node may move: freely (dimension 3), in the plane across `direction` (2), along
 * the line of `direction` (1), or not at all (0). */
typedef struct tm_freedom {
    int dimension;
    double direction[3]; /* of unit length */
} tm_freedom;

/* Takes from a vector what the node is not free to follow. */
void tm_freedom_restrict(const tm_freedom *freedom, double vector[3]);

/* Moves p, step by step, to where tm_cavity_boundary_quality() is greatest nearby; stops
 * where it is `enough`, or after so many steps. The quality at p is never less than
 * before. The place is rounded, so it is for the caller to see that tetrahedra are
 * exactly positive. Some 50 ns per face and step. */
void tm_cavity_boundary_climb(const tm_cavity_boundary *boundary, tm_tet_measure measure,
                              const tm_freedom *freedom, double enough, int steps,
                              double p[3]);

#endif
