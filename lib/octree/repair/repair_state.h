/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh on its way through the repair: elements with their octants, and what each node
 * may do. */
#ifndef TM_REPAIR_REPAIR_STATE_H
#define TM_REPAIR_REPAIR_STATE_H

#include "../../base/extern_c.h"
#include "../../optimise/optimise.h"
#include "../forest/octree.h"

TM_EXTERN_C_BEGIN

/* An element whose J_ENS is below is not taken for valid, whatever the threshold: it must
 * be so in other programs too. */
#define TM_REPAIR_LEAST 1e-6

/* No step makes an element that was above the first fall below. The worst J_ENS may fall
 * to the larger of the threshold and the second; to the second where fewer elements are
 * invalid then, and to the first if that is not possible else. */
#define TM_REPAIR_FLAT 0.02
#define TM_REPAIR_GOOD 0.2

/* What is elsewhere of a mesh of which a state is a part: nothing there is bad, and
 * nothing moves. */
typedef struct tm_repair_rest {
    size_t elements;
    double worst, least; /* as in a tm_repair_score */
    const bool *end;     /* [nodes]: some of its elements may be there */
    size_t nodes;        /* others of the part have all of theirs */
    bool reached;        /* a step needed more around such a node */
    bool whole;          /* a step needed all of the mesh */
} tm_repair_rest;

/* Numbers of octants are those of rows of .octant. */
typedef struct tm_repair_state {
    tm_mixed_mesh mesh;
    tm_node_rule *rule; /* [nodes]; of repair_boundary.h */
    uint8_t *on;        /* [nodes]: tm_node_class */
    uint32_t *octant;   /* [elements]: TM_NONE where it is in none */
    uint32_t *origin;   /* [elements]: of which it is a part, ascending, until `remade` */
    tm_octree octree;   /* no leaves: there is none */
    uint32_t *row;      /* [leaves]: of the octant, TM_NONE of one that was missing */
    uint32_t *id;       /* [octants]: in .oct and .ref; NULL: their numbers from 0 */
    bool divided;       /* some elements are parts of what they were; nodes were added */
    bool remade;        /* from another octree: all of it is new */
    bool lenient;       /* the worst may fall to TM_REPAIR_FLAT for fewer invalid ones */
    const tm_progress *progress; /* of the repair; NULL in trials */
    const tm_stop *stop;         /* the same */
    tm_repair_rest *rest;        /* NULL: this is all of the mesh */
} tm_repair_state;

/* How good it is. */
typedef struct tm_repair_score {
    size_t off_surface; /* nodes that are not on the surface yet */
    size_t
        invalid; /* elements with J_ENS < TM_REPAIR_LEAST, or not certified (certify.h) */
    size_t bad;  /* these and all below the threshold */
    double worst;   /* J_ENS; 1 of no elements */
    double least;   /* the same of tm_repair_quality() */
    double good;    /* the larger of the threshold and TM_REPAIR_GOOD */
    double valid;   /* what the worst may fall to where fewer are invalid */
    double average; /* of J_ENS; 0 of no elements */
} tm_repair_score;

/* Whether an element, whose J_ENS is given, is bad: not valid, or below the threshold. */
bool tm_repair_is_bad(const tm_mixed_mesh *mesh, size_t e, double jens, double threshold);

/* The J_ENS of an element, which is given; at most 0 of one that is not certified: all
 * that is valid is better. */
double tm_repair_quality(const tm_mixed_mesh *mesh, size_t e, double jens);

/* Measures all elements, of a part also the rest; the average is that of the part.
 * O(elements). */
tm_repair_score tm_repair_measure(const tm_repair_state *state, double threshold);

/* The rule of all steps: whether `a`, made from `b`, is to be kept. It must not have more
 * invalid elements; nor more nodes that are off the surface; nor more bad elements,
 * unless fewer are invalid; nor a lower worst or least, unless that is good still, or
 * `valid` where fewer are invalid; and one of these must be better. */
bool tm_repair_better(const tm_repair_score *a, const tm_repair_score *b);

/* The octants that hold a bad element, but for those of `except` ([elements], or NULL),
 * or, with `off_surface`, one at a node that is off the surface: ascending, malloc'ed. */
tm_status tm_repair_bad_octants(const tm_repair_state *state, double threshold,
                                bool off_surface, const bool *except, uint32_t **octant,
                                size_t *count, tm_error *error);

/* Notes that a step cannot be made with a part of the mesh; an error, which ends it. */
tm_status tm_repair_fail_part(bool *why, tm_error *error);

/* Adds the octants that have a node in common with the elements of those listed. */
tm_status tm_repair_widen(const tm_repair_state *state, uint32_t **octant, size_t *count,
                          tm_error *error);

/* Lets nodes that are off the surface before one patch go to any. */
void tm_repair_free_off_surface(tm_repair_state *state);

/* Where nodes are, and their rules: what is needed to take back moves of nodes, as long
 * as there are the same. */
typedef struct tm_repair_points {
    double (*xyz)[3];
    tm_node_rule *rule;
} tm_repair_points;

/* Keeps them in *places, to be freed, after an error too; puts them back. */
tm_status tm_repair_save(tm_repair_points *places, const tm_repair_state *state,
                         tm_error *error);
void tm_repair_restore(const tm_repair_points *places, tm_repair_state *state);
void tm_repair_points_free(tm_repair_points *places);

void tm_repair_state_free(tm_repair_state *state);

TM_EXTERN_C_END

#endif
