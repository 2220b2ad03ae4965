/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_measure.h"

#include <math.h>

static const double right_angle = 90, straight_angle = 180; /* degrees */

double tm_tet_measure_times(tm_tet_measure measure, double value, double factor)
{
    if (measure == TM_MEASURE_VOLUME)
        return value * factor;
    const double quarter_turn = acos(0);
    double angle = asin(sqrt(fmin(value, 1))) * factor;
    if (angle > quarter_turn)
        return HUGE_VAL;
    double sine = sin(angle);
    return sine * sine;
}

tm_gain tm_gain_of(tm_tet_measure measure, double factor)
{
    tm_gain gain = {.measure = measure, .factor = factor};
    const double quarter_turn = acos(0);
    double sine = sin(quarter_turn / factor), most = sine * sine;
    gain.cells_per_value =
        measure == TM_MEASURE_DIHEDRAL ? TM_GAIN_CELLS / most : HUGE_VAL;
    /* The last cell is not used: its end may be rounded beyond 90°. */
    for (int i = 0; i < TM_GAIN_CELLS; i++)
        gain.at[i] = tm_tet_measure_times(measure, i * (most / TM_GAIN_CELLS), factor);
    return gain;
}

double tm_gain_least(const tm_gain *gain, double value)
{
    double times = tm_tet_measure_times(gain->measure, value, gain->factor);
    return times > 0 ? nextafter(times, HUGE_VAL) : DBL_MIN;
}

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

void tm_angle_limits_widen(tm_angle_limits *limits, double degrees)
{
    limits->least = fmin(limits->least, degrees);
    limits->most = fmax(limits->most, straight_angle - degrees);
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
