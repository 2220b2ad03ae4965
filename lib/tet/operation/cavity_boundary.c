/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cavity_boundary.h"

#include "../../element/tet_slope.h"
#include "../../geom/predicates.h"
#include "../../geom/vector.h"
#include "shortest_vector.h"

#include <string.h>

double tm_cavity_boundary_quality(const tm_cavity_boundary *boundary,
                                  tm_tet_measure measure, const double p[3], double least)
{
    double worst = HUGE_VAL;
    for (size_t i = 0; i < boundary->count; i++) {
        const uint32_t *f = boundary->face[i];
        double quality = tm_tet_measure_of(measure, boundary->xyz[f[0]],
                                           boundary->xyz[f[1]], boundary->xyz[f[2]], p);
        if (quality < least)
            return 0;
        worst = quality < worst ? quality : worst;
    }
    return worst;
}

double tm_cavity_boundary_cost(const tm_cavity_boundary *boundary, const tm_cost *cost,
                               const double p[3], double least, double most)
{
    double sum = 0;
    for (size_t i = 0; i < boundary->count; i++) {
        const uint32_t *f = boundary->face[i];
        double quality = tm_cost_quality(cost, least, boundary->xyz[f[0]],
                                         boundary->xyz[f[1]], boundary->xyz[f[2]], p);
        if (quality < least)
            return HUGE_VAL;
        sum += tm_cost_of(cost, quality);
        if (!(sum < most))
            return HUGE_VAL;
    }
    return sum;
}

bool tm_cavity_boundary_sees(const tm_cavity_boundary *boundary, const double p[3])
{
    for (size_t i = 0; i < boundary->count; i++) {
        const uint32_t *f = boundary->face[i];
        if (tm_orient3d(boundary->xyz[f[0]], boundary->xyz[f[1]], boundary->xyz[f[2]],
                        p) <= 0)
            return false;
    }
    return true;
}

void tm_cavity_boundary_centre(const tm_cavity_boundary *boundary, double p[3])
{
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < boundary->count; i++)
        for (int k = 0; k < 3; k++)
            for (int x = 0; x < 3; x++)
                sum[x] += boundary->xyz[boundary->face[i][k]][x];
    for (int x = 0; x < 3; x++)
        p[x] = sum[x] / (3 * (double)boundary->count);
}

enum { SLOPES_MAX = 192 };

/* Slopes are looked at that are so far above the worst, and are active if they are so
 * near to it. A step has to gain this part of the quality. */
static const double window = 0.1, active_window = 0.02, least_gain = 1e-2;

void tm_freedom_restrict(const tm_freedom *freedom, double vector[3])
{
    const double *d = freedom->direction;
    if (freedom->dimension == 3)
        return;
    double along = tm_dot(vector, d);
    for (int x = 0; x < 3; x++)
        vector[x] = freedom->dimension == 1 ? along * d[x] : vector[x] - along * d[x];
}

/* The slopes at p that are below the limit; *worst is the least. */
static size_t collect(const tm_cavity_boundary *boundary, tm_tet_measure measure,
                      const tm_freedom *freedom, const double p[3], double limit,
                      tm_slope *slope, double *worst)
{
    size_t count = 0;
    *worst = HUGE_VAL;
    for (size_t i = 0; i < boundary->count && count + TM_SLOPES <= SLOPES_MAX; i++) {
        const uint32_t *f = boundary->face[i];
        count += tm_tet_slopes(measure, boundary->xyz[f[0]], boundary->xyz[f[1]],
                               boundary->xyz[f[2]], p, limit, slope + count);
    }
    for (size_t k = 0; k < count; k++) {
        tm_freedom_restrict(freedom, slope[k].gradient);
        *worst = slope[k].value < *worst ? slope[k].value : *worst;
    }
    return count;
}

/* How far along d the worst of the slopes rises, if each goes on as it begins. */
static double step_length(const tm_slope *slope, size_t count, double worst,
                          const double d[3])
{
    const double slow = 1e-3;
    double rise = tm_norm2(d), step = window / rise;
    for (size_t k = 0; k < count; k++) {
        double slower = rise - tm_dot(slope[k].gradient, d);
        if (slower <= slow * rise || slope[k].value <= worst)
            continue;
        double meets = (slope[k].value - worst) / slower;
        step = meets < step ? meets : step;
    }
    return step;
}

/* The direction in which all active slopes rise most, and how far it is worth going;
 * false where there is none. */
static bool find_step(const tm_cavity_boundary *boundary, tm_tet_measure measure,
                      const tm_freedom *freedom, const double p[3], double limit,
                      double d[3], double *step)
{
    const double flat = 1e-6;
    tm_slope slope[SLOPES_MAX];
    const double *active[SLOPES_MAX];
    double worst;
    size_t actives = 0;
    size_t count = collect(boundary, measure, freedom, p, limit, slope, &worst);
    for (size_t k = 0; k < count; k++)
        if (slope[k].value <= worst + active_window)
            active[actives++] = slope[k].gradient;
    if (actives == 0)
        return false;
    tm_shortest_vector(active, actives, d);
    double size2 = tm_distance2(p, boundary->xyz[boundary->face[0][0]]);
    if (!(tm_norm2(d) * size2 > flat))
        return false;
    *step = step_length(slope, count, worst, d);
    return true;
}

void tm_cavity_boundary_climb(const tm_cavity_boundary *boundary, tm_tet_measure measure,
                              const tm_freedom *freedom, double enough, int steps,
                              double p[3])
{
    enum { HALVINGS = 4 };
    double quality = tm_cavity_boundary_quality(boundary, measure, p, 0), d[3], q[3],
           step;
    for (int s = 0; s < steps && quality < enough && freedom->dimension > 0; s++) {
        double value = measure == TM_MEASURE_DIHEDRAL ? sqrt(quality) : quality;
        double there = 0;
        if (!find_step(boundary, measure, freedom, p, value + window, d, &step))
            return;
        for (int i = 0; i < HALVINGS && there == 0; i++, step /= 2) {
            for (int x = 0; x < 3; x++)
                q[x] = p[x] + step * d[x];
            there = tm_cavity_boundary_quality(boundary, measure, q,
                                               quality * (1 + least_gain));
        }
        if (there == 0)
            return;
        memcpy(p, q, sizeof q);
        quality = there;
    }
}
