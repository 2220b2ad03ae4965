/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where walls meet: which regions come together at nodes and edges of the interior
 * boundary, and at corners and curves of the surface. What stands for a curve has the
 * same ones: so the edges of the boundary at which three regions meet are the paths of
 * the curves at which these do, and no other path takes them. */
#ifndef TM_INTERIOR_REGION_SETS_H
#define TM_INTERIOR_REGION_SETS_H

#include "interior_boundary.h"

/* A set of regions is the sum, without carry, of numbers that stand for its members; two
 * sets have the same once in 2^64 times. */
typedef struct tm_region_sets {
    uint64_t *node;   /* [nodes of the boundary] */
    uint64_t *curve;  /* [curves] */
    uint64_t *corner; /* [corners] */
} tm_region_sets;

/* What stands for a region: the finaliser of SplitMix64 (G. L. Steele, D. Lea, C. H.
 * Flood, 2014). */
static inline uint64_t tm_region_number(uint32_t region)
{
    uint64_t z = (region + UINT64_C(1)) * UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* The sets that come together in a surface with walls, in whatever place: at triangles,
 * at edges where walls meet, and at nodes. */
typedef struct tm_walls {
    size_t count;
    uint64_t *set; /* ascending */
} tm_walls;

/* Finds them; they are to be freed, after an error too. TM_ERROR_SYSTEM where memory is
 * out. O(n log n). */
tm_status tm_walls_find(tm_walls *walls, const tm_surface *surface, tm_error *error);
void tm_walls_free(tm_walls *walls);
bool tm_walls_have(const tm_walls *walls, uint64_t set);

/* Finds them for a surface with walls, and a boundary that knows its regions. They are to
 * be freed, after an error too. TM_ERROR_SYSTEM where memory is out. O(n log n). */
tm_status tm_region_sets_find(tm_region_sets *sets, const tm_interior_boundary *boundary,
                              const tm_surface *surface, tm_error *error);
void tm_region_sets_free(tm_region_sets *sets);

/* The regions at the edge between two nodes of the boundary, or in the face that it is a
 * diagonal of. */
uint64_t tm_region_set_between(const tm_interior_boundary *boundary, uint32_t s,
                               uint32_t t);

/* The two regions beside a triangle. */
uint64_t tm_region_set_of_triangle(const tm_surface *surface, size_t t);

/* Whether a curve is where walls meet. */
static inline bool tm_curve_is_of_walls(const tm_surface *surface, size_t curve)
{
    return surface->walls && surface->curve_patch[curve][1] == TM_NONE;
}

#endif
