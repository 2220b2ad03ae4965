/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest ball in an intersection of half-spaces: for those inside of the faces of a
 * polyhedron this is the kernel, the points that see all of it, and the polyhedron is
 * star-shaped with respect to a ball if one fits. A linear programme in four variables,
 * the centre and the radius r: the largest r with n·x + r ≤ d for all half-spaces.
 *
 * Solved from outside by the dual simplex method (C. E. Lemke, The dual method of
 * solving the linear programming problem, Naval Research Logistics Quarterly 1, 1954)
 * with four planes at a time, as programmes of few variables are (R. Seidel,
 * Small-dimensional linear programming and convex hulls made easy, Discrete &
 * Computational Geometry 6, 1991, is the randomised way): the largest ball between four
 * planes is known, the plane that cuts it deepest takes the place of one of the four. It
 * starts from a huge tetrahedron. The goal leans a little (LEAN in kernel.c), so that
 * no two corners of the programme are equally good. Each round looks at every plane
 * once; a dozen are usual.
 *
 * But for the volume no memory is allocated, nothing is random, threads may call all of
 * it. A half-space is plane[i] = {n, d}, n of length 1 pointing outward: n·x ≤ d is
 * inside. Any unit of length will do, but d is rounded relative to the distance from the
 * origin: take a corner of the polyhedron as the origin where that matters. */
#ifndef TM_GEOM_KERNEL_H
#define TM_GEOM_KERNEL_H

#include <stdbool.h>
#include <stddef.h>

/* Writes the centre and the radius of the largest ball. *radius is how deep the centre is
 * inside all half-spaces, the least d - n·x: it is right for that centre but for one
 * rounding, and the largest one to about 1e-12 of the size. It is 0 or negative, the
 * distance by which all planes had to move outward, where the intersection has no
 * interior. Of several centres it is any one at the end of their range. False, with
 * *radius 0, where the planes do not bound the ball and its centre (fewer than four never
 * do) or are not finite. O(count) for each of a few rounds: about 1 µs for 50 planes. */
bool tm_kernel_ball(const double (*plane)[4], size_t count, double center[3],
                    double *radius);

/* The same, but false, and sooner, where it is known to be less than `least`. */
bool tm_kernel_ball_of(const double (*plane)[4], size_t count, double least,
                       double center[3], double *radius);

/* Memory that is kept from one call to the next. {0} is empty. */
typedef struct tm_kernel_memory {
    struct tm_kernel_plane *plane;
    size_t planes;
    double (*polygon)[2];
    size_t points;
} tm_kernel_memory;

void tm_kernel_memory_free(tm_kernel_memory *memory);

/* Writes the volume of what is inside all the half-spaces plane[i] = {n, d}, n·x ≤ d,
 * and in a ball of radius `reach`, which must hold it, around an inner point: that of
 * tm_kernel_ball(), or any other of a depth above 0. Planes may be there twice or nearly
 * so. Each face is a square on its plane that the others cut, nearest first, until they
 * are out of its reach; pyramids over the faces add up. Returns NULL where memory is out,
 * else memory->plane. O(count²) at worst, where no plane is out of reach, as around a
 * sphere: 40 µs for 50 planes, 0.4 s for 10 000. */
void *tm_kernel_volume(tm_kernel_memory *memory, const double (*plane)[4], size_t count,
                       const double inner[3], double reach, double *volume);

#endif
