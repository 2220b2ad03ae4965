/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faces that a point is joined to: those around the ball of a node, or around a
 * cavity; how good that is, and the place at which the worst tetrahedron is best. */
#ifndef TM_OPERATION_CAVITY_BOUNDARY_H
#define TM_OPERATION_CAVITY_BOUNDARY_H

#include "../../element/tet_measure.h"

#include <stddef.h>
#include <stdint.h>

/* (face[i], point) is a positive order of a tetrahedron. */
typedef struct tm_cavity_boundary {
    const double (*xyz)[3];
    const uint32_t (*face)[3];
    size_t count;
} tm_cavity_boundary;

/* The least measure of the tetrahedra of p and the boundary; 0 as soon as one is below
 * `least`. O(count), as all of these. */
double tm_cavity_boundary_quality(const tm_cavity_boundary *boundary,
                                  tm_tet_measure measure, const double p[3],
                                  double least);

/* What these tetrahedra cost together; HUGE_VAL where one is below `least`, or the sum
 * not below `most`. */
double tm_cavity_boundary_cost(const tm_cavity_boundary *boundary, const tm_cost *cost,
                               const double p[3], double least, double most);

/* Whether p sees all faces from inside: all these tetrahedra are exactly positive. */
bool tm_cavity_boundary_sees(const tm_cavity_boundary *boundary, const double p[3]);

/* The mean of the boundary's nodes, each counted by its faces. */
void tm_cavity_boundary_centre(const tm_cavity_boundary *boundary, double p[3]);

/* How a node may move: freely (dimension 3), in the plane across `direction` (2), along
 * the line of `direction` (1), or not at all (0). */
typedef struct tm_freedom {
    int dimension;
    double direction[3]; /* of unit length */
} tm_freedom;

/* Takes from a vector what the node is not free to follow. */
void tm_freedom_restrict(const tm_freedom *freedom, double vector[3]);

/* Smoothing by an active set method: L. A. Freitag and C. Ollivier-Gooch, Tetrahedral
 * mesh improvement using swapping and smoothing, International Journal for Numerical
 * Methods in Engineering 40 (1997), section 3. Moves p, step by step, to where
 * tm_cavity_boundary_quality() is greatest nearby; stops where it is `enough`, or after
 * so many steps. The quality at p is never less than before. The place is rounded, so it
 * is for the caller to see that tetrahedra are exactly positive. Some 50 ns per face and
 * step. */
void tm_cavity_boundary_climb(const tm_cavity_boundary *boundary, tm_tet_measure measure,
                              const tm_freedom *freedom, double enough, int steps,
                              double p[3]);

#endif
