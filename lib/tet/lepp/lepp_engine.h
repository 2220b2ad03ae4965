/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of LEPP share, for these only. Each calls those below it: lepp.c
 * (targets and passes); lepp_path.c (from a target to terminal stars), and the sweeps
 * between passes, lepp_smooth.c and lepp_swap.c; lepp_star.c (what is done with a
 * terminal star); lepp_engine.c (what is known of the mesh). */
#ifndef TM_LEPP_LEPP_ENGINE_H
#define TM_LEPP_LEPP_ENGINE_H

#include "lepp.h"

#include "../../element/tet_measure.h"
#include "../operation/ball.h"
#include "../delaunay/delaunay_insertion.h"
#include "../operation/edge_removal.h"
#include "../operation/features.h"
#include "../operation/replacement.h"
#include "../mesh_set.h"

/* After so many terminal stars a target is left as it is. Insertions of midpoints end by
 * themselves (Balboa saw some hundreds of stars); that Delaunay insertions do has not
 * been proved. */
enum { TM_LEPP_VISITS_MAX = 100000 };

/* What is remembered of each tetrahedron beside its quality: its longest edge, 0 … 5, and
 * these bits. Two bytes, because paths look at it most.
 *
 * An edge is refused from when nothing was done at its star until that star changes. All
 * tetrahedra around have a bit for it: a hash table of edges would be asked for something
 * that is not there most of the time. Those whose longest edge it is have BLOCKED too
 * where it is not refinable in this round, and SETTLED where it is that in all later
 * ones. TARGET is for those of S: the bad ones, if the caller asks for no others. */
enum {
    TM_LEPP_LONGEST = 7,
    TM_LEPP_BAD = 1 << 3,
    TM_LEPP_QUEUED = 1 << 4,
    TM_LEPP_BLOCKED = 1 << 5,
    TM_LEPP_SETTLED = 1 << 6,
    TM_LEPP_TARGET = 1 << 7,
    TM_LEPP_REFUSED = 1 << 8 /* edge 0; edge k is k bits above */
};

/* A step of the path: the tetrahedron and its longest edge, and how far the star of that
 * has been searched for the next step. */
typedef struct tm_lepp_step {
    uint32_t t;
    uint32_t a, b;
    tm_star star;
    size_t searched;
    size_t operations; /* done when the star was collected; SIZE_MAX: not collected */
    bool is_terminal;  /* was when it was found: TM_LEPP_FULL */
} tm_lepp_step;

/* What sweeps need beside, and TM_LEPP_FIXED. */
typedef struct tm_lepp_sweeper {
    tm_angle_limits limits; /* of the input: no change goes beyond */
    tm_features features;
    tm_ball ball;
    tm_tet_marks marks;
    tm_star star;
    tm_replacement_table table;
    uint32_t *tet_at;  /* [nodes]: a tetrahedron that has the node, or TM_NONE */
    tm_tet_marks seen; /* nodes of a mean */
    size_t tet_at_room;
} tm_lepp_sweeper;

typedef struct tm_lepp_engine {
    tm_tet_mesh *mesh;
    const tm_lepp_options *options;
    tm_lepp_report *report;
    tm_error *error;
    tm_progress_at at;
    double bad_below; /* sin² */
    tm_gain gain;     /* what selective asks for */
    size_t most_tets; /* the mesh never grows beyond */
    uint16_t *mark;   /* [mesh->slots] */
    double *quality;  /* [mesh->slots], by options->measure */
    size_t mark_room, quality_room;

    tm_star around;      /* of an edge that is made refinable */
    tm_edge_map refused; /* of the edges where the mesh is not manifold: the round in
                            which they were found so */
    uint32_t round;
    tm_lepp_step *path; /* [path_room]; the stars keep their memory */
    tm_tet_marks graph; /* TM_LEPP_FULL: tetrahedra of the target's Lepp3D */
    size_t depth, path_room;
    size_t operations;
    bool is_input;    /* what is measured is: the mesh's set is S */
    bool reintroduce; /* tetrahedra for S that are made join it */
    uint32_t *target; /* S */
    size_t targets, target_room;
    tm_edge_removal removal;
    uint32_t *created;
    size_t created_room;
    tm_delaunay delaunay;
    tm_lepp_sweeper sweeper;
} tm_lepp_engine;

/* Measures tetrahedra: their marks and qualities. */
void tm_lepp_measure(tm_lepp_engine *e, const uint32_t *tet, size_t count);

/* Room in the engine's arrays for so many more slots, and created tetrahedra; false where
 * memory is out. */
bool tm_lepp_reserve(tm_lepp_engine *e, size_t more);

/* Finds a tetrahedron at each node; false where memory is out. tm_lepp_note() keeps them
 * with TM_LEPP_FIXED. */
bool tm_lepp_place_nodes(tm_lepp_engine *e);

/* Measures tetrahedra that were made or changed; those that are bad join S if that grows.
 * False where memory is out. */
bool tm_lepp_note(tm_lepp_engine *e, const uint32_t *tet, size_t count);

/* Nothing is done at a terminal star: its edge is refused, and not refinable in this
 * round. */
tm_status tm_lepp_block(tm_lepp_engine *e, const tm_star *star);
bool tm_lepp_is_refused(const tm_lepp_engine *e, const tm_star *star);

/* Makes the edges refinable again that are not settled. */
void tm_lepp_start_round(tm_lepp_engine *e);

/* Makes the edges of a star that is about to change refinable; false where memory is out.
 * Its own edge is not blocked: a path does not lead to one that is. */
bool tm_lepp_unblock_star(tm_lepp_engine *e, const tm_star *star);

/* Makes the edges of tetrahedra that were measured anew refinable again; false where
 * memory is out. */
bool tm_lepp_unblock(tm_lepp_engine *e, const uint32_t *tet, size_t count);

/* Appends a tetrahedron to S; false where memory is out. */
bool tm_lepp_add_target(tm_lepp_engine *e, uint32_t t);

/* Follows the path of one target, or all branches of its Lepp3D, until it is gone or its
 * longest edge is not refinable. */
tm_status tm_lepp_follow(tm_lepp_engine *e, uint32_t target);

/* The terminal star of a path, the visited-th for its target: changes it, or makes its
 * edge non-refinable. */
tm_status tm_lepp_process_star(tm_lepp_engine *e, const tm_star *star, size_t visited);

/* Sweeps over the mesh: nodes to the mean of their neighbours, and swaps of faces; where
 * that makes the worst tetrahedron better. */
tm_status tm_lepp_smooth(tm_lepp_engine *e);
tm_status tm_lepp_swap(tm_lepp_engine *e);

static inline bool tm_lepp_has_sizes(const tm_lepp_options *o)
{
    return o->sizes.longest > 0 || o->sizes.attribute > 0;
}

/* Whether the mesh may have so many tetrahedra more. */
static inline bool tm_lepp_may_grow(const tm_lepp_engine *e, size_t more)
{
    return e->mesh->tets + more <= e->most_tets;
}

/* Whether the longest edge of a tetrahedron is not refinable. */
bool tm_lepp_is_blocked_by_nodes(const tm_lepp_engine *e, uint32_t t);
static inline bool tm_lepp_is_blocked(const tm_lepp_engine *e, uint32_t t)
{
    return e->mark[t] & TM_LEPP_BLOCKED ||
           (e->refused.count > 0 && tm_lepp_is_blocked_by_nodes(e, t));
}

/* Where a value is counted in a histogram whose last bin is for all larger ones. */
static inline size_t tm_lepp_bin(size_t value, size_t bins)
{
    return value < bins ? value : bins - 1;
}

#endif
