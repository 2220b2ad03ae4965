/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of tm_surface_build(), in their order. Each fills what it names of a surface
 * that the steps before have filled. */
#ifndef TM_SURFACE_SURFACE_PARTS_H
#define TM_SURFACE_SURFACE_PARTS_H

#include "surface.h"

/* Nodes, triangles with marker and facet, welded, duplicates, low and high. Flat are
 * those with a node twice. */
tm_status tm_surface_triangulate(tm_surface *surface, const tm_polygon_surface *polygons,
                                 tm_error *error);

/* Marks in gone[facets] those of one polygon, of so many nodes or more, that have the
 * nodes of an earlier one; unique[n] is the first node where node n is. False where
 * memory is out. */
bool tm_surface_find_duplicates(const tm_polygon_surface *surface, const uint32_t *unique,
                                size_t least, bool *gone, size_t *count);

/* Drops the nodes that no triangle has; low and high. */
tm_status tm_surface_drop_nodes(tm_surface *surface, tm_error *error);

/* Whether the three points are on a line, exactly. */
bool tm_is_flat(const double a[3], const double b[3], const double c[3]);

/* Whether two triangles are in one plane, exactly. */
bool tm_surface_is_level(const tm_surface *surface, uint32_t s, uint32_t t);

/* For messages, where such triangles overlap. */
extern const char tm_surface_overlap_help[];

/* A half edge, 3 t + i, and its angle about the edge. */
typedef struct tm_around {
    double angle;
    uint32_t half;
} tm_around;

/* At most so many triangles at an edge. */
enum { TM_WEDGES_MOST = 64 };

/* Sorts the half edges of one edge by their angles about it, which grow in the direction
 * of the normals of triangles that go from low to high. */
void tm_surface_sort_around(const tm_surface *surface, uint32_t low, uint32_t high,
                            tm_around *at, size_t count);

/* Drops flat triangles where the edges that they have with others are closed without
 * them, and nodes that none has then; then across and open_edges, or walls. base is the
 * number of the first node and facet in messages. */
tm_status tm_surface_connect(tm_surface *surface, bool lenient, bool walls, unsigned base,
                             tm_error *error);

/* shell, components; the triangles of a shell turn the same way. */
tm_status tm_surface_orient(tm_surface *surface, bool lenient, unsigned base,
                            tm_error *error);

/* Flips the longest edges of flat triangles; counts them in flat. */
tm_status tm_surface_mend(tm_surface *surface, tm_error *error);

/* Turns t, and what is across its edges with it. */
void tm_surface_turn_triangle(tm_surface *surface, uint32_t t);

/* crossings, by the tree. */
tm_status tm_surface_find_crossings(tm_surface *surface, bool lenient, unsigned base,
                                    tm_error *error);

/* Turns the shells that have to be, by the tree; turned. */
tm_status tm_surface_turn(tm_surface *surface, tm_error *error);

/* Curves, corners and patches; rough, rough_edges. Sharp edges that end freely and are
 * shorter than least_length in all are none, nor are networks of which many do. */
tm_status tm_surface_find_features(tm_surface *surface, double feature_angle,
                                   bool unless_rough, double least_length,
                                   tm_error *error);

/* regions, region, repeated_regions, holes and hole, by the tree. */
tm_status tm_surface_find_regions(tm_surface *surface, const tm_polygon_surface *polygons,
                                  tm_error *error);

/* The same where walls meet: side, regions, region, repeated_regions; shell, components
 * and euler once more. Turns the triangles as side says. base as above. */
tm_status tm_surface_find_walls(tm_surface *surface, const tm_polygon_surface *polygons,
                                tm_error *error);

/* The region that a point is in, from 0; TM_NONE: outside. */
typedef uint32_t tm_region_finder(const tm_surface *surface, const double point[3],
                                  const void *context);

/* region[regions], repeated_regions: the numbers of the file; regions that have none get
 * the next whole ones, from 1. TM_ERROR_INPUT where the file has one outside. */
tm_status tm_surface_number_regions(tm_surface *surface,
                                    const tm_polygon_surface *polygons, size_t regions,
                                    tm_region_finder *at, const void *context,
                                    tm_error *error);

/* Whether t turns as the triangle of the file that it is from; true where it has been
 * flipped, as that had no area. */
bool tm_surface_is_as_given(const tm_surface *surface, const tm_polygon_surface *polygons,
                            size_t t);

/* The unit normal of t; false where it is so thin that it has none of its own. */
bool tm_surface_own_normal(const tm_surface *surface, uint32_t t, double normal[3]);

/* The corner i of t for which across[t][i] is n; 3: none. */
static inline unsigned tm_surface_side(const tm_surface *surface, uint32_t t, uint32_t n)
{
    unsigned i = 0;
    while (i < 3 && surface->across[t][i] != n)
        i++;
    return i;
}

#endif
