/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shortest vector in the convex boundary of some vectors: P. Wolfe, Finding the
 * nearest point in a polytope, Mathematical Programming 11 (1976). */
#ifndef TM_OPERATION_SHORTEST_VECTOR_H
#define TM_OPERATION_SHORTEST_VECTOR_H

#include <stddef.h>

/* Writes it, rounded; zero where the boundary holds the origin. count > 0. Its product
 * with each of the vectors is at least its own square: if they are gradients, all
 * functions rise along it. */
void tm_shortest_vector(const double *const *vector, size_t count, double shortest[3]);

#endif
