/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_gain.h"

#include <math.h>

tm_gain tm_gain_of(tm_tet_measure measure, double factor)
{
    tm_gain gain = {.measure = measure, .factor = factor};
    const double right_angle = acos(0);
    double sine = sin(right_angle / factor), most = sine * sine;
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
