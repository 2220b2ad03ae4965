/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_measure.h"

#include <math.h>

double tm_tet_measure_times(tm_tet_measure measure, double value, double factor)
{
    if (measure == TM_MEASURE_VOLUME)
        return value * factor;
    const double right_angle = acos(0);
    double angle = asin(sqrt(fmin(value, 1))) * factor;
    if (angle > right_angle)
        return HUGE_VAL;
    double sine = sin(angle);
    return sine * sine;
}
