/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cavity_boundary.h"

#include "../../geom/predicates.h"

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
