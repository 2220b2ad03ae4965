/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shortest way along a curve over edges and diagonals of an interior boundary, where
 * an edge costs the length of curve that it runs along and more the farther it is from it
 * (E. W. Dijkstra, 1959). */
#ifndef TM_LAYER_FEATURE_SEARCH_H
#define TM_LAYER_FEATURE_SEARCH_H

#include "feature.h"
#include "boundary_cells.h"

/* A node as the search for one curve sees it. */
typedef struct tm_path_visit {
    uint32_t curve_round; /* param and distance2 are of this curve */
    uint32_t round;       /* cost and from are of this search */
    uint32_t from;
    bool done;
    double cost;
    double param;     /* length along the curve up to the closest place */
    double distance2; /* from it */
} tm_path_visit;

typedef struct tm_path_step {
    double cost;
    uint32_t node;
} tm_path_step;

/* Where the path of a curve begins, passes and ends: an interior boundary node, and the
 * length along the curve up to there. */
typedef struct tm_path_stop {
    uint32_t node;
    double param;
} tm_path_stop;

enum { TM_PATH_STOPS = 4 };

typedef struct tm_path_finder {
    const tm_surface *surface;
    const tm_boundary_cells *cells;
    tm_interior_boundary *boundary;
    tm_feature *feature;
    uint8_t *on_path; /* [faces]: bit i where the edge from corner i is on one */
    /* of the search that is under way */
    tm_path_visit *visit; /* [nodes] */
    uint32_t round;
    uint32_t curve; /* the one whose path is sought */
    double total;   /* its length */
    bool closed;    /* it comes back to where it begins */
    unsigned stops;
    tm_path_stop stop[TM_PATH_STOPS];
    size_t heap_count, heap_room;
    tm_path_step *heap;
    double *length; /* along the curve, up to each of its nodes */
    size_t length_room;
    uint32_t *path; /* the nodes of the curve's path */
    size_t path_count, path_room;
    uint32_t *cuts; /* the faces that it cuts */
    size_t cut_count, cut_room;
} tm_path_finder;

/* How far from the curve a path may go, and from where a closed one may start, in sides
 * of leaves. */
static const double tm_path_tube = 2;

/* Searches from one stop of the curve to the next; where *found, visit[].from leads back
 * from the second. O(n log n) in the nodes near the curve. TM_ERROR_SYSTEM where memory
 * is out. */
tm_status tm_path_search(tm_path_finder *p, const tm_path_stop *from,
                         const tm_path_stop *to, bool *found, tm_error *error);

#endif
