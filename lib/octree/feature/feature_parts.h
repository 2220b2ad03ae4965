/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of tm_feature_find(), a file each: curves are chosen, shortest paths searched
 * along them, what paths enclose gets its patch, and what they would flatten is cut. */
#ifndef TM_LAYER_FEATURE_PARTS_H
#define TM_LAYER_FEATURE_PARTS_H

#include "boundary_cells.h"
#include "feature.h"
#include "../interior/region_sets.h"

/* feature_select.c: which curves of a surface are worth a path. On a rough surface sharp
 * edges come singly and in small groups that are not edges of the shape. */

/* What becomes of a curve or a corner. */
typedef struct tm_feature_choice {
    bool *curve;         /* [curves]: it gets a path */
    bool *corner;        /* [corners]: it gets a node */
    uint32_t *corner_of; /* [nodes of the surface]: the corner there, or TM_NONE */
} tm_feature_choice;

/* Leaves out, of those where no walls meet, curves that hang together with none of the
 * others over more than a few sides of a leaf (or half of the surface), then, again and
 * again, curves of less than two sides that end freely; and the corners that have lost
 * all their curves. Corners without curves, the tips of cones, stay. size[c] is the side
 * of the leaves near curve c. TM_ERROR_SYSTEM where memory is out. *choice is to be
 * freed, after an error too. O(n). */
tm_status tm_feature_choose(tm_feature_choice *choice, const tm_surface *surface,
                            const double *size, tm_error *error);
void tm_feature_choice_free(tm_feature_choice *choice);

/* feature_search.c: the shortest way along a curve over edges and diagonals of an
 * interior boundary, where an edge costs the length of curve that it runs along and more
 * the farther it is from it (E. W. Dijkstra, 1959). */

/* A node as the search for one curve sees it. */
typedef struct tm_path_visit {
    uint32_t curve_round; /* param and distance2 are of this curve */
    uint32_t round;       /* cost and from are of this search */
    uint32_t from;
    bool done;
    double cost;
    double param;     /* length along the curve up to the closest point */
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
    const tm_region_sets *sets; /* NULL where no walls meet */
    tm_feature *feature;
    uint8_t *on_path; /* [faces]: bit i where the edge from corner i is on one */
    /* of the search that is under way */
    tm_path_visit *visit; /* [nodes] */
    uint32_t round;
    uint32_t curve; /* the one whose path is sought */
    double tube;    /* tm_path_tube or tm_path_wide_tube */
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
 * of leaves; and the same where none is found so. Beside leaves that are twice as large
 * the boundary is farther from the surface. */
static const double tm_path_tube = 2, tm_path_wide_tube = 4;

/* Searches from one stop of the curve to the next; where *found, visit[].from leads back
 * from the second. O(n log n) in the nodes near the curve. TM_ERROR_SYSTEM where memory
 * is out. */
tm_status tm_path_search(tm_path_finder *p, const tm_path_stop *from,
                         const tm_path_stop *to, bool *found, tm_error *error);

/* feature_path.c: the path of one curve, by such ways from stop to stop. */

/* Finds the path of a curve between the interior boundary nodes of its two ends and
 * enters it into feature, boundary->cut and on_path; *found says whether there is one.
 * Where the ends are the same, or TM_NONE, the path goes around. TM_ERROR_SYSTEM where
 * memory is out. */
tm_status tm_path_along_curve(tm_path_finder *finder, uint32_t curve, uint32_t from,
                              uint32_t to, bool *found, tm_error *error);

/* feature_region.c: the parts into which paths divide an interior boundary. */

/* Sets feature->of for the nodes that are on no path: the patch of most of the nodes of
 * their region, by the closest triangles; TM_NONE where there is no clear majority.
 * on_path[f] has bit i set where the edge from corner i of face f is on a path; the
 * diagonals along which faces are cut are on paths too. O(n). */
tm_status tm_feature_regions(tm_feature *feature, const tm_interior_boundary *boundary,
                             const tm_surface *surface, const uint8_t *on_path,
                             const tm_surface_point *at, tm_error *error);

/* feature_cut.c: faces that paths would flatten. */

/* Cuts the quadrilaterals that have two edges on paths which meet at a wide angle, from
 * the node where they do, so that each half has half of the angle. on_path and at as for
 * tm_feature_regions(), which must be done before: these diagonals are on no path.
 * O(faces).
 */
void tm_feature_cut_wide(const tm_feature *feature, tm_interior_boundary *boundary,
                         const tm_surface *surface, const uint8_t *on_path,
                         const tm_surface_point *at);

#endif
