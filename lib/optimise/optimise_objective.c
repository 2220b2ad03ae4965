/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is minimised over the positions of a cluster's nodes. */
#include "optimise_parts.h"

#include "../element/jens.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

/* How much better than its threshold an element should be. */
static const double margin = 0.05;

void tm_cluster_find(tm_cluster *cluster, size_t v, const double point[3])
{
    const tm_node_rule *rule = &cluster->rule[v];
    const tm_boundary *boundary = cluster->boundary;
    tm_boundary_point *at = &cluster->point[v];
    switch (rule->freedom) {
    case TM_MOVES_ON_SURFACE:
        boundary->on_surface(boundary->of, rule->where, point, at);
        break;
    case TM_MOVES_ON_CURVE:
        boundary->on_curve(boundary->of, rule->where, point, at);
        break;
    case TM_MOVES_AT_CORNER:
        boundary->at_corner(boundary->of, rule->where, at);
        break;
    default:
        memcpy(at->xyz, point, sizeof at->xyz);
    }
}

void tm_cluster_move(tm_cluster *cluster, size_t v, const double point[3])
{
    double on[3];
    tm_subtract(on, point, cluster->offset[v]);
    tm_cluster_find(cluster, v, on);
    for (size_t i = 0; i < 3; i++)
        cluster->xyz[v][i] = cluster->point[v].xyz[i] + cluster->offset[v][i];
}

void tm_cluster_along(const tm_cluster *cluster, size_t v, double vector[3])
{
    const uint8_t freedom = cluster->rule[v].freedom;
    const double *axis = cluster->point[v].axis;
    if (freedom == TM_MOVES_FREELY)
        return;
    if (freedom == TM_MOVES_AT_CORNER) {
        memset(vector, 0, 3 * sizeof *vector);
        return;
    }
    const double product = tm_dot(vector, axis);
    for (size_t i = 0; i < 3; i++)
        vector[i] = freedom == TM_MOVES_ON_CURVE ? product * axis[i]
                                                 : vector[i] - product * axis[i];
}

static double value_of_missing(tm_cluster *cluster, double sharpness)
{
    const double(*xyz)[3] = (const double(*)[3])cluster->xyz;
    cluster->corners = 0;
    cluster->sum = 0;
    for (size_t e = 0; e < cluster->elements; e++) {
        const size_t start = cluster->start[e];
        const tm_element_shape *shape = &tm_element_shapes[cluster->start[e + 1] - start];
        const double target = cluster->threshold[e] + margin;
        double jacobian[TM_ELEMENT_CORNERS], least = 1;
        tm_scaled_jacobians(shape, xyz, cluster->item + start, jacobian);
        for (size_t i = 0; i < shape->corners; i++) {
            const double jens = tm_jens_of(jacobian[i], shape->k[i]);
            least = jens < least ? jens : least;
            if (jens >= target)
                continue;
            /* J_ENS rises again towards J_S = -1: not so here. */
            const double value = jacobian[i] < 0 ? jacobian[i] / shape->k[i] : jens;
            const double x = sharpness * (target - value);
            const double grown = expm1(x);
            cluster->sum += grown - x;
            cluster->corner[cluster->corners++] =
                (tm_active_corner){(uint32_t)e, (uint32_t)i, jacobian[i], grown};
        }
        cluster->jens[e] = least;
    }
    return log1p(cluster->sum) / sharpness;
}

static void slope_of_missing(const tm_cluster *cluster, double (*slope)[3])
{
    memset(slope, 0, cluster->moving * sizeof *slope);
    for (size_t c = 0; c < cluster->corners; c++) {
        const tm_active_corner *corner = &cluster->corner[c];
        const size_t start = cluster->start[corner->element];
        const tm_element_shape *shape =
            &tm_element_shapes[cluster->start[corner->element + 1] - start];
        uint32_t node[4];
        for (size_t i = 0; i < 4; i++)
            node[i] = cluster->item[start + shape->corner[corner->corner][i]];
        double part[4][3];
        tm_scaled_jacobian_slope(cluster->xyz[node[0]], cluster->xyz[node[1]],
                                 cluster->xyz[node[2]], cluster->xyz[node[3]], part);
        const double k = shape->k[corner->corner];
        const double factor =
            -corner->weight / (1 + cluster->sum) * (corner->jacobian <= k ? 1 / k : -1);
        for (size_t i = 0; i < 4; i++)
            for (size_t j = 0; node[i] < cluster->moving && j < 3; j++)
                slope[node[i]][j] += factor * part[i][j];
    }
}

static void measure_jens(tm_cluster *cluster)
{
    for (size_t e = 0; e < cluster->elements; e++)
        cluster->jens[e] =
            tm_jens(cluster->start[e + 1] - cluster->start[e],
                    (const double(*)[3])cluster->xyz, cluster->item + cluster->start[e]);
}

double tm_cluster_value(tm_cluster *cluster, tm_objective objective)
{
    cluster->evaluations++;
    cluster->measured += cluster->elements;
    if (!objective.untangle)
        return value_of_missing(cluster, objective.number);
    measure_jens(cluster);
    return tm_untangle_value(cluster, objective.number);
}

void tm_cluster_slope(const tm_cluster *cluster, tm_objective objective,
                      double (*slope)[3])
{
    if (objective.untangle)
        memcpy(slope, cluster->pull, cluster->moving * sizeof *slope);
    else
        slope_of_missing(cluster, slope);
    for (size_t v = 0; v < cluster->moving; v++)
        tm_cluster_along(cluster, v, slope[v]);
}

tm_score tm_cluster_score(const tm_cluster *cluster)
{
    tm_score score = {.worst = INFINITY};
    for (size_t e = 0; e < cluster->elements; e++) {
        const double missing = cluster->jens[e] - cluster->threshold[e];
        score.bad += missing < 0;
        score.fresh += missing < 0 && cluster->before[e] >= cluster->threshold[e];
        score.inverted += cluster->jens[e] <= 0;
        score.worst = missing < score.worst ? missing : score.worst;
    }
    return score;
}

bool tm_score_better(const tm_score *score, const tm_score *than)
{
    if (score->fresh > 0 || score->inverted > than->inverted || score->bad > than->bad)
        return false;
    if (score->inverted < than->inverted || score->bad == 0)
        return score->bad < than->bad || score->inverted < than->inverted;
    if (score->bad < than->bad)
        return than->inverted > 0 || score->worst >= than->worst;
    return score->worst > than->worst;
}
