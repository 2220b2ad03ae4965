/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Limits of dihedral angles that an improver keeps: the extreme ones of its input. */
#ifndef TM_ELEMENT_ANGLE_LIMITS_H
#define TM_ELEMENT_ANGLE_LIMITS_H

#include "tet_quality.h"

#include <stdbool.h>

typedef struct tm_angle_limits {
    double least, most; /* degrees */
    double safe;        /* a tm_tet_sine2() from which on no angle is beyond */
} tm_angle_limits;

/* Limits that hold for no tetrahedron. */
tm_angle_limits tm_angle_limits_none(void);

/* Widens the limits so that they hold for abcd. */
void tm_angle_limits_include(tm_angle_limits *limits, const double a[3],
                             const double b[3], const double c[3], const double d[3]);

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

#endif
