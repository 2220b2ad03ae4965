/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Moves nodes of a mixed mesh so that its worst elements become better, and no other
 * elements bad: first of all it untangles. */
#ifndef TM_OPTIMISE_OPTIMISE_H
#define TM_OPTIMISE_OPTIMISE_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../base/progress.h"
#include "../base/stop.h"
#include "../mesh/mixed_mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef enum tm_node_freedom {
    TM_MOVES_NOT,
    TM_MOVES_FREELY,
    TM_MOVES_ON_SURFACE, /* slides on one patch of a surface, or on all of it */
    TM_MOVES_ON_CURVE,   /* slides along a curve of it */
    TM_MOVES_AT_CORNER   /* stays at a corner of it */
} tm_node_freedom;

/* What a node may do. One that is off the surface is not on its surface, curve or corner
 * yet: it is to be brought there. */
typedef struct tm_node_rule {
    uint32_t where; /* the patch, curve or corner; TM_NONE: any patch */
    uint8_t freedom;
    bool off_surface;
} tm_node_rule;

/* A point of the boundary, and its normal or, on a curve, its direction, of length 1. */
typedef struct tm_boundary_point {
    double xyz[3];
    double axis[3];
    uint32_t guess; /* where the next search may begin; TM_NONE: nowhere special */
} tm_boundary_point;

/* The boundary, as what is closest to a point. The functions read at->guess and fill *at;
 * the closest point of a point of it must be that one, up to rounding. Of a corner there
 * is one point, without an axis. */
typedef struct tm_boundary {
    const void *of;
    void (*on_surface)(const void *of, uint32_t patch, const double point[3],
                       tm_boundary_point *at);
    void (*on_curve)(const void *of, uint32_t curve, const double point[3],
                     tm_boundary_point *at);
    void (*at_corner)(const void *of, uint32_t corner, tm_boundary_point *at);
} tm_boundary;

/* An element is bad if its J_ENS is below its threshold. */
typedef struct tm_optimise_options {
    double threshold;             /* of all elements … */
    const double *thresholds;     /* … or of each, where this is not NULL */
    double off_surface_threshold; /* the same for elements near nodes that are brought to
                              the boundary, not above the others; 0: none is brought */
    double release_threshold;     /* nodes of elements that stay below it may leave their
                                     corner, curve and patch for other parts of the surface;
                                     0: none may */
    unsigned effort; /* how often what remains is tried again, from other positions; 1 is
                        usual, 0 half as slow where much remains */
    size_t most_measured; /* no more is begun once so many elements were measured in all;
                             0: no limit */
    const uint32_t *number; /* [elements]: theirs in the mesh that this one is of, by
                               which what is done at random is chosen; NULL: these here */
    unsigned pass;          /* only this one is made, counted from 1; 0: all */
    const tm_progress *progress;
    const tm_stop *stop;
} tm_optimise_options;

/* How many passes go over what is bad, and how many rings of elements around it a pass,
 * counted from 1, moves nodes of: bad elements that are farther from each other than such
 * rings of both have nothing to do with each other in it. */
unsigned tm_optimise_passes(unsigned effort);
unsigned tm_optimise_rings(unsigned pass);

typedef struct tm_optimise_report {
    size_t bad_before, bad_after;
    size_t inverted_before, inverted_after; /* J_ENS <= 0 */
    double worst_before, worst_after;       /* J_ENS; 1 of no elements */
    size_t off_surface_before, off_surface_after;
    size_t moved;       /* nodes */
    size_t released;    /* of these: that had to leave their corner, curve or patch */
    size_t clusters;    /* of bad elements that were worked on, each time counted */
    size_t evaluations; /* of the objective */
    size_t measured;    /* elements, in all of these */
} tm_optimise_report;

/* Raises J_ENS of bad elements by moving nodes up to three elements away from them, and
 * brings nodes that are off the surface to it.
 *
 * Bad elements that touch, and the nodes around them, are one problem: a sum over all
 * corners that grows exponentially with what is missing to the threshold (so the worst
 * decide, but jointly and smoothly), minimised by L-BFGS (D. C. Liu and J. Nocedal, 1989)
 * with nodes of the boundary sliding on it; where that leaves inverted elements, by what
 * is in optimise_untangle.c. A result is taken only if
 *   - no element of the cluster that was not bad is,
 *   - no more are bad, no more are inverted, and fewer of either or the worst is better,
 *   - the worst has not become worse, unless some were inverted;
 * else the nodes are where they were. So no mesh becomes worse, but for elements that
 * fall below their threshold, not below off_surface_threshold, for a node that was off
 * the surface.
 *
 * Before: rules [nodes] with nodes that are not off the surface on it; element
 * nodes in range; `boundary` may be NULL where no rule needs it, and its functions that
 * none needs. After: nodes of the boundary that moved are where `boundary` says that the
 * closest point is; rule[v].off_surface is false of those that were brought there; nodes
 * that were released have the rule TM_MOVES_ON_SURFACE, TM_NONE. Deterministic.
 * TM_ERROR_SYSTEM where memory is out: the mesh is then as good as it has become.
 * O(elements), in little more than the time of tm_jens() for each; some ten milliseconds
 * for a cluster that cannot be mended, a tenth of that for others. */
tm_status tm_mixed_optimise(tm_mixed_mesh *mesh, tm_node_rule *rule,
                            const tm_boundary *boundary,
                            const tm_optimise_options *options,
                            tm_optimise_report *report, tm_error *error);

TM_EXTERN_C_END

#endif
