/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fit_parts.h"

#include <math.h>

/* A value that is to be above a limit, and by a margin more for safety. */
static void ask(tm_fit_sum *sum, tm_fit_fault fault, double value, double limit,
                double margin)
{
    if (value < limit + margin)
        sum->missing += limit + margin - value;
    sum->count[fault] += !(value > limit);
}

/* The sine of the angle at which a line from a cell's centroid to a point of a facet
 * meets the facet; below 0 where it comes from the other side. */
static double sine(const tm_poly_centroids *m, size_t f, int s, const double point[3])
{
    double to[3];
    tm_subtract(to, point, m->cell[m->mesh->side[f][s]].centre);
    const double lengths = tm_norm(to) * tm_norm(m->face[f].area);
    return lengths > 0 ? (s == 0 ? 1 : -1) * tm_dot(m->face[f].area, to) / lengths : 0;
}

static double least_sine(const tm_poly_centroids *m, size_t f, int s)
{
    double least = 1;
    for (size_t i = 0; i < tm_facet_corners(m->mesh, f); i++)
        least = fmin(least, sine(m, f, s, tm_facet_corner(m->mesh, f, i)));
    return least;
}

static double cosine_of_line(const tm_poly_centroids *m, size_t f)
{
    double d[3];
    tm_subtract(d, m->cell[m->mesh->side[f][1]].centre,
                m->cell[m->mesh->side[f][0]].centre);
    const double lengths = tm_norm(d) * tm_norm(m->face[f].area);
    return lengths > 0 ? tm_dot(d, m->face[f].area) / lengths : 0;
}

void tm_fit_judge_facet(const tm_poly_centroids *m, size_t f, tm_fit_sum *sum)
{
    const double sight = 0.002, margin = 0.01;
    double least = tm_facet_fan(m, f, sight);
    for (int s = 0; s < 2; s++) {
        if (m->mesh->side[f][s] == TM_NONE)
            continue;
        least = fmin(least, tm_facet_sight(m, f, s));
        ask(sum, TM_FIT_PYRAMID, sine(m, f, s, m->face[f].centre), 0, margin);
        ask(sum, TM_FIT_BENT, least_sine(m, f, s), 0, margin);
    }
    ask(sum, TM_FIT_TETRAHEDRA, least, 0, sight);
    ask(sum, TM_FIT_SKEW, 1 - tm_facet_skewness(m, f) / TM_FV_SKEWNESS, 0, 10 * margin);
    if (m->mesh->side[f][1] == TM_NONE)
        return;
    ask(sum, TM_FIT_OBLIQUE, cosine_of_line(m, f), TM_FV_COSINE, margin);
    ask(sum, TM_FIT_UNEVEN, tm_facet_weight(m, f), TM_FV_WEIGHT, margin);
    ask(sum, TM_FIT_UNEQUAL, tm_facet_volume_ratio(m, f), TM_FV_VOLUME_RATIO, margin / 2);
}

void tm_fit_judge_cell(const tm_poly_centroids *m, size_t c, tm_fit_sum *sum)
{
    const double plane = 1e-4;
    const tm_poly_arrays *mesh = m->mesh;
    const size_t begin = mesh->cell_start[c], end = mesh->cell_start[c + 1];
    tm_fit_sum pairs = {{0}, 0};
    ask(sum, TM_FIT_UNDETERMINED, tm_cell_determinant(m, c), TM_FV_DETERMINANT,
        TM_FV_DETERMINANT);
    for (size_t i = begin; i < end; i++)
        for (size_t j = begin; j < end; j++)
            if (i != j)
                ask(&pairs, TM_FIT_CONCAVE,
                    -tm_facet_beyond(m, mesh->cell_facet[i], mesh->cell_facet[j], c),
                    TM_FV_PLANE, plane);
    sum->missing += pairs.missing;
    sum->count[TM_FIT_CONCAVE] += pairs.count[TM_FIT_CONCAVE] > 0;
}
