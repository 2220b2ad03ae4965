/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fit_parts.h"

#include <math.h>
#include <string.h>

/* Where measures are good, and where they are bad: a little before checkMesh complains.
 */
typedef struct {
    double good, bad, limit;
} scale;

static const scale scales[TM_FIT_FAULTS] = {
    [TM_FIT_PYRAMID] = {0.25, 0.01, 0},
    [TM_FIT_TETRAHEDRA] = {0.01, 0.0005, 0},
    [TM_FIT_CONCAVE] = {0.02, 0.0005, TM_FV_PLANE},
    [TM_FIT_OBLIQUE] = {0.48, 0.35, TM_FV_COSINE},
    [TM_FIT_SKEW] = {-2, -3.8, -TM_FV_SKEWNESS},
    [TM_FIT_UNEVEN] = {0.12, 0.055, TM_FV_WEIGHT},
    [TM_FIT_UNEQUAL] = {0.02, 0.0105, TM_FV_VOLUME_RATIO},
    [TM_FIT_UNDETERMINED] = {0.01, 0.0011, TM_FV_DETERMINANT}};

/* No more than so much, which is also what NaN is. */
static inline double scaled(tm_fit_fault fault, double value)
{
    const double most = 1000;
    const double x =
        (value - scales[fault].good) / (scales[fault].bad - scales[fault].good);
    return x < most ? x : most;
}

/* What a measure that is x is short of being good: most where it is bad. */
static inline double short_by(double x, double heavy)
{
    return x > 0 ? x * x + (x > TM_FIT_BAD ? heavy * (x - TM_FIT_BAD) : 0) : 0;
}

static inline void ask(tm_fit_verdict *v, tm_fit_fault fault, double value)
{
    const double heavy = 30;
    const double x = scaled(fault, value);
    if (!(value > scales[fault].limit))
        v->faults |= 1u << fault;
    if (!(x <= (double)v->worst))
        v->worst = (float)x;
    v->missing += short_by(x, heavy);
}

/* The sine of the angle at which the line from a cell's centroid to that of a facet meets
 * the facet; below 0 where it comes from the other side. */
static double sine(const tm_poly_centroids *m, size_t f, int s)
{
    double to[3];
    tm_subtract(to, m->face[f].centre, m->cell[m->mesh->side[f][s]].centre);
    const double lengths = tm_norm(to) * m->face[f].size;
    return lengths > 0 ? (s == 0 ? 1 : -1) * tm_dot(m->face[f].area, to) / lengths : 0;
}

static double cosine_of_line(const tm_poly_centroids *m, size_t f)
{
    double d[3];
    tm_subtract(d, m->cell[m->mesh->side[f][1]].centre,
                m->cell[m->mesh->side[f][0]].centre);
    const double lengths = tm_norm(d) * m->face[f].size;
    return lengths > 0 ? tm_dot(d, m->face[f].area) / lengths : 0;
}

/* What takes longer to find is asked later. */
tm_fit_verdict tm_fit_judge_facet(const tm_poly_centroids *m, size_t f, double enough)
{
    const uint32_t *side = m->mesh->side[f];
    const bool inner = side[1] != TM_NONE;
    tm_fit_verdict v = {0, -1, 0};
    for (int s = 0; s < 1 + inner; s++)
        ask(&v, TM_FIT_PYRAMID, sine(m, f, s));
    if (inner) {
        ask(&v, TM_FIT_OBLIQUE, cosine_of_line(m, f));
        ask(&v, TM_FIT_UNEVEN, tm_facet_weight(m, f));
        ask(&v, TM_FIT_UNEQUAL, tm_facet_volume_ratio(m, f));
    }
    if (v.missing < enough)
        ask(&v, TM_FIT_SKEW, -tm_facet_skewness(m, f));
    if (v.missing >= enough)
        return v;
    const double sights = tm_facet_sights(m, f), good = scales[TM_FIT_TETRAHEDRA].good;
    ask(&v, TM_FIT_TETRAHEDRA,
        fmin(sights, tm_facet_fan(m, f, sights < good ? sights : good)));
    return v;
}

void tm_fit_cell_add(tm_fit_cell *sums, const tm_poly_centroids *m, size_t f, size_t c)
{
    const tm_facet_centroid *face = &m->face[f];
    const double sign = m->mesh->side[f][0] == c ? 1 : -1;
    double q[3];
    tm_subtract(q, face->centre, sums->base);
    const double pyramid = sign * tm_dot(face->area, q);
    sums->volume += pyramid;
    for (int x = 0; x < 3; x++) {
        sums->mean[x] += q[x];
        sums->moment[x] += pyramid * q[x];
        for (int y = 0; y < 3; y++)
            sums->cross[x][y] += sign * q[x] * face->area[y];
    }
    if (m->mesh->side[f][1] == TM_NONE)
        return;
    sums->inside++;
    sums->area += face->size;
    for (int x = 0; x < 3; x++)
        for (int y = 0; y < 3; y++)
            sums->spread[x][y] += face->area[x] * face->area[y];
}

/* Pyramids from the mean of the facets' centroids: of a closed cell the areas add up to
 * nothing. */
void tm_fit_cell_finish(const tm_fit_cell *sums, const tm_poly_centroids *m, size_t c)
{
    tm_cell_centroid *out = &m->cell[c];
    double mean[3];
    for (int x = 0; x < 3; x++) {
        mean[x] = sums->mean[x] / (double)out->facets;
        out->mean[x] = sums->base[x] + mean[x];
    }
    out->volume = sums->volume / 3;
    for (int x = 0; x < 3; x++) {
        const double moment = 3 * (sums->moment[x] - tm_dot(sums->cross[x], mean)) / 4 +
                              mean[x] * sums->volume / 4;
        out->centre[x] =
            sums->base[x] + (sums->volume != 0 ? moment / sums->volume : mean[x]);
    }
}

/* tm_facet_beyond(), where that matters: the root is taken of few. */
static void add_pair(tm_fit_pairs *pairs, const tm_poly_centroids *m, size_t f, size_t g,
                     double sign)
{
    const double heavy = 3, good = scales[TM_FIT_CONCAVE].good;
    const double *area = m->face[f].area;
    double to[3];
    tm_subtract(to, m->face[g].centre, m->face[f].centre);
    const double along = -sign * tm_dot(to, area);
    const double lengths2 = m->face[f].size * m->face[f].size * tm_norm2(to);
    if ((along > 0 && along * along >= good * good * lengths2) || !(lengths2 > 0))
        return;
    const double value = along / sqrt(lengths2), x = scaled(TM_FIT_CONCAVE, value);
    pairs->concave += !(value > scales[TM_FIT_CONCAVE].limit);
    pairs->bad += x > TM_FIT_BAD;
    pairs->missing += short_by(x, heavy);
}

void tm_fit_add_pairs(tm_fit_pairs *pairs, const tm_poly_centroids *m, size_t f, size_t g,
                      size_t c)
{
    add_pair(pairs, m, f, g, m->mesh->side[f][0] == c ? 1 : -1);
    add_pair(pairs, m, g, f, m->mesh->side[g][0] == c ? 1 : -1);
}

void tm_fit_add_facet(tm_fit_sum *sum, const tm_fit_verdict *verdict)
{
    sum->missing += verdict->missing;
    sum->bad += (double)verdict->worst > TM_FIT_BAD;
    for (int k = 0; k < TM_FIT_FAULTS && verdict->faults; k++)
        sum->count[k] += verdict->faults >> k & 1;
}

void tm_fit_add_cell(tm_fit_sum *sum, const tm_fit_cell *cell)
{
    tm_fit_verdict v = {0, -1, 0};
    ask(&v, TM_FIT_UNDETERMINED,
        tm_determinant_of(cell->spread, cell->area, cell->inside));
    tm_fit_add_facet(sum, &v);
    sum->missing += cell->pairs.missing;
    sum->bad += cell->pairs.bad;
    sum->count[TM_FIT_CONCAVE] += cell->pairs.concave > 0;
}
