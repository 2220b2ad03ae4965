/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quality of one tetrahedron abcd: its dihedral angles and its volume. Angles are in
 * degrees, except in the improver's loop, which compares squared sines.
 *
 * The tolerance, for all tools alike: angles of exactly 30° and 90° occur in made meshes,
 * and the rounding of an angle's last digits must not decide. So an angle α is "below L"
 * only if α < L - TM_ANGLE_TOLERANCE, "above L" only if α > L + TM_ANGLE_TOLERANCE, and
 * counts as not smaller than L, for the bins of a histogram, otherwise. A tetrahedron is
 * bad for the limit L if one of its angles is below L or above 180° - L, which is
 * tm_tet_sine2() < tm_bad_sine2(L). Volume quality has its own tolerance, used in the
 * same way. */
#ifndef TM_ELEMENT_TET_QUALITY_H
#define TM_ELEMENT_TET_QUALITY_H

#include "tet_sine2.h"

#include <stdbool.h>

#define TM_ANGLE_TOLERANCE          1e-7 /* degrees */
#define TM_VOLUME_QUALITY_TOLERANCE 1e-9

enum { TM_TET_EDGES = 6 };

/* The corners of each of the six edges, in the order of tm_tet_dihedrals(). */
extern const unsigned char tm_tet_edge_corner[TM_TET_EDGES][2];

/* min(α_min, 180° - α_max) of a tetrahedron with that tm_tet_sine2(). */
double tm_sine2_to_degrees(double sine2);

/* What tm_tet_sine2() of a tetrahedron is below if it is bad for that limit, 0 … 90
 * degrees. */
double tm_bad_sine2(double degrees);

static inline bool tm_angle_below(double angle, double limit)
{
    return angle < limit - TM_ANGLE_TOLERANCE;
}

static inline bool tm_angle_above(double angle, double limit)
{
    return angle > limit + TM_ANGLE_TOLERANCE;
}

/* The dihedral angles at the edges ab, ac, ad, bc, bd, cd, in degrees, whatever the
 * orientation; 0 or 180 in a flat tetrahedron, 0 at a face without area. By atan2 of sine
 * and cosine, so that angles near 0, 90 and 180 are as good as others: as good as the
 * rounded normals of the two faces are. */
void tm_tet_dihedrals(const double a[3], const double b[3], const double c[3],
                      const double d[3], double degrees[TM_TET_EDGES]);

/* 6√2 V / l_max³: 1 for the regular tetrahedron, 0 for flat ones and for a point,
 * negative for negative orientation. */
double tm_tet_volume_quality(const double a[3], const double b[3], const double c[3],
                             const double d[3]);

#endif
