/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The root cubes of an octree: how many, how large, where, and in which order. */
#ifndef TM_FOREST_BRICK_H
#define TM_FOREST_BRICK_H

#include "octree.h"

#include <stddef.h>
#include <stdint.h>

/* Roots along one axis, at most: over a box; and so that 32-bit coordinates do. */
enum { TM_BRICK_LONGEST = 32, TM_BRICK_ROOTS = 4096 };

typedef struct tm_brick {
    double low[3];
    double side;
    uint32_t roots[3];   /* along each axis */
    size_t count;        /* their product */
    uint32_t (*root)[3]; /* [count]: each one's position, in Z order, which is p4est's */
    struct p8est_connectivity *trees; /* p4est's brick */
} tm_brick;

/* The side of the root cubes over a box: see tm_brick_over(). */
double tm_brick_side(const double low[3], const double high[3], double size);

/* The brick over a bounding box: cubes of 1.01 times the shortest side of the box (as in
 * the mesher of Lobos and González 2015, so that a level is the same length as there),
 * along each axis as few as reach across, the box in the middle. Where that were more
 * than TM_BRICK_LONGEST along the longest side the cubes are larger. Where size is above
 * 0 they are `size`, doubled until they are so large or larger, and where the box is
 * thinner than that it is in the middle of cubes of this side; where its faces would go
 * through their centres it is half of one out of the middle, and they are between cubes.
 * The box is strictly inside the brick. TM_ERROR_INPUT: a box without extent, or so far
 * from the origin that its size is lost in rounding. */
tm_status tm_brick_over(tm_brick *brick, const double low[3], const double high[3],
                        double size, tm_error *error);

/* The brick that an octree is on. */
tm_status tm_brick_of(tm_brick *brick, const tm_octree *octree, tm_error *error);

void tm_brick_free(tm_brick *brick);

#endif
