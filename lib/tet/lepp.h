/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improvement along longest-edge propagation paths (LEPP): F. Balboa, Mejoramiento de
 * mallas de tetraedros mediante algoritmos Lepp, Universidad de Chile (2020).
 *
 * From a bad tetrahedron, Lepp-Simple steps to a tetrahedron around the current longest
 * edge whose own longest edge is longer, until the edge is the longest of all around it:
 * a terminal edge, whose star is then changed. Edges are compared by (squared length,
 * smaller node, larger node), so that of two edges one is always the longer. */
#ifndef TM_TET_LEPP_H
#define TM_TET_LEPP_H

#include "../quality/tet_measure.h"
#include "mesh.h"

/* What is done with a terminal star. All but the last change every one. */
typedef enum tm_lepp_algorithm {
    TM_LEPP_BISECTION,     /* section 2.7.1: insert the midpoint of the edge */
    TM_LEPP_CENTROID,      /* 2.7.2: insert the mean of the star's nodes */
    TM_LEPP_WCENTROID,     /* 2.7.2: insert the mean of its tetrahedra's centroids */
    TM_LEPP_SWAP_CENTROID, /* 6.1: that of the nodes, or remove the edge, if better */
    TM_LEPP_SELECTIVE      /* 6.2: the same, where it makes the star better by a factor */
} tm_lepp_algorithm;

/* When to stop, by the set S of bad tetrahedra (section 6.2.8). */
typedef enum tm_lepp_stop {
    TM_LEPP_ORIGINAL, /* S as it is in the input, once */
    TM_LEPP_PASSES,   /* so many times, S found anew each time */
    TM_LEPP_CONVERGED /* new bad ones join S, until no longest edge in S is refinable */
} tm_lepp_stop;

typedef struct tm_lepp_options {
    tm_lepp_algorithm algorithm;
    double factor; /* m >= 1 of selective: how much better a star must become */
    double angle;  /* degrees; bad: a dihedral angle below it, or above 180 - it */
    tm_tet_measure measure; /* by which stars are compared */
    tm_lepp_stop stop;
    size_t passes;   /* for TM_LEPP_PASSES */
    size_t max_star; /* stars of more tetrahedra are left alone; 0: none is */
} tm_lepp_options;

/* selective asks for this relative gain at least: with a factor of 1 and rounded
 * qualities an operation and its inverse could both seem to gain, for ever. */
#define TM_LEPP_GAIN 1e-5

/* Counts by star size or by stars visited; the last one is for all that is larger. */
enum { TM_LEPP_SIZES = 33, TM_LEPP_VISITS = 65 };

typedef struct tm_lepp_report {
    size_t tets_before, bad_before, bad_after; /* tetrahedra */
    size_t passes;
    size_t targets;        /* bad tetrahedra that a path was started from */
    size_t swaps;          /* edges removed */
    size_t centroids;      /* inserted in closed stars */
    size_t midpoints;      /* inserted in closed stars whose centroid was not valid */
    size_t open_midpoints; /* inserted on the boundary, or on what must stay inside */
    size_t closed, open;   /* terminal stars looked at */
    size_t refused_closed, refused_open;
    size_t outside,
        tangled;         /* centroids outside of their star, or not seeing all of it */
    size_t locked;       /* stars where the mesh is not manifold, or flat twice */
    size_t above_max;    /* stars left alone because of max_star */
    size_t too_large;    /* closed stars too large for an edge removal */
    size_t most_visited; /* stars for one target */
    size_t closed_size[TM_LEPP_SIZES], open_size[TM_LEPP_SIZES];
    size_t swap_size[TM_LEPP_SIZES], insertion_size[TM_LEPP_SIZES];
    size_t visited[TM_LEPP_VISITS]; /* targets by terminal stars visited */
} tm_lepp_report;

/* Improves the mesh. Every operation is exactly valid: boundary, regions, markers and
 * volume (but for the rounding of inserted points) stay. After an error the mesh is
 * still valid, improved as far as it got. Deterministic. */
tm_status tm_lepp_improve(tm_tet_mesh *mesh, const tm_lepp_options *options,
                          tm_lepp_report *report, tm_error *error);

/* How many operations changed the mesh. */
static inline size_t tm_lepp_operations(const tm_lepp_report *report)
{
    return report->swaps + report->centroids + report->midpoints + report->open_midpoints;
}

#endif
