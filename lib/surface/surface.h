/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A closed triangle surface that bounds a solid: which points are inside, what of the
 * surface is closest, where it is sharp. */
#ifndef TM_SURFACE_SURFACE_H
#define TM_SURFACE_SURFACE_H

#include "../format/surface_file.h"

/* Sharp edges are chained to curves that end at corners: nodes where another number than
 * two sharp edges meet, or where two meet at a sharp angle. A closed curve without a
 * corner has its first node again as its last. A patch is a set of triangles connected
 * across edges that are not sharp. */
typedef struct tm_surface {
    size_t nodes;
    double (*xyz)[3];
    size_t triangles;
    uint32_t (*triangle)[3]; /* seen from outside they turn counter-clockwise */
    int32_t *marker;         /* [triangles], or NULL where the file has none */
    uint32_t (*across)[3];   /* the triangle beyond the edge from corner i to i + 1 */
    uint32_t *patch;         /* [triangles] */
    size_t patches;
    size_t curves;
    size_t *curve_start;  /* [curves + 1] */
    uint32_t *curve_node; /* nodes of curve c: curve_start[c] … curve_start[c + 1) */
    size_t corners;
    uint32_t *corner; /* nodes */
    double low[3], high[3];
    struct tm_surface_tree *tree; /* bounding boxes; see surface_tree.h */

    size_t welded;     /* nodes that had another at their place */
    size_t flat;       /* triangles without area that were dropped */
    size_t duplicates; /* triangles that were there twice, dropped */
    bool turned;       /* some or all triangles turned the other way */
    size_t components; /* connected pieces of surface: shells */
    int64_t euler;     /* nodes - edges + triangles, of all shells */
} tm_surface;

/* A place on the surface. */
typedef struct tm_surface_point {
    double xyz[3];
    double distance2;  /* squared distance to the point that was asked for */
    uint32_t triangle; /* on it, or on its border */
} tm_surface_point;

/* The place of the surface (of one patch; TM_NONE: any) closest to a point. Where
 * at->triangle is not TM_NONE it is a guess, and the search only looks for what is
 * closer. */
void tm_surface_closest(const tm_surface *surface, const double point[3], uint32_t patch,
                        tm_surface_point *at);

/* The place of a curve closest to a point; `segment` is the first of its two nodes,
 * counted from curve_start[curve]. */
void tm_surface_closest_on_curve(const tm_surface *surface, uint32_t curve,
                                 const double point[3], double closest[3],
                                 size_t *segment);

/* Whether a point is inside, against the whole surface. */
bool tm_surface_has_inside(const tm_surface *surface, const double point[3]);

/* Whether some of the surface is in the closed box. */
bool tm_surface_meets_box(const tm_surface *surface, const double low[3],
                          const double high[3]);

#endif
