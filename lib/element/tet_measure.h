/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The measure by which an improver compares tetrahedra. Values of one measure compare
 * like the quality that they stand for, and are 0 for what is flat or inverted:
 * sin² of the dihedral angle farthest from 90°, or the volume quality. */
#ifndef TM_ELEMENT_TET_MEASURE_H
#define TM_ELEMENT_TET_MEASURE_H

#include "tet_quality.h"

typedef enum tm_tet_measure { TM_MEASURE_DIHEDRAL, TM_MEASURE_VOLUME } tm_tet_measure;

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

#endif
