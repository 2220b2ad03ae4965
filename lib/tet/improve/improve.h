/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improvement of a mesh by all local operations together, on the bad tetrahedra: a
 * hill climb by a cost (tet_measure.h) that counts them and says how bad they are, with
 * kicks out of its local optima. The surface (features.h) stays exactly where it is. */
#ifndef TM_IMPROVE_IMPROVE_H
#define TM_IMPROVE_IMPROVE_H

#include "../../base/json.h"
#include "../../element/tet_measure.h"
#include "../mesh.h"

/* The palette. */
typedef enum tm_improve_op {
    TM_OP_EDGE_REMOVAL,  /* of an edge inside */
    TM_OP_BOUNDARY_SWAP, /* of an edge in a flat facet: 2-2, 4-4 and larger ones */
    TM_OP_FACE_REMOVAL,  /* 2-3, and of several faces side by side */
    TM_OP_SMOOTHING,     /* moves a node: inside, in a flat facet, on a straight edge */
    TM_OP_CONTRACTION,   /* of an edge: removes a node */
    TM_OP_INSERTION,     /* of a node, at the best point of a cavity, or on an edge */
    TM_IMPROVE_OPS
} tm_improve_op;

/* "edge-removal" and so on. */
extern const char *const tm_improve_op_name[TM_IMPROVE_OPS];

enum { TM_IMPROVE_ALL_OPS = (1 << TM_IMPROVE_OPS) - 1 };

typedef struct tm_improve_options {
    double angle; /* degrees; bad: a dihedral angle below it, or above 180 - it */
    tm_tet_measure measure; /* by which tetrahedra are compared */
    double max_growth;      /* tetrahedra at most, by those of the input; 0: any */
    unsigned ops;           /* bits 1 << tm_improve_op */
    size_t passes;          /* over the bad tetrahedra, at most; 0: any number */
    bool converge;          /* go on while anything is gained, not only enough */
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
} tm_improve_report;

/* Improves the mesh. The smallest and the largest dihedral angle never get worse; volume,
 * surface, regions and markers stay, but for the rounding of nodes that move in the
 * surface. If nothing is bad, angles above 30 degrees are reached one degree after the
 * other. After an error the mesh is still valid, improved as far as it got.
 * Deterministic. In practice O(tetrahedra). */
tm_status tm_improve(tm_tet_mesh *mesh, const tm_improve_options *options,
                     tm_improve_report *report, tm_error *error);

/* Adds the keys of lepp-improve(1) from `passes` on. */
void tm_improve_report_json(tm_json *json, const tm_improve_report *report);

/* How many operations changed the mesh. */
size_t tm_improve_operations(const tm_improve_report *report);

#endif
