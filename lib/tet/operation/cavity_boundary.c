/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cavity_boundary.h"

#include "../../geom/predicates.h"

double tm_hull_quality(const tm_hull *hull, tm_tet_measure measure, const double p[3],
                       double least)
{
    double worst = HUGE_VAL;
    for (size_t i = 0; i < hull->count; i++) {
        const uint32_t *f = hull->face[i];
        double quality = tm_tet_measure_of(measure, hull->xyz[f[0]], hull->xyz[f[1]],
                                           hull->xyz[f[2]], p);
        if (quality < least)
            return 0;
        worst = quality < worst ? quality : worst;
    }
    return worst;
}

double tm_hull_cost(const tm_hull *hull, const tm_cost *cost, const double p[3],
                    double least, double most)
{
    double sum = 0;
    for (size_t i = 0; i < hull->count; i++) {
        const uint32_t *f = hull->face[i];
        double quality = tm_cost_quality(cost, least, hull->xyz[f[0]], hull->xyz[f[1]],
                                         hull->xyz[f[2]], p);
        if (quality < least)
            return HUGE_VAL;
        sum += tm_cost_of(cost, quality);
        if (!(sum < most))
            return HUGE_VAL;
    }
    return sum;
}

bool tm_hull_sees(const tm_hull *hull, const double p[3])
{
    for (size_t i = 0; i < hull->count; i++) {
        const uint32_t *f = hull->face[i];
        if (tm_orient3d(hull->xyz[f[0]], hull->xyz[f[1]], hull->xyz[f[2]], p) <= 0)
            return false;
    }
    return true;
}

void tm_hull_centre(const tm_hull *hull, double p[3])
{
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < hull->count; i++)
        for (int k = 0; k < 3; k++)
            for (int x = 0; x < 3; x++)
                sum[x] += hull->xyz[hull->face[i][k]][x];
    for (int x = 0; x < 3; x++)
        p[x] = sum[x] / (3 * (double)hull->count);
}
