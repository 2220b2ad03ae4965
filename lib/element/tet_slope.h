/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How the quality of a tetrahedron changes when one of its corners moves. */
#ifndef TM_ELEMENT_TET_SLOPE_H
#define TM_ELEMENT_TET_SLOPE_H

#include "tet_measure.h"

#include <stddef.h>

/* A smooth function of the position of the corner, and its gradient. */
typedef struct tm_slope {
    double value;
    double gradient[3];
} tm_slope;

enum { TM_SLOPES = 6 };

/* The functions of p whose least is the quality of abcp, for positive abcp: by
 * TM_MEASURE_DIHEDRAL the sines of the six dihedral angles, by TM_MEASURE_VOLUME the
 * volume quality. They are negative where abcp is. Only those with a value below `limit`
 * are written. Returns how many; 0 too where a face is so nearly degenerate that there is
 * no gradient. Some 60 ns. */
size_t tm_tet_slopes(tm_tet_measure measure, const double a[3], const double b[3],
                     const double c[3], const double p[3], double limit,
                     tm_slope slope[TM_SLOPES]);

#endif
