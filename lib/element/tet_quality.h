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

#include "../base/extern_c.h"
#include "shape.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

#define TM_ANGLE_TOLERANCE          1e-7 /* degrees */
#define TM_VOLUME_QUALITY_TOLERANCE 1e-9

/* min(α_min, 180° - α_max) of a tetrahedron with that tm_tet_sine2(). */
double tm_sine2_to_degrees(double sine2);

/* What tm_tet_sine2() of a tetrahedron is below if it is bad for that limit, 0 … 90
 * degrees. */
double tm_bad_sine2(double degrees);

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

/* tm_tet_sine2(): what an improver's loop needs, without trigonometry, without a square
 * root, with two divisions.
 *
 * At an edge of length l between faces whose normals n_i, n_j are twice as long as the
 * faces are large, sin α = D l / (|n_i| |n_j|) with D = 6 V. Let F_v = |n_v|² of the face
 * opposite to corner v. Then sin² at the edge vw, whose faces are those opposite to the
 * other two corners, is D² l² F_v F_w / (F_a F_b F_c F_d): the least l² F_v F_w is looked
 * for, and divided once.
 *
 * Two edges or two faces are computed at a time, in both halves of a 16-byte vector (an
 * extension that GCC and Clang have on every machine). Both halves do what scalar code
 * would, so results do not depend on the machine. */

/* Products of lengths and areas outside of these are not trusted. */
#define TM_SINE2_LOW  1e-250
#define TM_SINE2_HIGH 1e250

typedef double tm_pair __attribute__((vector_size(2 * sizeof(double))));

typedef struct tm_vector_pair {
    tm_pair x, y, z;
} tm_vector_pair;

/* (b - a, d - c) */
static inline tm_vector_pair tm_pair_edges(const double a[3], const double b[3],
                                           const double c[3], const double d[3])
{
    const tm_vector_pair from = {{a[0], c[0]}, {a[1], c[1]}, {a[2], c[2]}};
    const tm_vector_pair to = {{b[0], d[0]}, {b[1], d[1]}, {b[2], d[2]}};
    const tm_vector_pair edges = {to.x - from.x, to.y - from.y, to.z - from.z};
    return edges;
}

static inline tm_pair tm_pair_swap(tm_pair p)
{
    const tm_pair swapped = {p[1], p[0]};
    return swapped;
}

static inline tm_vector_pair tm_pair_cross(tm_vector_pair p, tm_vector_pair q)
{
    const tm_vector_pair cross = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z,
                                  p.x * q.y - p.y * q.x};
    return cross;
}

static inline tm_pair tm_pair_norm2(tm_vector_pair p)
{
    return p.x * p.x + p.y * p.y + p.z * p.z;
}

static inline double tm_lesser(double a, double b)
{
    return a < b ? a : b;
}

/* tm_tet_sine2(); 0 with *measured false where products leave the range of double. */
static inline double tm_tet_sine2_measure(const double a[3], const double b[3],
                                          const double c[3], const double d[3],
                                          bool *measured)
{
    const tm_vector_pair ab_cd = tm_pair_edges(a, b, c, d);
    const tm_vector_pair ac_bd = tm_pair_edges(a, c, b, d);
    const tm_vector_pair ad_bc = tm_pair_edges(a, d, b, c);
    const tm_vector_pair bd_ac = {tm_pair_swap(ac_bd.x), tm_pair_swap(ac_bd.y),
                                  tm_pair_swap(ac_bd.z)};

    /* ab × ac and cd × bd; ab × bd and cd × ac */
    const tm_vector_pair normal_d_a = tm_pair_cross(ab_cd, ac_bd);
    const tm_vector_pair normal_c_b = tm_pair_cross(ab_cd, bd_ac);
    const tm_pair face_d_a = tm_pair_norm2(normal_d_a);
    const tm_pair face_c_b = tm_pair_norm2(normal_c_b);

    const tm_pair faces_ab_cd = tm_pair_swap(face_d_a * face_c_b);
    const tm_pair faces_ac_bd = tm_pair_swap(face_d_a * tm_pair_swap(face_c_b));
    const tm_pair faces_ad_bc = {face_d_a[0] * face_d_a[1], face_c_b[0] * face_c_b[1]};
    const tm_pair at_ab_cd = tm_pair_norm2(ab_cd) * faces_ab_cd;
    const tm_pair at_ac_bd = tm_pair_norm2(ac_bd) * faces_ac_bd;
    const tm_pair at_ad_bc = tm_pair_norm2(ad_bc) * faces_ad_bc;
    const double least_0 = tm_lesser(tm_lesser(at_ab_cd[0], at_ac_bd[0]), at_ad_bc[0]);
    const double least_1 = tm_lesser(tm_lesser(at_ab_cd[1], at_ac_bd[1]), at_ad_bc[1]);
    const double least = tm_lesser(least_0, least_1);

    *measured = TM_SINE2_LOW < least && least < TM_SINE2_HIGH;
    const double determinant = normal_d_a.x[0] * ad_bc.x[0] +
                               normal_d_a.y[0] * ad_bc.y[0] +
                               normal_d_a.z[0] * ad_bc.z[0];
    return *measured && determinant > 0
               ? (determinant / faces_ab_cd[0]) * (determinant / faces_ab_cd[1]) * least
               : 0;
}

/* The measure of the copy of abcd that has size 1, for where it cannot be measured
 * itself: sides below 1e-25 or above 1e25, or needles nearly as extreme. */
double tm_tet_sine2_scaled(const double a[3], const double b[3], const double c[3],
                           const double d[3]);

/* The least sin² of the six dihedral angles; 0 where abcd is flat or negative (d not on
 * the side that (b-a) × (c-a) points to). It grows with min(α_min, 180° - α_max), which
 * tm_sine2_to_degrees() makes of it. Some 13 ns. */
static inline double tm_tet_sine2(const double a[3], const double b[3], const double c[3],
                                  const double d[3])
{
    bool measured;
    const double sine2 = tm_tet_sine2_measure(a, b, c, d, &measured);
    return measured ? sine2 : tm_tet_sine2_scaled(a, b, c, d);
}

/* Makes a tetrahedron right-hand positive: exchanges its last two nodes where it is
 * negative, exactly. Returns the sign that it had. */
int tm_tet_turn(const double (*xyz)[3], uint32_t node[4]);

TM_EXTERN_C_END

#endif
