/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of the improver share: improve.c (when what is tried), improve_engine.c,
 * and one for each kind of operation; for these only. */
#ifndef TM_IMPROVE_IMPROVE_ENGINE_H
#define TM_IMPROVE_IMPROVE_ENGINE_H

#include "improve.h"

#include "../../geom/space_order.h"
#include "../operation/ball.h"
#include "../operation/cavity.h"
#include "../operation/cavity_search.h"
#include "../operation/edge_removal.h"
#include "../operation/face_removal.h"
#include "../operation/features.h"
#include "../operation/mesh_part.h"
#include "../operation/replacement.h"
#include "../star.h"

/* Every operation has to lower the cost by this. */
#define TM_IMPROVE_GAIN 1e-6

/* An edge of a face that goes from the surface; the face beyond stays: its third node. */
typedef struct tm_improve_bend {
    uint32_t node[2];
    uint32_t beyond;
    uint32_t face; /* that goes */
} tm_improve_bend;

/* How much a surface bends where it is to be changed. */
typedef struct tm_improve_bends {
    double least; /* cosine between normals side by side that is allowed in a patch */
    double most;  /* and at a feature edge */
    size_t count;
    tm_improve_bend edge[3 * TM_CHANGE_MOST];
} tm_improve_bends;

/* A mesh to come back to. */
typedef struct tm_improve_state {
    tm_tet_mesh mesh;
    tm_features features;
    tm_improve_counts done;
    size_t bad;     /* tetrahedra; SIZE_MAX: nothing is kept */
    double badness; /* see tm_improver.full_size */
} tm_improve_state;

typedef struct tm_improver {
    tm_tet_mesh *mesh;
    const tm_improve_options *options;
    tm_improve_report *report;
    tm_error *error;
    tm_progress_at at;
    tm_status status; /* of what failed: nothing more is done then */

    tm_cost cost;
    double degrees; /* the target, by the angle or, for volume, a hundredth of it */
    double price;   /* of one more tetrahedron; negative to kick */
    double mean;    /* cost of a tetrahedron, when the pass began */
    bool thrifty;   /* that is what one is worth while the mesh is below full_size */
    unsigned fails; /* rounds of local kicks; they differ by it */
    bool last;      /* the worst ones are worked on: nothing made is as bad as they */
    size_t work;    /* some 20 µs each: tetrahedra tried, and what else takes time */
    size_t work_most;
    size_t most_tets; /* the mesh never grows beyond */

    /* By tetrahedron: its quality by cost.measure; the change after which it was tried.
     */
    double *quality;
    uint32_t *tried;
    uint32_t *stubborn; /* kicks without success */
    size_t tet_room;
    /* By node: a tetrahedron that has it; the last change around it; the changes after
     * which it was tried. */
    uint32_t *tet_at, *changed, *smoothed, *contracted;
    size_t node_room;
    uint32_t change; /* counts them */

    /* States are compared by their bad tetrahedra, times this by all of them where these
     * are fewer: so neither the count nor the share of bad ones gets worse, and neither
     * growth nor what takes away the good looks like a gain. */
    size_t full_size;     /* tetrahedra of the input, or that it may keep */
    double angle_badness; /* of the input by its angles: the most that is allowed */

    tm_improve_state best;    /* for this target, so far */
    tm_improve_state earlier; /* before the pass, or the kick of one tetrahedron */
    tm_mesh_part changes;     /* since that kick began */
    bool recording;           /* of what changes */
    tm_improve_state reached; /* the last target that left nothing bad */
    tm_improve_state input;   /* where there are several targets, or most is bad */
    tm_improve_state whole;   /* the input, where the mesh has to become smaller */
    tm_improve_state kept;    /* before other ways, or the worst ones, were tried */

    tm_space space; /* around the mesh */
    tm_features features;
    tm_tet_marks marks; /* on tetrahedra */
    tm_tet_marks seen;  /* on nodes */
    tm_star star, around;
    tm_ball ball, other_ball;
    tm_tet_marks linked;                 /* on nodes */
    tm_surface_change change_of_surface; /* that was allowed last */
    tm_improve_bends bends;
    double least_cosine; /* of the feature angle */
    tm_cavity cavity;
    tm_edge_removal removal[2]; /* for the two sides of a facet */
    tm_face_removal face_removal;
    tm_cavity_search search;
    tm_replacement_table table;
    uint32_t (*node)[4]; /* of tetrahedra to be made */
    uint32_t *created;
    uint32_t *swallowed; /* nodes */
    size_t made_room;
    uint32_t *target;
    size_t targets, target_room;
    uint32_t *cluster; /* bad tetrahedra that are kicked together */
    size_t cluster_size, cluster_room;
    size_t tries; /* of a tetrahedron: how much was done */
} tm_improver;

/* What is known of a mesh that is to be improved. tm_improve_finish() in any case. */
tm_status tm_improve_start(tm_improver *m, tm_tet_mesh *mesh,
                           const tm_improve_options *options, tm_improve_report *report,
                           tm_error *error);
void tm_improve_finish(tm_improver *m);

/* What is not bad, by the measure, for a target in degrees. */
double tm_improve_target(const tm_improver *m, double degrees);

/* Sets the target; the price is 0 then. */
void tm_improve_set_target(tm_improver *m, double degrees);

/* Keeps the mesh, which has so many bad tetrahedra and is so bad by them. */
void tm_improve_snapshot(tm_improver *m, tm_improve_state *state, size_t bad,
                         double badness);

/* The same of the mesh as it is. */
void tm_improve_keep(tm_improver *m, tm_improve_state *state);

/* Goes back to the mesh that was kept. */
void tm_improve_restore(tm_improver *m, const tm_improve_state *state);

/* What a pass tries: what neither adds nor removes nodes; what makes the mesh smaller
 * too; what makes it larger; what takes long. */
typedef enum {
    TM_PHASE_MOVE,
    TM_PHASE_SHRINK,
    TM_PHASE_ALL,
    TM_PHASE_LAST
} tm_improve_phase;

/* Kicks bad tetrahedra one after the other, and after each does what is good for the mesh
 * around it; what does not make the mesh less bad is undone. The mesh is the best so far.
 * Ends after some rounds that gain less than the share `enough` each, or so many tries.
 */
void tm_improve_kick_locally(tm_improver *m, double enough, size_t tries);

/* Whether no pass is left. */
bool tm_improve_is_over(const tm_improver *m);

/* A pass over m->target begins. */
void tm_improve_tell_pass(tm_improver *m);

bool tm_improve_is_bad(const tm_improver *m, uint32_t t);

/* Whether anything around t has changed since it was tried. */
bool tm_improve_is_due(const tm_improver *m, uint32_t t);

/* Lists the bad tetrahedra in m->target, those that are due or all, along a space-filling
 * curve; false where memory is out. */
bool tm_improve_find_targets(tm_improver *m, bool all);

/* Tries the operations of a phase on t until something is done. */
bool tm_improve_try(tm_improver *m, uint32_t t, tm_improve_phase phase);

/* How bad a mesh of so many tetrahedra is with so many bad ones: see full_size; and the
 * mesh as it is. */
double tm_improve_badness(const tm_improver *m, size_t tets, size_t bad);
double tm_improve_mesh_badness(const tm_improver *m);

size_t tm_improve_count_bad(const tm_improver *m);

/* Whether the mesh is no worse than the input by its angles, whatever the measure is. */
bool tm_improve_keeps_angles(const tm_improver *m);

/* The least and the largest angle of the mesh. */
tm_angle_limits tm_improve_angles(const tm_improver *m);

/* Contracts at all nodes, at a price for each tetrahedron that doubles so many times,
 * until there are m->most_tets; with `passes`, all bad ones are tried in between. */
void tm_improve_shrink(tm_improver *m, int doublings, bool passes);

/* From here on no operation makes an angle below so many degrees, or above 180 less
 * that. */
void tm_improve_forbid(tm_improver *m, double degrees);

/* The price of a tetrahedron; all may be tried again. */
void tm_improve_set_price(tm_improver *m, double price);

/* All that is done for one target. */
typedef void tm_improve_reach(tm_improver *m);

/* Tries other ways where much stays bad; `run` is all that is done with the input.
 * Whether that has helped, and much is bad still: then all may be done again. */
bool tm_improve_stuck(tm_improver *m, tm_improve_reach *run, tm_improve_reach *reach);

/* Whether so much of the input is bad that it is kept for that. */
bool tm_improve_is_mostly_bad(const tm_improver *m);

/* Works on the worst tetrahedra: raises the least angle, with no more bad ones then than
 * before; `reach` is for one target after the other. Then one by one, with the whole
 * palette, where no operation makes a tetrahedron as bad as the worst that it replaces,
 * or more bad ones. */
void tm_improve_worst(tm_improver *m, tm_improve_reach *reach);

/* The functions of the table: each tries its operations on tetrahedron t, or at its
 * nodes; whether one was done. */
#define TM_IMPROVE_ROW(op, name, key, effect, phase, function)                           \
    bool tm_improve_##function(tm_improver *m, uint32_t t);
TM_IMPROVE_TABLE(TM_IMPROVE_ROW)
#undef TM_IMPROVE_ROW

/* Tries to contract one of the edges of node a, a corner of t. */
bool tm_improve_contract_node(tm_improver *m, uint32_t t, uint32_t a);

/* Whether an edge with a marker would go with m->cavity. */
bool tm_improve_has_marked_edge(const tm_improver *m);

/* Room for an operation that makes so many tetrahedra and nodes; false, with m->status
 * set, where memory is out. */
bool tm_improve_reserve(tm_improver *m, size_t tets, size_t nodes);

/* Measures the tetrahedra that an operation made. */
void tm_improve_note(tm_improver *m, const uint32_t *created, size_t count);

/* What some tetrahedra cost, and in *least how good those have to be that replace them.
 */
double tm_improve_old_cost(const tm_improver *m, const uint32_t *old, size_t count,
                           double *least);

/* False, with m->status set: memory is out. */
bool tm_improve_no_memory(tm_improver *m);

/* Changes of a surface that may move (features.may_move), each asked about as it is
 * planned. What was allowed last is in m->change_of_surface. */

/* Whether the edge of m->star, which is in a patch, may be swapped; its parts. */
bool tm_improve_allows_swap(tm_improver *m, const tm_star *part, int parts);

/* Whether the node of m->ball, which is on the surface, may be contracted into b. */
bool tm_improve_allows_contraction(tm_improver *m, uint32_t b);

/* Moves p, near the surface, to where the node of m->ball may go of it. *place is where
 * that is on its curve, if it is on one. False where there is no such place. */
bool tm_improve_onto_surface(tm_improver *m, double p[3], double *place);

/* Whether the node of m->ball, which is on the surface, may move to p. */
bool tm_improve_allows_move(tm_improver *m, const double p[3], double place);

/* Moves p, on the edge of m->star, to the surface that this is on. *place as above. */
void tm_improve_split_onto_surface(tm_improver *m, double p[3], double *place);

/* Whether that edge may be split at p. */
bool tm_improve_allows_split(tm_improver *m, const double p[3], double place);

/* Whether tetrahedron t, whose face i is on the outside, may be peeled off. */
bool tm_improve_allows_peel(tm_improver *m, uint32_t t, uint32_t i);

/* Notes how much the surface bends at the old faces of the change, and at their edges;
 * then, with nodes where they will be, whether it would bend more. */
void tm_improve_look_at_bends(tm_improver *m);
bool tm_improve_bends_more(const tm_improver *m);

/* The surface was changed as was allowed last. */
void tm_improve_follow_surface(tm_improver *m);

static inline bool tm_improve_has(const tm_improver *m, tm_improve_op op)
{
    return (m->options->ops >> op & 1) != 0;
}

/* What it costs that the mesh has so many tetrahedra more, beside what these cost. Where
 * it is thrifty, the sum of all costs for each tetrahedron has to fall, not the sum: else
 * an empty mesh is the best. */
static inline double tm_improve_growth_cost(const tm_improver *m, ptrdiff_t growth)
{
    double worth = m->thrifty && m->mesh->tets < m->full_size ? m->mean : 0;
    return (m->price - worth) * (double)growth;
}

/* Whether the mesh may have so many tetrahedra more. */
static inline bool tm_improve_may_grow(const tm_improver *m, ptrdiff_t growth)
{
    return growth <= 0 || m->mesh->tets + (size_t)growth <= m->most_tets;
}

#endif
