/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improvement along longest-edge propagation paths (LEPP): F. Balboa, Mejoramiento de
 * mallas de tetraedros mediante algoritmos Lepp, Universidad de Chile (2020).
 *
 * From a bad tetrahedron, Lepp-Simple steps to a tetrahedron around the current longest
 * edge whose own longest edge is longer, until the edge is the longest of all around it:
 * a terminal edge, whose star is then changed. Edges are compared by (squared length,
 * smaller node, larger node), so that of two edges one is always the longer. */
#ifndef TM_LEPP_LEPP_H
#define TM_LEPP_LEPP_H

#include "../../base/extern_c.h"
#include "../../text/json.h"
#include "../../base/progress.h"
#include "../../element/tet_measure.h"
#include "../delaunay/delaunay.h"
#include "../mesh.h"

TM_EXTERN_C_BEGIN

/* What is done with a terminal star. All but the last change every one. */
typedef enum tm_lepp_algorithm {
    TM_LEPP_BISECTION,     /* section 2.7.1: insert the midpoint of the edge */
    TM_LEPP_CENTROID,      /* 2.7.2: insert the mean of the star's nodes */
    TM_LEPP_WCENTROID,     /* 2.7.2: insert the mean of its tetrahedra's centroids */
    TM_LEPP_DELAUNAY,      /* 2.8: insert the midpoint, by tm_delaunay_insert() */
    TM_LEPP_SWAP_CENTROID, /* 6.1: that of the nodes, or remove the edge, if better */
    TM_LEPP_SELECTIVE      /* 6.2: the same, where it makes the star better by a factor */
} tm_lepp_algorithm;

/* Which terminal stars are looked at for a target. */
typedef enum tm_lepp_path {
    TM_LEPP_SIMPLE, /* 2.4.2, Lepp-Simple: that at the end of one path */
    TM_LEPP_FULL,   /* 2.4.1, Lepp3D: those at the ends of all branches */
    TM_LEPP_FIXED   /* those of all edges of one path as it is at first, from its end */
} tm_lepp_path;

/* Sweeps over the whole mesh before each pass of selective (7.4, algorithm 7.1), in this
 * order. */
enum {
    TM_SWEEP_SMOOTH = 1, /* smart Laplacian smoothing (7.4.1, 3.4) */
    TM_SWEEP_SWAP = 2    /* 2-3 swaps of faces, 2-2 swaps in flat facets (7.4.2, 3.3) */
};

/* How large tetrahedra may be: no edge longer than this, or than a field of sizes says at
 * any place in the tetrahedron. Longer by 1e-9 of it is not longer. */
typedef struct tm_lepp_sizes {
    double longest;   /* 0: any length */
    size_t attribute; /* of nodes, from 1: the field, greater than 0; 0: there is none */
} tm_lepp_sizes;

/* When to stop, by the set S of bad tetrahedra (section 6.2.8). Where the mesh has a set
 * (mesh_set.h) that is S in their place, and what comes of it joins S, with selective
 * if it is bad. */
typedef enum tm_lepp_stop {
    TM_LEPP_ORIGINAL, /* S as it is in the input, once */
    TM_LEPP_PASSES,   /* so many times, S found anew each time */
    TM_LEPP_CONVERGED /* new bad ones join S, until no longest edge in S is refinable: for
                         selective; swap-centroid need not come to an end */
} tm_lepp_stop;

typedef struct tm_lepp_options {
    tm_lepp_algorithm algorithm;
    double factor; /* m >= 1 of selective: how much better a star must become */
    double angle;  /* degrees; bad: a dihedral angle below it, or above 180 - it */
    tm_tet_measure measure; /* by which stars are compared */
    tm_lepp_stop stop;
    size_t passes;     /* for TM_LEPP_PASSES */
    size_t max_star;   /* stars of more tetrahedra are left alone; 0: none is */
    double max_growth; /* tetrahedra at most, by those of the input; 0: any number */
    tm_lepp_path path;
    unsigned sweeps;     /* TM_SWEEP_…; 0: none. A pass is over S as it is then */
    tm_lepp_sizes sizes; /* S is what of it is larger, until nothing is. For what always
                            inserts: not swap-centroid, not selective */
    bool count_invalid_swaps; /* costs some time */
    const tm_progress *progress;
} tm_lepp_options;

/* selective asks for this relative gain at least: with a factor of 1 and rounded
 * qualities an operation and its inverse could both seem to gain, for ever. */
#define TM_LEPP_GAIN 1e-5

/* Counts by star size, by stars visited, by sweeps; the last one is for all that is
 * larger. */
enum { TM_LEPP_SIZES = 33, TM_LEPP_VISITS = 65, TM_LEPP_SWEEPS = 33 };

/* What the sweeps came to; done[0] is of the first one. */
typedef struct tm_lepp_sweep_report {
    size_t sweeps;
    size_t tried; /* nodes that may move; faces inside, and edges of two boundary faces */
    size_t invalid; /* of these: a tetrahedron would not be positive */
    size_t done[TM_LEPP_SWEEPS];
    size_t on_surface; /* of those done: nodes on the surface; 2-2 swaps */
} tm_lepp_sweep_report;

typedef struct tm_lepp_report {
    size_t tets_before, bad_before, bad_after; /* tetrahedra */
    size_t larger_before, larger_after;        /* than the sizes say, of the mesh's set */
    size_t passes;
    size_t targets;        /* bad tetrahedra that a path was started from */
    size_t swaps;          /* edges removed */
    size_t centroids;      /* inserted in closed stars */
    size_t midpoints;      /* inserted in closed stars whose centroid was not valid */
    size_t open_midpoints; /* inserted on the boundary, or on what must stay inside */
    size_t closed, open;   /* terminal stars looked at */
    size_t refused_closed, refused_open;
    size_t outside,
        tangled;      /* centroids outside of their star, or not seeing all of it */
    size_t locked;    /* stars where the mesh is not manifold, or flat twice */
    size_t above_max; /* stars left alone because of max_star */
    size_t no_room;   /* stars left alone because of max_growth */
    size_t too_large; /* closed stars too large for an edge removal */
    size_t no_swap;   /* closed stars whose edge no valid removal takes */
    size_t visits, most_visited; /* stars for all targets, and for one */
    size_t abandoned;            /* targets left after TM_LEPP_VISITS_MAX stars */
    size_t angle_kept; /* with sweeps: stars left for the mesh's extreme angles */
    size_t closed_size[TM_LEPP_SIZES], open_size[TM_LEPP_SIZES];
    size_t swap_size[TM_LEPP_SIZES], insertion_size[TM_LEPP_SIZES];
    size_t open_insertion_size[TM_LEPP_SIZES];
    size_t visited[TM_LEPP_VISITS];  /* targets by terminal stars visited */
    size_t branches[TM_LEPP_VISITS]; /* of TM_LEPP_FULL: targets by terminal edges of
                                        their first Lepp3D */
    size_t longest;                  /* most main edges in one path or Lepp3D */
    tm_lepp_sweep_report smooth, swap;
    size_t not_delaunay_before, not_delaunay_after; /* faces: TM_LEPP_DELAUNAY */
    tm_delaunay_report delaunay;
} tm_lepp_report;

/* Improves the mesh. Every operation is exactly valid: boundary, regions, markers and
 * volume (but for the rounding of inserted points) stay. After an error the mesh is
 * still valid, improved as far as it got, and the report has not what is counted at the
 * end. Deterministic. */
tm_status tm_lepp_improve(tm_tet_mesh *mesh, const tm_lepp_options *options,
                          tm_lepp_report *report, tm_error *error);

/* Adds the keys of lepp-improve(1) from `passes` on. */
void tm_lepp_report_json(tm_json *json, const tm_lepp_options *options,
                         const tm_lepp_report *report);

/* How many operations changed terminal stars. */
static inline size_t tm_lepp_operations(const tm_lepp_report *report)
{
    return report->swaps + report->centroids + report->midpoints + report->open_midpoints;
}

/* How often the sweeps of one kind changed the mesh. */
static inline size_t tm_lepp_swept(const tm_lepp_sweep_report *report)
{
    size_t done = 0;
    for (int i = 0; i < TM_LEPP_SWEEPS; i++)
        done += report->done[i];
    return done;
}

/* All changes of the mesh. */
static inline size_t tm_lepp_changes(const tm_lepp_report *report)
{
    return tm_lepp_operations(report) + tm_lepp_swept(&report->smooth) +
           tm_lepp_swept(&report->swap);
}

TM_EXTERN_C_END

#endif
