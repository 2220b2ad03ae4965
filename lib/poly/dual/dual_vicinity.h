/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What moving a point of a dual changes: the facets that have it, and the cells of these
 * with all their facets, which see them from other centroids then. */
#ifndef TM_POLY_DUAL_DUAL_VICINITY_H
#define TM_POLY_DUAL_DUAL_VICINITY_H

#include "dual_measure.h"

/* How bad a vicinity is: the worst of its facets, and the sum of all that is not good;
 * whether a cell is not convex. */
typedef struct tm_dual_score {
    double worst, sum;
    bool concave;
} tm_dual_score;

typedef struct tm_dual_vicinity {
    tm_dual *d;
    tm_dual_measures m;
    tm_block cells;  /* the facets of cells */
    size_t *start;   /* [points + 1]: the facets of a point are */
    uint32_t *facet; /* facet[start[p] … start[p + 1]) */
    uint32_t *facet_stamp, *cell_stamp, stamp;
    /* of a point */
    uint32_t *near; /* the facets that have it, `own` of them, then those of its cells */
    size_t own, nears, near_room;
    uint32_t *watch; /* those that may become bad */
    size_t watched, watch_room;
    uint32_t *cell;
    size_t cell_count, cell_room;
    tm_dual_face *was_face; /* before it was moved */
    tm_dual_centre *was_centre;
    size_t face_room, centre_room;
} tm_dual_vicinity;

/* Measures all facets and cells. *v is to be freed, after an error too. O(n). */
tm_status tm_dual_vicinity_make(tm_dual_vicinity *v, tm_dual *d, tm_error *error);
void tm_dual_vicinity_free(tm_dual_vicinity *v);

/* Goes to a point; false where memory is out. */
bool tm_dual_vicinity_find(tm_dual_vicinity *v, uint32_t p);

/* Judges it. Facets that are good by far, and do not have the point, are not looked at
 * again while the point is moved. */
tm_dual_score tm_dual_vicinity_judge(tm_dual_vicinity *v);

/* Moves the point there if that is better than *now, which is what it becomes. */
bool tm_dual_vicinity_move(tm_dual_vicinity *v, uint32_t p, const double to[3],
                           tm_dual_score *now);

#endif
