/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A quick lower bound of tm_tet_measure_times() for one factor: most stars are refused,
 * and a bound is enough to say so, without an arc sine and a sine for each. */
#ifndef TM_ELEMENT_TET_GAIN_H
#define TM_ELEMENT_TET_GAIN_H

#include "tet_measure.h"

#include <float.h>

enum { TM_GAIN_CELLS = 64 };

/* With α the angle and m the factor, sin² mα is a concave function of sin² α up to
 * mα = 90°: its slope is m sin 2mα / sin 2α, which falls. So chords are below it. */
typedef struct tm_gain {
    tm_tet_measure measure;
    double factor;
    double cells_per_value;
    double at[TM_GAIN_CELLS + 1]; /* of the values i / cells_per_value */
} tm_gain;

/* factor >= 1 */
tm_gain tm_gain_of(tm_tet_measure measure, double factor);

/* What replaces the value has to be at least so good, exactly: more than `factor` times
 * as good, and above 0. HUGE_VAL where nothing is. */
double tm_gain_least(const tm_gain *gain, double value);

/* Not above that, and above 0; or it itself. */
static inline double tm_gain_bound(const tm_gain *gain, double value)
{
    const double rounding = 1 - 1e-9;
    double place = value * gain->cells_per_value;
    if (!(place >= 0 && place < TM_GAIN_CELLS - 1))
        return tm_gain_least(gain, value);
    int cell = (int)place;
    double from = gain->at[cell], to = gain->at[cell + 1];
    double bound = (from + (to - from) * (place - cell)) * rounding;
    return bound > DBL_MIN ? bound : DBL_MIN;
}

#endif
