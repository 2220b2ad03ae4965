/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tm_tet_sine2() of four tetrahedra at a time, bit for bit the same: what tet_quality.h
 * does for two edges is done here for four tetrahedra, in a vector of four doubles. For
 * machines with AVX2, of which a program learns at run time: what includes this header
 * has another way, and tm_has_four() chooses; made with
 * CFLAGS=-DTM_NO_FOUR there is no choice.
 *
 * Fused operations would round otherwise; TM_FOUR does not allow them. */
#ifndef TM_ELEMENT_TET_FOUR_H
#define TM_ELEMENT_TET_FOUR_H

#include "tet_quality.h"

#include <stdbool.h>
#include <stdint.h>

#if defined __x86_64__ && defined __GNUC__ && !defined TM_NO_FOUR
#define TM_FOUR_IS_THERE 1

#include <immintrin.h>

/* For functions that work on fours. */
#define TM_FOUR __attribute__((target("avx2")))

static inline bool tm_has_four(void)
{
    return __builtin_cpu_supports("avx2");
}

typedef __m256d tm_four;

typedef struct tm_vector_four {
    tm_four x, y, z;
} tm_vector_four;

/* Four tetrahedra. Where a measure is not valid tm_tet_sine2() has to be asked. */
typedef struct tm_four_measure {
    tm_four sine2;
    tm_four determinant; /* 6 V */
    tm_four valid;       /* bits all set, or none */
    tm_four length2[6];  /* of the edges ab ac ad bc bd cd */
} tm_four_measure;

/* Twice p, then twice q. */
TM_FOUR static inline tm_vector_four tm_four_two(const double p[3], const double q[3])
{
    return (tm_vector_four){_mm256_setr_pd(p[0], p[0], q[0], q[0]),
                            _mm256_setr_pd(p[1], p[1], q[1], q[1]),
                            _mm256_setr_pd(p[2], p[2], q[2], q[2])};
}

/* p and q in turn. */
TM_FOUR static inline tm_vector_four tm_four_in_turn(const double p[3], const double q[3])
{
    return (tm_vector_four){_mm256_setr_pd(p[0], q[0], p[0], q[0]),
                            _mm256_setr_pd(p[1], q[1], p[1], q[1]),
                            _mm256_setr_pd(p[2], q[2], p[2], q[2])};
}

/* Four points. */
TM_FOUR static inline tm_vector_four tm_four_points(const double p[3], const double q[3],
                                                    const double r[3], const double s[3])
{
    __m128d pq = _mm_unpacklo_pd(_mm_load_sd(p + 2), _mm_load_sd(q + 2));
    __m128d rs = _mm_unpacklo_pd(_mm_load_sd(r + 2), _mm_load_sd(s + 2));
    tm_four pr = _mm256_set_m128d(_mm_loadu_pd(r), _mm_loadu_pd(p));
    tm_four qs = _mm256_set_m128d(_mm_loadu_pd(s), _mm_loadu_pd(q));
    return (tm_vector_four){_mm256_unpacklo_pd(pr, qs), _mm256_unpackhi_pd(pr, qs),
                            _mm256_set_m128d(rs, pq)};
}

TM_FOUR static inline tm_vector_four tm_four_edge(tm_vector_four from, tm_vector_four to)
{
    return (tm_vector_four){to.x - from.x, to.y - from.y, to.z - from.z};
}

TM_FOUR static inline tm_vector_four tm_four_cross(tm_vector_four p, tm_vector_four q)
{
    return (tm_vector_four){p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z,
                            p.x * q.y - p.y * q.x};
}

TM_FOUR static inline tm_four tm_four_dot(tm_vector_four p, tm_vector_four q)
{
    return p.x * q.x + p.y * q.y + p.z * q.z;
}

/* See tm_tet_sine2_measure() for what is computed. */
TM_FOUR static inline tm_four_measure tm_four_sine2(tm_vector_four a, tm_vector_four b,
                                                    tm_vector_four c, tm_vector_four d)
{
    const tm_vector_four ab = tm_four_edge(a, b), cd = tm_four_edge(c, d);
    const tm_vector_four ac = tm_four_edge(a, c), bd = tm_four_edge(b, d);
    const tm_vector_four ad = tm_four_edge(a, d), bc = tm_four_edge(b, c);
    const tm_vector_four normal_d = tm_four_cross(ab, ac),
                         normal_a = tm_four_cross(cd, bd);
    const tm_vector_four normal_c = tm_four_cross(ab, bd),
                         normal_b = tm_four_cross(cd, ac);
    const tm_four face_d = tm_four_dot(normal_d, normal_d);
    const tm_four face_a = tm_four_dot(normal_a, normal_a);
    const tm_four face_c = tm_four_dot(normal_c, normal_c);
    const tm_four face_b = tm_four_dot(normal_b, normal_b);

    tm_four_measure m;
    m.length2[0] = tm_four_dot(ab, ab);
    m.length2[1] = tm_four_dot(ac, ac);
    m.length2[2] = tm_four_dot(ad, ad);
    m.length2[3] = tm_four_dot(bc, bc);
    m.length2[4] = tm_four_dot(bd, bd);
    m.length2[5] = tm_four_dot(cd, cd);
    const tm_four faces_ab = face_a * face_b, faces_cd = face_d * face_c;
    const tm_four at_ab = m.length2[0] * faces_ab, at_cd = m.length2[5] * faces_cd;
    const tm_four at_ac = m.length2[1] * (face_a * face_c);
    const tm_four at_bd = m.length2[4] * (face_d * face_b);
    const tm_four at_ad = m.length2[2] * (face_d * face_a);
    const tm_four at_bc = m.length2[3] * (face_c * face_b);
    /* The machine's minimum is a < b ? a : b, as tm_lesser() is. */
    const tm_four least_0 = _mm256_min_pd(_mm256_min_pd(at_ab, at_ac), at_ad);
    const tm_four least_1 = _mm256_min_pd(_mm256_min_pd(at_cd, at_bd), at_bc);
    const tm_four least = _mm256_min_pd(least_0, least_1);

    const tm_four low = _mm256_set1_pd(TM_SINE2_LOW),
                  high = _mm256_set1_pd(TM_SINE2_HIGH);
    m.valid = _mm256_and_pd(_mm256_cmp_pd(low, least, _CMP_LT_OQ),
                            _mm256_cmp_pd(least, high, _CMP_LT_OQ));
    m.determinant = tm_four_dot(normal_d, ad);
    const tm_four positive =
        _mm256_cmp_pd(m.determinant, _mm256_setzero_pd(), _CMP_GT_OQ);
    const tm_four sine2 = (m.determinant / faces_ab) * (m.determinant / faces_cd) * least;
    m.sine2 = _mm256_and_pd(sine2, _mm256_and_pd(m.valid, positive));
    return m;
}

/* Bit i is the mask of tetrahedron i. */
enum { TM_FOUR_ALL = 15 };

TM_FOUR static inline unsigned tm_four_bits(tm_four mask)
{
    return (unsigned)_mm256_movemask_pd(mask);
}

/* Bit i: tetrahedron i is positive for certain, as tm_orient3d() would say by the same
 * error bound. The permanent of the three edges at a corner is at most √3 times the
 * product of their lengths: by Cauchy and Schwarz, twice. 3 (7ε)² is 1.9e-30; the rest is
 * for rounding. Underflow adds less than 1e-160, as no length² is above 1e308, so it is
 * nothing beside the root of `small`. */
TM_FOUR static inline unsigned tm_four_positive(const tm_four_measure *m)
{
    const tm_four relative_error2 = _mm256_set1_pd(4e-30), small = _mm256_set1_pd(1e-250);
    const tm_four bound2 =
        relative_error2 * (m->length2[0] * m->length2[1] * m->length2[2]);
    const tm_four zero = _mm256_setzero_pd();
    const tm_four beyond =
        _mm256_cmp_pd(m->determinant * m->determinant, bound2, _CMP_GT_OQ);
    const tm_four sane = _mm256_cmp_pd(bound2, small, _CMP_GT_OQ);
    const tm_four above = _mm256_cmp_pd(m->determinant, zero, _CMP_GT_OQ);
    return tm_four_bits(
        _mm256_and_pd(_mm256_and_pd(beyond, sane), _mm256_and_pd(above, m->valid)));
}

#else

static inline bool tm_has_four(void)
{
    return false;
}

#endif
#endif
