/* SPDX-License-Identifier: GPL-3.0-or-later */
/* L-BFGS over the positions of a cluster's nodes (D. C. Liu and J. Nocedal, On the
 * limited memory BFGS method for large scale optimization, 1989), each measured in the
 * length of its edges, with steps along the boundary that end on it. */
#include "optimise_parts.h"

#include "../geom/vector.h"

#include <math.h>
#include <string.h>

enum { LINE_TRIALS = 8, SLOW_MOST = 3 };

/* A node goes no further than this in a step, times its size; the first step is such
 * that the fastest node goes as far as the second. */
static const double step_most = 0.3;
static const double step_first = 0.1;

static const double armijo = 1e-4;
static const double slow = 1e-3; /* the least relative gain worth a step */

typedef double vector3[3];

typedef struct descent {
    tm_cluster *cluster;
    tm_objective objective;
    size_t reals;  /* 3 * moving */
    double *slope; /* of the value, in sizes */
    double *old_slope;
    double *direction; /* in sizes */
    double *step[TM_DESCENT_MEMORY];
    double *change[TM_DESCENT_MEMORY];
    double inverse[TM_DESCENT_MEMORY]; /* 1 / (step · change) */
    size_t pairs;
} descent;

static double product(const double *a, const double *b, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += a[i] * b[i];
    return sum;
}

static void add_multiple(double *to, double factor, const double *of, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] += factor * of[i];
}

static descent start_descent(tm_cluster *cluster, tm_objective objective)
{
    descent d = {
        .cluster = cluster, .objective = objective, .reals = 3 * cluster->moving};
    double *next = cluster->vector;
    d.slope = next;
    d.old_slope = next += d.reals;
    d.direction = next += d.reals;
    for (size_t m = 0; m < TM_DESCENT_MEMORY; m++) {
        d.step[m] = next += d.reals;
        d.change[m] = next += d.reals;
    }
    return d;
}

static void find_slope(descent *d)
{
    tm_cluster_slope(d->cluster, d->objective, (vector3 *)d->slope);
    for (size_t v = 0; v < d->cluster->moving; v++)
        for (size_t i = 0; i < 3; i++)
            d->slope[3 * v + i] *= d->cluster->size[v];
}

static double fastest(const double *vector, size_t reals)
{
    double most2 = 0;
    for (size_t i = 0; i < reals; i += 3)
        most2 = fmax(most2, tm_norm2(vector + i));
    return sqrt(most2);
}

static void scale(double *vector, double factor, size_t reals)
{
    for (size_t i = 0; i < reals; i++)
        vector[i] *= factor;
}

/* direction = - (inverse Hessian, as remembered) slope; false at the minimum. */
static bool find_direction(descent *d)
{
    double alpha[TM_DESCENT_MEMORY];
    const size_t last = d->pairs;
    const size_t first = last > TM_DESCENT_MEMORY ? last - TM_DESCENT_MEMORY : 0;
    for (size_t i = 0; i < d->reals; i++)
        d->direction[i] = -d->slope[i];
    for (size_t p = last; p-- > first;) {
        const size_t m = p % TM_DESCENT_MEMORY;
        alpha[m] = d->inverse[m] * product(d->step[m], d->direction, d->reals);
        add_multiple(d->direction, -alpha[m], d->change[m], d->reals);
    }
    if (last > 0) {
        const size_t m = (last - 1) % TM_DESCENT_MEMORY;
        scale(d->direction,
              1 / (d->inverse[m] * product(d->change[m], d->change[m], d->reals)),
              d->reals);
    }
    for (size_t p = first; p < last; p++) {
        const size_t m = p % TM_DESCENT_MEMORY;
        const double beta = d->inverse[m] * product(d->change[m], d->direction, d->reals);
        add_multiple(d->direction, alpha[m] - beta, d->step[m], d->reals);
    }
    for (size_t v = 0; v < d->cluster->moving; v++)
        tm_cluster_along(d->cluster, v, d->direction + 3 * v);
    const double most = fastest(d->direction, d->reals);
    if (!(most > 0 && isfinite(most)))
        return false;
    const double limit = last == 0 ? step_first : step_most;
    if (last == 0 || most > limit)
        scale(d->direction, limit / most, d->reals);
    return true;
}

static void snapshot_best(tm_cluster *cluster)
{
    const tm_score score = tm_cluster_score(cluster);
    if (!tm_score_better(&score, &cluster->best_score))
        return;
    cluster->best_score = score;
    memcpy(cluster->best, cluster->xyz, cluster->moving * sizeof *cluster->best);
}

static void go(const descent *d, double length)
{
    tm_cluster *cluster = d->cluster;
    for (size_t v = 0; v < cluster->moving; v++) {
        const double *along = d->direction + 3 * v;
        if (tm_norm2(along) == 0)
            continue;
        double to[3];
        for (size_t i = 0; i < 3; i++)
            to[i] = cluster->old[v][i] + length * cluster->size[v] * along[i];
        tm_cluster_move(cluster, v, to);
    }
}

static void restore(tm_cluster *cluster)
{
    memcpy(cluster->xyz, cluster->old, cluster->moving * sizeof *cluster->old);
    memcpy(cluster->point, cluster->old_point, cluster->moving * sizeof *cluster->point);
}

/* Goes along the direction until the value has become enough smaller. */
static bool search_line(const descent *d, double *value)
{
    tm_cluster *cluster = d->cluster;
    const double rate = product(d->slope, d->direction, d->reals);
    if (!(rate < 0))
        return false;
    memcpy(cluster->old, cluster->xyz, cluster->moving * sizeof *cluster->old);
    memcpy(cluster->old_point, cluster->point, cluster->moving * sizeof *cluster->point);
    double length = 1;
    for (int trial = 0; trial < LINE_TRIALS; trial++) {
        go(d, length);
        const double now = tm_cluster_value(cluster, d->objective);
        if (now <= *value + armijo * length * rate) {
            *value = now;
            return true;
        }
        /* The minimum of the parabola through both values, but not too close. */
        const double curve = 2 * (now - *value - length * rate);
        length *= fmin(fmax(-rate * length / curve, 0.1), 0.5);
    }
    restore(cluster);
    return false;
}

static void remember(descent *d)
{
    tm_cluster *cluster = d->cluster;
    const size_t m = d->pairs % TM_DESCENT_MEMORY;
    for (size_t v = 0; v < cluster->moving; v++) {
        for (size_t i = 0; i < 3; i++) {
            const size_t j = 3 * v + i;
            d->step[m][j] = (cluster->xyz[v][i] - cluster->old[v][i]) / cluster->size[v];
            d->change[m][j] = d->slope[j] - d->old_slope[j];
        }
    }
    const double bend = product(d->step[m], d->change[m], d->reals);
    const double enough = 1e-10;
    if (bend > enough * product(d->step[m], d->step[m], d->reals)) {
        d->inverse[m] = 1 / bend;
        d->pairs++;
    }
}

double tm_cluster_descend(tm_cluster *cluster, tm_objective objective,
                          unsigned iterations)
{
    descent d = start_descent(cluster, objective);
    const double first = tm_cluster_value(cluster, objective);
    double value = first;
    snapshot_best(cluster);
    unsigned idle = 0;
    find_slope(&d);
    while (iterations-- > 0 && cluster->best_score.bad > 0 && idle < SLOW_MOST) {
        const double before = value;
        if (!find_direction(&d))
            break;
        if (!search_line(&d, &value)) {
            if (d.pairs == 0)
                break;
            d.pairs = 0; /* what was remembered has misled: steepest descent */
            tm_cluster_value(cluster, objective);
            continue;
        }
        snapshot_best(cluster);
        memcpy(d.old_slope, d.slope, d.reals * sizeof *d.slope);
        find_slope(&d);
        remember(&d);
        idle = before - value < slow * before ? idle + 1 : 0;
    }
    return first > 0 ? 1 - value / first : 0;
}
