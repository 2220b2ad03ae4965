/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sharp edges that are no features of a shape, but end freely in a patch, or are
 * roughness. */
#ifndef TM_SURFACE_SURFACE_LOOSE_H
#define TM_SURFACE_SURFACE_LOOSE_H

#include "surface.h"

typedef struct tm_sharp_edge {
    uint32_t node[2]; /* ascending */
    uint32_t triangle[2];
} tm_sharp_edge;

/* The sharp edges of a surface; those at node v are at[start[v] … start[v + 1]). */
typedef struct tm_sharp_network {
    const tm_surface *surface;
    size_t edges;
    const tm_sharp_edge *edge;
    const size_t *start;
    const uint32_t *at;
} tm_sharp_network;

/* Sets dropped[edges], which is false before, for chains that end freely and are shorter
 * than `least`, for what is connected where many do, and for all where many of all do:
 * then *rough too. Not for edges with one triangle. O(n). */
tm_status tm_surface_find_loose(const tm_sharp_network *network, double least,
                                bool *dropped, bool *rough, tm_error *error);

/* Sets rough[nodes], which is false before, where sharp edges are none. On what is made,
 * sharp edges follow each other; a body (what is connected by triangles) of which more
 * than one in ten ends freely is rough. So are its nodes, but those of connected sharp
 * edges that are many and have few free ends among them and close by, own ones or others:
 * less than one for each thirty. Needs of the surface nodes and triangles; edges are
 * those that are sharp by their angle, and open ones. *rough_edges is how many are at
 * rough nodes: both ends of an edge are alike. TM_ERROR_SYSTEM where memory is out. O(n).
 */
tm_status tm_surface_find_rough(const tm_surface *surface, const tm_sharp_edge *edge,
                                size_t edges, bool *rough, size_t *rough_edges,
                                tm_error *error);

#endif
