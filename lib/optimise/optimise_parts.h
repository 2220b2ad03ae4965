/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the optimiser, for optimise*.c only. optimise.c calls
 * optimise_off_surface.c and optimise_release.c; all three call optimise_mend.c, and that
 * optimise_descent.c, which minimises what optimise_objective.c and optimise_untangle.c
 * measure over the nodes that optimise_cluster.c has gathered. */
#ifndef TM_OPTIMISE_OPTIMISE_PARTS_H
#define TM_OPTIMISE_OPTIMISE_PARTS_H

#include "optimise.h"

/* Elements around the nodes that may have to move. */
typedef struct tm_vicinity {
    uint32_t *row; /* [nodes]: the row of a node, or TM_NONE */
    size_t rows;
    size_t *start;     /* [rows + 1] */
    uint32_t *element; /* of row r: element[start[r]] … element[start[r + 1] - 1] */
} tm_vicinity;

/* Rows for the nodes of the elements of `seed`, those of `more`, and those up to `rings`
 * elements away from them. O(rings * elements), one pass over all for each ring. */
tm_status tm_vicinity_find(tm_vicinity *vicinity, const tm_mixed_mesh *mesh,
                           const uint32_t *seed, size_t seeds, const tm_node_rule *rule,
                           unsigned rings, tm_error *error);
void tm_vicinity_free(tm_vicinity *vicinity);

/* A corner that is below its target. */
typedef struct tm_active_corner {
    uint32_t element;
    uint32_t corner;
    double jacobian;
    double weight;
} tm_active_corner;

/* How good the elements of a cluster are, against how they were. */
typedef struct tm_score {
    size_t fresh; /* elements that are bad now and were not */
    size_t bad;
    size_t inverted; /* J_ENS <= 0 */
    double worst;    /* the least J_ENS - threshold */
} tm_score;

/* Elements with all their nodes, copied out of the mesh: first the nodes that move. */
typedef struct tm_cluster {
    const tm_boundary *boundary;
    size_t moving;
    size_t nodes;
    size_t node_room;
    uint32_t *node;           /* [nodes] in the mesh */
    double (*xyz)[3];         /* [nodes] */
    tm_node_rule *rule;       /* [moving] */
    tm_boundary_point *point; /* [moving]: on the boundary */
    double (*offset)[3]; /* [moving]: from there to the node, if it is off the surface */
    double *size;        /* [moving]: the mean length of its edges */
    double (*old)[3];    /* [moving]: before a step */
    tm_boundary_point *old_point; /* [moving]: the same */
    double (*best)[3];            /* [moving]: with the best score so far */
    double *vector;               /* [moving * 3 * TM_CLUSTER_VECTORS]: of the descent */

    size_t elements;
    size_t element_room;
    uint32_t *element; /* [elements] in the mesh */
    size_t *start;     /* [elements + 1] */
    size_t item_room;
    uint32_t *item;           /* nodes of the cluster */
    double *threshold;        /* [elements] */
    double *before;           /* [elements]: J_ENS at first */
    double *jens;             /* [elements]: J_ENS now */
    tm_active_corner *corner; /* [elements * TM_ELEMENT_CORNERS] */
    size_t corners;
    double sum;               /* of the terms of the objective */
    double *element_size;     /* [elements]: the mean length of the edges, at first */
    double least_determinant; /* of tm_untangle_value() */
    double (*pull)[3];        /* [moving]: its derivative */

    tm_score first, best_score;
    size_t evaluations;
    size_t measured; /* elements, in all of them */
} tm_cluster;

/* Pairs of steps and differences that L-BFGS remembers, and its other vectors. */
enum { TM_DESCENT_MEMORY = 6, TM_CLUSTER_VECTORS = 2 * TM_DESCENT_MEMORY + 3 };

/* What clusters are made of, and marks to make them with; all for the whole mesh. */
typedef struct tm_cluster_source {
    const tm_mixed_mesh *mesh;
    const tm_node_rule *rule;
    const tm_boundary *boundary;
    const tm_optimise_options *options;
    const double *jens; /* [elements] */
    const tm_vicinity *vicinity;
    uint32_t *local; /* [nodes]: the node of the cluster, else TM_NONE */
    bool *taken;     /* [elements]: it is in the cluster; else false */
} tm_cluster_source;

/* The threshold of an element. */
static inline double tm_threshold_of(const tm_optimise_options *options, size_t e)
{
    return options->thresholds ? options->thresholds[e] : options->threshold;
}

/* Gathers the cluster of the elements core[0 … cores): their nodes move, and those up to
 * `rings` elements away, as far as they may; all elements that have a node that moves
 * are in it. Where no node can move, the cluster is empty. */
tm_status tm_cluster_gather(tm_cluster *cluster, const tm_cluster_source *source,
                            const uint32_t *core, size_t cores, unsigned rings,
                            tm_error *error);
void tm_cluster_free(tm_cluster *cluster);

/* Finds point[v], where node v should be that is at a point. */
void tm_cluster_find(tm_cluster *cluster, size_t v, const double point[3]);

/* Puts node v of the cluster, which moves, to the allowed point closest to that one. */
void tm_cluster_move(tm_cluster *cluster, size_t v, const double point[3]);

/* What is minimised: the distortion of optimise_untangle.c with the number ε, or what is
 * missing to the thresholds, with a sharpness. */
typedef struct tm_objective {
    bool untangle;
    double number;
} tm_objective;

/* log(1 + Σ e^x - 1 - x) / s with x = s (target - J_ENS) > 0 over all corners, the target
 * being a margin above the threshold and s the sharpness; or the distortion. Fills
 * jens[] and the corners that are below their targets. */
double tm_cluster_value(tm_cluster *cluster, tm_objective objective);

/* Its derivative by the nodes that move, along the boundary where they are on it;
 * tm_cluster_value() was called before. */
void tm_cluster_slope(const tm_cluster *cluster, tm_objective objective,
                      double (*slope)[3]);

/* The distortion; its derivative, which is nearly always needed, goes to pull[]. The next
 * ε, where the value became less by the factor 1 - gain. */
double tm_untangle_value(tm_cluster *cluster, double epsilon);
double tm_untangle_next(const tm_cluster *cluster, double epsilon, double gain);

/* Takes from a vector at node v what leads off its surface or curve. */
void tm_cluster_along(const tm_cluster *cluster, size_t v, double vector[3]);

tm_score tm_cluster_score(const tm_cluster *cluster);
bool tm_score_better(const tm_score *score, const tm_score *than);

/* Lets node v, which is off the surface, come closer to its point of the boundary, by
 * that factor of the way that is missing; 0: all of it. All elements are from now on
 * compared with how they were when gathered, by thresholds of at most `threshold`. */
void tm_cluster_approach(tm_cluster *cluster, size_t v, double factor, double threshold);

/* Minimises from where the nodes are. Positions with a score better than best_score are
 * kept in best[]. Ends early where nothing is bad. Returns by which part of the value it
 * became less. */
double tm_cluster_descend(tm_cluster *cluster, tm_objective objective,
                          unsigned iterations);

/* Elements of a chunk of TM_CHUNK. */
typedef struct tm_optimise_tally {
    size_t bad, inverted; /* J_ENS <= 0 */
    size_t before;        /* bad ones of the chunks before it */
    double worst;
} tm_optimise_tally;

/* A call of tm_mixed_optimise(). */
typedef struct tm_optimise_work {
    tm_mixed_mesh *mesh;
    tm_node_rule *rule;
    const tm_optimise_options *options;
    double *jens;             /* [elements] */
    tm_optimise_tally *tally; /* [chunks of elements]: as they were counted last */
    bool *visited;            /* [elements]: in this pass */
    bool *moved;              /* [nodes] */
    uint32_t *bad;            /* elements, the worst first */
    size_t bads;
    tm_vicinity vicinity;
    tm_cluster_source source;
    tm_cluster cluster;
    tm_optimise_report *report;
    size_t passes;
} tm_optimise_work;

/* Minimises, the more sharply the closer it comes, until nothing is bad; where that
 * leaves elements inverted, it may untangle first. */
void tm_optimise_descend(tm_optimise_work *work, bool may_untangle);

/* Whether no more is to be begun, by most_measured or the caller's wish. */
bool tm_optimise_is_spent(const tm_optimise_work *work);

/* Takes the best positions of the cluster into the mesh. */
void tm_optimise_accept(tm_optimise_work *work);

/* Mends what is bad and near the nodes that vicinity has, pass after pass. */
tm_status tm_optimise_mend(tm_optimise_work *work, unsigned effort, tm_error *error);

/* Lets nodes of elements that stay below release_threshold leave corners, curves and
 * patches, and mends again. */
tm_status tm_optimise_release(tm_optimise_work *work, tm_error *error);

/* Brings nodes that are off the surface to it. */
tm_status tm_optimise_off_surface(tm_optimise_work *work, tm_error *error);

#endif
