/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improvement of a mesh by all local operations together, on the bad tetrahedra: a
 * hill climb by a cost (tet_measure.h) that counts them and says how bad they are, with
 * kicks out of its local optima. The surface (features.h) stays exactly where it is. */
#ifndef TM_IMPROVE_IMPROVE_H
#define TM_IMPROVE_IMPROVE_H

#include "../../base/extern_c.h"
#include "../../text/json.h"
#include "../../base/progress.h"
#include "../../element/tet_measure.h"
#include "../mesh.h"
#include "../surface_limits.h"

TM_EXTERN_C_BEGIN

/* The palette, one row for each operation:
 *
 *   TM_OP_…, name (of --ops), key (in JSON), TM_EFFECT_… (what it is counted as),
 *   TM_PHASE_… (from which on it is tried), tm_improve_…() (what tries it)
 *
 * In a phase they are tried in this order. Rows with the same function stand together: it
 * does the best of those that are asked for. */
#define TM_IMPROVE_TABLE(ROW)                                                            \
    /* of an edge inside */                                                              \
    ROW(EDGE_REMOVAL, "edge-removal", "edge_removals", EDGES_REMOVED, MOVE, swap)        \
    /* of an edge in a flat facet: 2-2, 4-4 and larger ones */                           \
    ROW(BOUNDARY_SWAP, "boundary-swap", "boundary_swaps", EDGES_REMOVED, MOVE, swap)     \
    /* 2-3, and of several faces side by side */                                         \
    ROW(FACE_REMOVAL, "face-removal", "face_removals", FACES_REMOVED, MOVE, swap)        \
    /* moves a node: inside, in a flat facet, on a straight edge */                      \
    ROW(SMOOTHING, "smoothing", "moves", NODES_MOVED, MOVE, smooth)                      \
    /* of a tetrahedron under a surface that may move */                                 \
    ROW(PEELING, "peeling", "peelings", TETS_PEELED, MOVE, peel)                         \
    /* of an edge: removes a node */                                                     \
    ROW(CONTRACTION, "contraction", "contractions", NODES_REMOVED, SHRINK, contract)     \
    /* of a node, at the best point of a cavity, or on an edge */                        \
    ROW(INSERTION, "insertion", "insertions", POINTS_INSERTED, ALL, insert)              \
    /* of the tetrahedra in a cavity: the best of all ways to fill it */                 \
    ROW(RECONNECTION, "reconnection", "reconnections", CAVITIES_FILLED, LAST, reconnect)

#define TM_IMPROVE_ROW(op, name, key, effect, phase, function) TM_OP_##op,
typedef enum tm_improve_op {
    TM_IMPROVE_TABLE(TM_IMPROVE_ROW) TM_IMPROVE_OPS
} tm_improve_op;
#undef TM_IMPROVE_ROW

/* The names. */
extern const char *const tm_improve_op_name[TM_IMPROVE_OPS];

/* What operations come to; those that insertions removed are among the nodes removed. */
typedef enum tm_improve_effect {
    TM_EFFECT_EDGES_REMOVED,
    TM_EFFECT_FACES_REMOVED,
    TM_EFFECT_NODES_MOVED,
    TM_EFFECT_POINTS_INSERTED,
    TM_EFFECT_NODES_REMOVED,
    TM_EFFECT_CAVITIES_FILLED,
    TM_EFFECT_TETS_PEELED,
    TM_IMPROVE_EFFECTS
} tm_improve_effect;

enum { TM_IMPROVE_ALL_OPS = (1 << TM_IMPROVE_OPS) - 1 };

typedef struct tm_improve_options {
    double angle; /* degrees; bad: a dihedral angle below it, or above 180 - it */
    tm_tet_measure measure;    /* by which tetrahedra are compared */
    double max_growth;         /* tetrahedra at most, by those of the input; 0: any */
    unsigned ops;              /* bits 1 << tm_improve_op */
    size_t passes;             /* over the bad tetrahedra, at most; 0: any number */
    bool converge;             /* go on while anything is gained, not only enough */
    tm_surface_limits surface; /* how far the surface may move */
    unsigned threads;          /* 0 is 1: always the same result */
    const tm_progress *progress;
} tm_improve_options;

typedef struct tm_improve_counts {
    size_t op[TM_IMPROVE_OPS];
    size_t edge_splits; /* those insertions that are on an edge to keep */
    size_t swallowed;   /* nodes that insertions removed */
} tm_improve_counts;

typedef struct tm_improve_report {
    size_t tets_before, bad_before, bad_after; /* tetrahedra */
    size_t passes;                             /* over the bad tetrahedra */
    size_t kicks;
    tm_improve_counts done;       /* what led to the result */
    size_t tried[TM_IMPROVE_OPS]; /* how often it was looked for; 0 for swaps */
    size_t nodes_free[4];         /* of the input, by the dimension they may move in */
    bool too_large;               /* max_growth could not be reached */
    double tolerance;             /* of the surface, and what that has, if it is not 0 */
    size_t patches, curves, corners;
} tm_improve_report;

/* Improves the mesh. The smallest and the largest dihedral angle never get worse but
 * where they are still good; neither does the number of bad tetrahedra or their share,
 * where the mesh need not become smaller. Volume, surface, regions and markers stay, but
 * for the rounding of nodes that move in the surface; with a tolerance the surface stays
 * within that (tet/envelope/envelope.h). If nothing is bad, angles above 30 degrees are
 * reached one degree after the other. After an error the mesh is still valid, improved as
 * far as it got. Deterministic. In practice O(tetrahedra). */
tm_status tm_improve(tm_tet_mesh *mesh, const tm_improve_options *options,
                     tm_improve_report *report, tm_error *error);

/* Adds the keys of lepp-improve(1) from `passes` on. */
void tm_improve_report_json(tm_json *json, const tm_improve_report *report);

/* How many operations changed the mesh. */
size_t tm_improve_operations(const tm_improve_report *report);

/* How often they had an effect. */
size_t tm_improve_effects(const tm_improve_report *report, tm_improve_effect effect);

TM_EXTERN_C_END

#endif
