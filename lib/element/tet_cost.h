/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an improver pays for a tetrahedron, and what it never makes. */
#ifndef TM_ELEMENT_TET_COST_H
#define TM_ELEMENT_TET_COST_H

#include "angle_limits.h"
#include "tet_measure.h"

#include <math.h>
#include <stdbool.h>

typedef struct tm_cost {
    tm_tet_measure measure;
    double target;          /* by measure: what is as good costs nothing */
    double weight;          /* of how bad it is, beside 1 for being bad */
    tm_angle_limits limits; /* no angle may be beyond */
} tm_cost;

/* The measure of a tetrahedron; 0 where it is below `least` or an angle is beyond the
 * limits. */
static inline double tm_cost_quality(const tm_cost *cost, double least, const double a[3],
                                     const double b[3], const double c[3],
                                     const double d[3])
{
    double sine2 = tm_tet_sine2(a, b, c, d);
    double quality = cost->measure == TM_MEASURE_DIHEDRAL
                         ? sine2
                         : tm_tet_measure_of(cost->measure, a, b, c, d);
    if (quality < least || sine2 == 0)
        return 0;
    return tm_angle_limits_hold(&cost->limits, sine2, a, b, c, d) ? quality : 0;
}

/* What a tetrahedron of that quality costs: 0 from the target on, 1 just below, and
 * 1 + weight for the worst. */
static inline double tm_cost_of(const tm_cost *cost, double quality)
{
    if (quality >= cost->target)
        return 0;
    return 1 + cost->weight * (1 - sqrt(quality / cost->target));
}

#endif
