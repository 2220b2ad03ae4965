/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether pieces that are grown (shelling.h) stay stars.
 *
 * By a ball: the largest one in the intersection of the inner half-spaces of the piece's
 * faces (kernel.h), whose centre is kept and asked first.
 *
 * By the centroid, for finite volumes: it is inside of all faces, and no line from it to
 * the centroid of a face or of the cell beyond is too steep for the face. How far it is
 * from being too steep is kept as the depth; as the centroid moves, the depth becomes
 * less by how far it moves at most, so that all faces are looked at only now and then. */
#ifndef TM_POLY_SHELLING_STAR_H
#define TM_POLY_SHELLING_STAR_H

#include "shelling.h"

/* Makes s->xyz. For TM_STAR_BALL it is scaled, by powers of two, so that no
 * side of the box around all nodes is less than half of the longest: stars stay stars.
 * False where memory is out, as below. */
bool tm_shelling_scale(tm_shelling *s);

/* Says that the centroid of the piece is what its moments say. */
void tm_shelling_set_centroid(tm_shelling *s);

/* Takes tetrahedron t into the box and the moments of the piece. */
void tm_shelling_measure(tm_shelling *s, uint32_t t);

/* Whether the piece with tetrahedron t is a star, or, where it was none by a given
 * radius, no worse than it was; then what is kept is of the piece with t. O(1), or
 * O(size) where the point that is kept does not do any more. *memory is false where
 * memory is out. */
bool tm_shelling_stays_star(tm_shelling *s, uint32_t t, bool *memory);

/* Whether the piece is a star; one tetrahedron is, if it is not flat, but by a given
 * radius. O(size). */
bool tm_shelling_is_star(tm_shelling *s, bool *memory);

#endif
