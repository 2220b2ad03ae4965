/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The link of a node: the triangles opposite it in the tetrahedra around it. */
#ifndef TM_POLY_DUAL_DUAL_LINK_H
#define TM_POLY_DUAL_DUAL_LINK_H

#include "dual_parts.h"

/* Seen from outside, the vertices turn counter-clockwise. Side j is opposite vertex j;
 * beyond[j] is the triangle there, or TM_NONE where the face between has to stay or is
 * cut. */
typedef struct tm_dual_link_triangle {
    uint32_t piece;
    uint32_t vertex[3];
    uint32_t beyond[3];
} tm_dual_link_triangle;

typedef struct tm_dual_link_vertex {
    uint32_t node;
    double to[3];     /* from the node of the link, of length 1 */
    bool border;      /* a side that is not passed is at it */
    bool constrained; /* one that has to stay */
} tm_dual_link_vertex;

typedef struct tm_dual_link {
    const double *centre;
    tm_dual_link_triangle *triangle;
    size_t triangles, triangle_room;
    tm_dual_link_vertex *vertex;
    size_t vertices, vertex_room;
} tm_dual_link;

/* Fills a link of the pieces of a node; false where memory is out. O(k log k). */
bool tm_dual_link_fill(tm_dual_link *link, const tm_dual *d, const uint32_t *piece,
                       size_t pieces);
void tm_dual_link_free(tm_dual_link *link);

/* The angle of a triangle's tetrahedron at the edge to its vertex i. */
double tm_dual_link_angle(const tm_dual_link *link, uint32_t triangle, int i);

/* Cuts side j of a triangle. */
void tm_dual_link_cut(tm_dual_link *link, tm_dual *d, uint32_t triangle, int j);

/* How a path comes to a vertex: through a side of a triangle, from another one. */
typedef struct tm_dual_way {
    double cost;         /* HUGE_VAL: not yet */
    uint32_t triangle;   /* TM_NONE: none yet, or a path begins there */
    int side;            /* of it */
    uint32_t from;       /* TM_NONE: the same */
    bool enters, leaves; /* whether paths may come to the vertex, and go on from it */
} tm_dual_way;

/* Begins with no paths: way[vertices] may be entered, and left but for the border. */
void tm_dual_ways_begin(tm_dual_way *way, const tm_dual_link *link);

/* What a vertex costs: how far it is from a plane, as a sine, and a little for the step.
 */
double tm_dual_way_cost(const tm_dual_link *link, const double normal[3],
                        uint32_t vertex);

/* dual_path.c. Reaches vertices from those that have a cost until no path is cheaper: the
 * vertices that it enters cost. O(triangles) for each step of the longest path. */
void tm_dual_ways_find(tm_dual_way *way, const tm_dual_link *link,
                       const double normal[3]);

/* Cuts the sides of the path to a vertex. */
void tm_dual_way_cut(const tm_dual_way *way, tm_dual_link *link, tm_dual *d,
                     uint32_t end);

/* Cuts regions of a link until each has sides that stay in one place of its border only,
 * if it can be; *any becomes true where one was cut. False where memory is out. O(k²) for
 * each. */
bool tm_dual_cut_apart(tm_dual *d, tm_dual_link *link, bool *any);

#endif
