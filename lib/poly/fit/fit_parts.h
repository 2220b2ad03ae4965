/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of tm_polyhedra_fit(): fit_judge.c judges facets and cells, fit_around.c what
 * a node moves, fit.c moves nodes. */
#ifndef TM_POLY_FIT_PARTS_H
#define TM_POLY_FIT_PARTS_H

#include "../../examine/poly/poly_all_geometry.h"
#include "fit.h"

#include <stdint.h>

/* How bad a measure is: 0 and less where it is good, 1 where checkMesh complains. From
 * here on it is to be mended. */
#define TM_FIT_BAD 0.9

/* The sum over all measures of something. */
typedef struct tm_fit_sum {
    size_t count[TM_FIT_FAULTS];
    size_t bad;     /* measures from TM_FIT_BAD on */
    double missing; /* what all are short of being good */
} tm_fit_sum;

/* Of a facet. */
typedef struct tm_fit_verdict {
    uint32_t faults; /* a bit each */
    float worst;     /* of its measures */
    double missing;
} tm_fit_verdict;

/* Of the ordered pairs of facets of a cell: how far the centroid of one is beyond the
 * plane of the other. */
typedef struct tm_fit_pairs {
    uint32_t concave, bad;
    double missing;
} tm_fit_pairs;

/* Sums over the facets of a cell, from which follow its centroid and determinant. For
 * each facet with the area a outward and the centroid q, seen from `base`: */
typedef struct tm_fit_cell {
    double base[3];
    double mean[3];      /* q */
    double volume;       /* a·q */
    double moment[3];    /* (a·q) q */
    double cross[3][3];  /* q aᵀ */
    double spread[3][3]; /* a aᵀ, of those inside */
    double area;         /* |a|, of those inside */
    size_t inside;
    tm_fit_pairs pairs;
} tm_fit_cell;

/* Judges a facet from the centroids in m, or only until so much is missing. O(corners),
 * O(corners²) where it is no fan. */
tm_fit_verdict tm_fit_judge_facet(const tm_poly_centroids *m, size_t f, double enough);

/* Adds a facet of cell c to its sums. */
void tm_fit_cell_add(tm_fit_cell *sums, const tm_poly_centroids *m, size_t f, size_t c);

/* Writes the centroid and the volume of cell c, as tm_cell_centroid_find() would. */
void tm_fit_cell_finish(const tm_fit_cell *sums, const tm_poly_centroids *m, size_t c);

/* Adds the pairs (f, g) and (g, f) of cell c. */
void tm_fit_add_pairs(tm_fit_pairs *pairs, const tm_poly_centroids *m, size_t f, size_t g,
                      size_t c);

/* Add verdicts to a sum. */
void tm_fit_add_facet(tm_fit_sum *sum, const tm_fit_verdict *verdict);
void tm_fit_add_cell(tm_fit_sum *sum, const tm_fit_cell *cell);

/* What changes where a node moves: of its facets, its cells, and what is watched. */
typedef struct tm_fit_state {
    double at[3];
    tm_facet_centroid *facet;
    tm_cell_centroid *cell;
    tm_fit_cell *sums;
    tm_fit_verdict *verdict;
    size_t facet_room, cell_room, sums_room, verdict_room;
} tm_fit_state;

/* All that is known of a mesh, and what moves with a node. */
typedef struct tm_fit_around {
    tm_poly_centroids m;
    bool convex;
    double (*xyz)[3];
    size_t *start; /* [nodes + 1]: the facets of node v are */
    uint32_t *facet;
    tm_fit_verdict *verdict; /* [facets] */
    tm_fit_cell *sums;       /* [cells] */
    uint32_t *facet_stamp, *cell_stamp, stamp;
    /* Around a node: its own facets, then those of their cells that may become bad, from
     * `watched` on all others of them; and what they would be. */
    uint32_t *near;
    size_t own, watched, nears, near_room;
    tm_fit_verdict *fresh;
    uint32_t *cell;
    size_t cells, cell_room;
    tm_fit_cell *rest; /* [cells]: without the node's facets, if something is bad */
    size_t fresh_room, rest_room;
    tm_fit_state first, last; /* where the node was found, and before the last move */
    size_t work;              /* see tm_fit_report */
    tm_fit_sum before, now;   /* of the node's facets, its cells, and what is watched */
} tm_fit_around;

/* Judges all facets and cells. *a is to be freed, after an error too. O(corners), and
 * O(facets²) for a cell if convex. */
tm_status tm_fit_around_make(tm_fit_around *a, const tm_poly_arrays *mesh,
                             double (*xyz)[3], bool convex, tm_error *error);
void tm_fit_around_free(tm_fit_around *a);

/* The sum of all verdicts. O(facets + cells). */
tm_fit_sum tm_fit_sum_up(const tm_fit_around *a);

/* Goes to a node; false where memory is out. O(facets of its cells), O(own * facets) if
 * convex. */
bool tm_fit_around_find(tm_fit_around *a, uint32_t v);

/* Moves the node if no fault around it becomes more and less is missing, as far as facets
 * are watched. O(own), O(own * facets) if convex. */
bool tm_fit_around_move(tm_fit_around *a, uint32_t v, const double to[3]);

/* Looks at the facets that are not watched, too, which were good by far; if not all is
 * better than where the node was found, it goes back there. Whether it has moved.
 * O(facets of its cells). */
bool tm_fit_around_settle(tm_fit_around *a, uint32_t v);

#endif
