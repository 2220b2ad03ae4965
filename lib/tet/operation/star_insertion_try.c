/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a point may be inserted into a star, and how good that would be: the most
 * frequent question of all, so four tetrahedra are asked about at a time. */
#include "star_insertion.h"

#include "../../element/tet_four.h"

#ifdef TM_FOUR_IS_THERE

/* The tetrahedra a p r s and p b r s of two ring edges at a time. True only where all are
 * positive for certain; *quality then as tm_star_insertion_quality() says. */
TM_FOUR static bool try_four(const tm_tet_mesh *mesh, const tm_star *star,
                             const double p[3], double least, double *quality)
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    const tm_vector_four first = tm_four_in_turn(x[star->a], p);
    const tm_vector_four second = tm_four_in_turn(p, x[star->b]);
    tm_four worst = _mm256_set1_pd(HUGE_VAL);
    unsigned certain = TM_FOUR_ALL;
    for (size_t i = 0; i < star->size; i += 2) {
        size_t j = i + 1 < star->size ? i + 1 : i;
        const uint32_t *r = star->ring;
        const tm_vector_four third = tm_four_two(x[r[i]], x[r[j]]);
        const tm_vector_four fourth = tm_four_two(x[r[i + 1]], x[r[j + 1]]);
        const tm_four_measure m = tm_four_sine2(first, second, third, fourth);
        certain &= tm_four_positive(&m);
        worst = _mm256_min_pd(worst, m.sine2);
    }
    double of[4];
    _mm256_storeu_pd(of, worst);
    double of_all = tm_lesser(tm_lesser(of[0], of[1]), tm_lesser(of[2], of[3]));
    *quality = of_all < least ? 0 : of_all;
    return certain == TM_FOUR_ALL;
}

#endif

bool tm_star_try_insertion(const tm_tet_mesh *mesh, const tm_star *star,
                           const double p[3], tm_tet_measure measure, double least,
                           double *quality)
{
#ifdef TM_FOUR_IS_THERE
    if (measure == TM_MEASURE_DIHEDRAL && tm_has_four() &&
        try_four(mesh, star, p, least, quality))
        return true;
#endif
    *quality = 0;
    if (!tm_star_sees(mesh, star, p))
        return false;
    *quality = tm_star_insertion_quality(mesh, star, p, measure, least);
    return true;
}
