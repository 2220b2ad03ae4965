/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "angle_limits.h"

#include <math.h>

static const double right_angle = 90, straight_angle = 180;

tm_angle_limits tm_angle_limits_none(void)
{
    return (tm_angle_limits){.least = straight_angle, .most = 0, .safe = HUGE_VAL};
}

static void find_safe(tm_angle_limits *limits)
{
    double acute = tm_bad_sine2(limits->least + TM_ANGLE_TOLERANCE);
    double obtuse = tm_bad_sine2(straight_angle - limits->most + TM_ANGLE_TOLERANCE);
    limits->safe = limits->most < right_angle ? HUGE_VAL : fmax(acute, obtuse);
}

void tm_angle_limits_include(tm_angle_limits *limits, const double a[3],
                             const double b[3], const double c[3], const double d[3])
{
    double angle[TM_TET_EDGES];
    if (tm_tet_sine2(a, b, c, d) > limits->safe)
        return;
    tm_tet_dihedrals(a, b, c, d, angle);
    for (int e = 0; e < TM_TET_EDGES; e++) {
        limits->least = fmin(limits->least, angle[e]);
        limits->most = fmax(limits->most, angle[e]);
    }
    find_safe(limits);
}

void tm_angle_limits_narrow(tm_angle_limits *limits, double degrees)
{
    limits->least = fmax(limits->least, degrees);
    limits->most = fmin(limits->most, straight_angle - degrees);
    find_safe(limits);
}

bool tm_angles_are_within(const tm_angle_limits *limits, const double a[3],
                          const double b[3], const double c[3], const double d[3])
{
    double angle[TM_TET_EDGES];
    tm_tet_dihedrals(a, b, c, d, angle);
    for (int e = 0; e < TM_TET_EDGES; e++)
        if (!(angle[e] >= limits->least && angle[e] <= limits->most))
            return false;
    return true;
}
