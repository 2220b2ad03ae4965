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

/* Drops the nodes that no triangle has; low and high. */
tm_status tm_surface_drop_nodes(tm_surface *surface, tm_error *error);

/* Whether the three points are on a line, exactly. */
bool tm_is_flat(const double a[3], const double b[3], const double c[3]);

/* Drops flat triangles where the edges that they have with others are closed without
 * them, and nodes that none has then; then across and open_edges. base is the number of
 * the first node and facet in messages. */
tm_status tm_surface_connect(tm_surface *surface, bool lenient, unsigned base,
                             tm_error *error);

/* shell, components; the triangles of a shell turn the same way. */
tm_status tm_surface_orient(tm_surface *surface, bool lenient, unsigned base,
                            tm_error *error);

/* Flips the longest edges of flat triangles; counts them in flat. */
tm_status tm_surface_mend(tm_surface *surface, tm_error *error);

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
