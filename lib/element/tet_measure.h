/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The measure by which an improver compares tetrahedra. Values of one measure compare
 * like the quality that they stand for, and are 0 for what is flat or inverted:
 * sin² of the dihedral angle farthest from 90°, or the volume quality. Then: what is so
 * many times as good, what angles are not to be passed, and what a tetrahedron costs. */
#ifndef TM_ELEMENT_TET_MEASURE_H
#define TM_ELEMENT_TET_MEASURE_H

#include "../base/extern_c.h"
#include "tet_quality.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>

TM_EXTERN_C_BEGIN

typedef enum tm_tet_measure { TM_MEASURE_DIHEDRAL, TM_MEASURE_VOLUME } tm_tet_measure;

/* How good abcd is: tm_tet_sine2(), or tm_tet_volume_quality(), both from 0 to 1; 0 where
 * it is not right-hand positive. O(1). */
static inline double tm_tet_measure_of(tm_tet_measure measure, const double a[3],
                                       const double b[3], const double c[3],
                                       const double d[3])
{
    if (measure == TM_MEASURE_DIHEDRAL)
        return tm_tet_sine2(a, b, c, d);
    double quality = tm_tet_volume_quality(a, b, c, d);
    return quality > 0 ? quality : 0;
}

/* The value that is `factor` times as good as `value`: angles are compared in degrees.
 * Above every value that a tetrahedron has, if that is more than 90 degrees. O(1). */
double tm_tet_measure_times(tm_tet_measure measure, double value, double factor);

enum { TM_GAIN_CELLS = 64 };

/* A quick lower bound of tm_tet_measure_times() for one factor: most stars are refused,
 * and a bound is enough to say so, without an arc sine and a sine for each.
 *
 * With α the angle and m the factor, sin² mα is a concave function of sin² α up to
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
    double at = value * gain->cells_per_value;
    if (!(at >= 0 && at < TM_GAIN_CELLS - 1))
        return tm_gain_least(gain, value);
    int cell = (int)at;
    double from = gain->at[cell], to = gain->at[cell + 1];
    double bound = (from + (to - from) * (at - cell)) * rounding;
    return bound > DBL_MIN ? bound : DBL_MIN;
}

/* Limits of dihedral angles that an improver keeps. */
typedef struct tm_angle_limits {
    double least, most; /* degrees */
    double safe;        /* a tm_tet_sine2() from which on no angle is beyond */
} tm_angle_limits;

/* Limits that hold for no tetrahedron. */
tm_angle_limits tm_angle_limits_none(void);

/* Widens the limits so that they hold for abcd. */
void tm_angle_limits_include(tm_angle_limits *limits, const double a[3],
                             const double b[3], const double c[3], const double d[3]);

/* Widens the limits to degrees … 180 - degrees where they are narrower. */
void tm_angle_limits_widen(tm_angle_limits *limits, double degrees);

/* Narrows the limits to degrees … 180 - degrees where they are wider. */
void tm_angle_limits_narrow(tm_angle_limits *limits, double degrees);

/* Whether all dihedral angles of abcd, as tm_tet_dihedrals() has them, are within the
 * limits. Some 0.2 µs, so it is for what is not known to be safe. */
bool tm_angles_are_within(const tm_angle_limits *limits, const double a[3],
                          const double b[3], const double c[3], const double d[3]);

/* The same for abcd with that tm_tet_sine2(). */
static inline bool tm_angle_limits_hold(const tm_angle_limits *limits, double sine2,
                                        const double a[3], const double b[3],
                                        const double c[3], const double d[3])
{
    return sine2 >= limits->safe || tm_angles_are_within(limits, a, b, c, d);
}

/* What an improver pays for a tetrahedron, and what it never makes. */
typedef struct tm_cost {
    tm_tet_measure measure;
    double target;          /* by measure: what is as good costs nothing */
    double weight;          /* of how bad it is, beside 1 for being bad */
    double steep;           /* above 0: see tm_cost_of() */
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
 * 1 + weight for the worst. With `steep` the worst count most: what is `steep` times the
 * target costs half of the weight, and more than twice that costs little. */
static inline double tm_cost_of(const tm_cost *cost, double quality)
{
    if (quality >= cost->target)
        return 0;
    if (cost->steep > 0)
        return 1 +
               cost->weight * cost->steep / (cost->steep + sqrt(quality / cost->target));
    return 1 + cost->weight * (1 - sqrt(quality / cost->target));
}

TM_EXTERN_C_END

#endif
