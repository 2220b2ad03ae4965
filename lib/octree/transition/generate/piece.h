/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements whose corners are points of a leaf. */
#ifndef TM_GENERATE_PIECE_H
#define TM_GENERATE_PIECE_H

#include "../transition.h"

#include <stdbool.h>
#include <stdint.h>

enum { LEAF_POINTS = 27, PIECE_FACES = 6, CUBE_VOLUME = 6 * 2 * 2 * 2 };

/* The face of an element with its outside, as a number: the set of its points, of which
 * the order follows if it is convex, and which way it turns. */
typedef uint32_t piece_face;

enum { FACE_TURNS = 1 << LEAF_POINTS };

/* The faces of an element; returns how many. */
unsigned faces_of_piece(const tm_piece *piece, piece_face face[PIECE_FACES]);

/* The number of a face with k points that turn counter-clockwise seen from outside. */
piece_face face_of(unsigned k, const uint8_t *point);

/* Six times the volume of the tetrahedron a b c d in half sides of the leaf, positive if
 * a b c turns counter-clockwise seen from d. */
int volume_of_four(unsigned a, unsigned b, unsigned c, unsigned d);

/* Whether a quadrilateral is plane and convex, and no three corners are on a line. */
bool is_convex(const uint8_t point[4]);

/* Whether an element has only such faces and lies behind all of them. */
bool is_convex_piece(const tm_piece *piece);

/* Six times the volume. */
int volume_of(const tm_piece *piece);

/* Those of some samples of the leaf that are in the element, a bit each. */
uint64_t samples_in(const tm_piece *piece);

/* The smallest J_ENS of its corners (Donoso 2022). */
double quality_of(const tm_piece *piece);

#endif
