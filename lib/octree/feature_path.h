/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paths of skin edges and diagonals along the curves of a surface: the shortest ones,
 * where an edge costs the length of curve that it runs along and more the farther it is
 * from it (Dijkstra 1959). */
#ifndef TM_OCTREE_FEATURE_PATH_H
#define TM_OCTREE_FEATURE_PATH_H

#include "feature.h"
#include "skin_cells.h"

/* Where the path of a curve begins, passes and ends: a skin node, and the length along
 * the curve up to there. */
typedef struct tm_path_stop {
    uint32_t node;
    double param;
} tm_path_stop;

enum { TM_PATH_STOPS = 4 };

typedef struct tm_path_finder {
    const tm_octree *octree;
    const tm_surface *surface;
    const tm_skin_cells *cells;
    tm_skin *skin;
    tm_feature *feature;
    const double *size; /* [nodes of the skin]: side of the smallest leaf there */
    uint8_t *on_path;   /* [faces]: bit i where the edge from corner i is on one */
    /* of the search that is under way */
    struct tm_path_visit *visit; /* [nodes] */
    uint32_t round;
    uint32_t curve; /* the one whose path is sought */
    double total;   /* its length */
    bool closed;    /* it comes back to where it begins */
    unsigned stops;
    tm_path_stop stop[TM_PATH_STOPS];
    size_t heap_count, heap_room;
    struct tm_path_step *heap;
    double *length; /* along the curve, up to each of its nodes */
    size_t length_room;
    uint32_t *path; /* the nodes of the curve's path */
    size_t path_count, path_room;
    uint32_t *cuts; /* the faces that it cuts */
    size_t cut_count, cut_room;
} tm_path_finder;

/* Room for tm_path_finder.visit; NULL where memory is out. */
struct tm_path_visit *tm_path_visits(size_t nodes);

/* Finds the path of a curve between the skin nodes of its two ends and enters it into
 * feature, skin->cut and on_path; *found says whether there is one. Where the ends are
 * the same, or TM_NONE, the path goes around. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_path_along_curve(tm_path_finder *finder, uint32_t curve, uint32_t from,
                              uint32_t to, bool *found, tm_error *error);

#endif
