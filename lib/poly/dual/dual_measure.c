/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dual_measure.h"

#include <math.h>
#include <string.h>

/* Inline, and of two of which one is NaN the second. */
static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

void tm_dual_measure_face(const tm_dual *d, size_t f, tm_dual_face *face)
{
    const size_t begin = d->facet.start[f], count = d->facet.start[f + 1] - begin;
    const uint32_t *node = d->facet.item + begin;
    double mean[3] = {0}, moment[3] = {0}, sum = 0;
    memset(face->area, 0, sizeof face->area);
    for (size_t i = 0; i < count; i++)
        for (int x = 0; x < 3; x++)
            mean[x] += d->xyz[node[i]][x];
    for (int x = 0; x < 3; x++)
        mean[x] /= (double)count;
    for (size_t i = 0; i < count; i++) {
        const double *a = d->xyz[node[i]], *b = d->xyz[node[i + 1 < count ? i + 1 : 0]];
        double normal[3];
        tm_triangle_normal(normal, a, b, mean);
        const double area = tm_norm(normal);
        sum += area;
        for (int x = 0; x < 3; x++) {
            face->area[x] += normal[x] / 2;
            moment[x] += area * (a[x] + b[x] + mean[x]);
        }
    }
    for (int x = 0; x < 3; x++)
        face->centre[x] = sum > 0 ? moment[x] / (3 * sum) : mean[x];
}

/* Whether cell c is the first one of facet f: as a factor. */
static double sign_of(const tm_dual_measures *m, size_t f, size_t c)
{
    return m->d->facet.integer[2 * f] == c ? 1 : -1;
}

void tm_dual_measure_centre(const tm_dual_measures *m, size_t c, tm_dual_centre *centre)
{
    const size_t begin = m->cell->start[c], end = m->cell->start[c + 1];
    double mean[3] = {0}, moment[3] = {0}, sum = 0;
    for (size_t i = begin; i < end; i++)
        for (int x = 0; x < 3; x++)
            mean[x] += m->face[m->cell->item[i]].centre[x];
    for (int x = 0; x < 3; x++)
        mean[x] /= (double)(end - begin);
    for (size_t i = begin; i < end; i++) {
        const size_t f = m->cell->item[i];
        const tm_dual_face *face = &m->face[f];
        double to[3];
        tm_subtract(to, face->centre, mean);
        const double volume = sign_of(m, f, c) * tm_dot(face->area, to);
        sum += volume;
        for (int x = 0; x < 3; x++)
            moment[x] += volume * to[x];
    }
    for (int x = 0; x < 3; x++)
        centre->at[x] = mean[x] + (sum != 0 ? moment[x] * 3 / (4 * sum) : 0);
    centre->volume = sum / 3;
}

bool tm_dual_is_wrong(const tm_dual_measures *m, size_t f, int side)
{
    const tm_dual_face *face = &m->face[f];
    double to[3];
    tm_subtract(to, face->centre,
                m->centre[m->d->facet.integer[2 * f + (size_t)side]].at);
    const double height = tm_dot(face->area, to);
    return !((side ? -height : height) > 0);
}

/* How badly the line from `from` along d misses the centroid of a facet (skewness). */
static double skewness_of(const tm_dual_measures *m, size_t f, const double from[3],
                          const double d[3], double least)
{
    const tm_dual *dual = m->d;
    const tm_dual_face *face = &m->face[f];
    double to[3], miss[3], direction[3];
    tm_subtract(to, face->centre, from);
    const double along = tm_dot(face->area, d);
    const double share = along != 0 ? tm_dot(face->area, to) / along : 0;
    for (int x = 0; x < 3; x++)
        miss[x] = to[x] - share * d[x];
    const double length2 = tm_norm2(miss), extent2 = least * least * tm_norm2(d);
    if (length2 <= extent2)
        return 1; /* or less */
    double extent = sqrt(extent2 * length2);
    for (size_t i = dual->facet.start[f]; i < dual->facet.start[f + 1]; i++) {
        tm_subtract(direction, dual->xyz[dual->facet.item[i]], face->centre);
        extent = larger(extent, fabs(tm_dot(miss, direction)));
    }
    return extent > 0 ? length2 / extent : 0;
}

/* The least volume of the tetrahedra of a fan of triangles around node `apex` of a facet
 * and a point, by that of the facet's pyramid. */
static double least_of_fan(const tm_dual_measures *m, size_t f, size_t apex,
                           const double point[3], double sign, double pyramid,
                           double enough)
{
    const tm_dual *d = m->d;
    const size_t begin = d->facet.start[f], count = d->facet.start[f + 1] - begin;
    const uint32_t *node = d->facet.item + begin;
    const double *a = d->xyz[node[apex]];
    double least = HUGE_VAL, to[3], b[3], c[3], normal[3];
    tm_subtract(to, a, point);
    tm_subtract(b, d->xyz[node[(apex + 1) % count]], a);
    for (size_t k = 2; k < count && least > enough; k++) {
        tm_subtract(c, d->xyz[node[(apex + k) % count]], a);
        tm_cross(normal, b, c);
        least = smaller(least, sign * tm_dot(normal, to) / pyramid);
        memcpy(b, c, sizeof b);
    }
    return least;
}

/* The best node for a fan that both cells see: how much of the pyramid its smallest
 * tetrahedron is. */
static double best_fan(const tm_dual_measures *m, size_t f, const double pyramid[2])
{
    const tm_dual *d = m->d;
    const size_t count = d->facet.start[f + 1] - d->facet.start[f];
    const uint32_t *side = d->facet.integer + 2 * f;
    const double good = 0.02;
    double best = -HUGE_VAL;
    for (size_t apex = 0; apex < count && best < good; apex++) {
        double least = HUGE_VAL;
        for (int s = 0; s < 2 && least > best; s++)
            if (side[s] != TM_NONE)
                least = smaller(least, least_of_fan(m, f, apex, m->centre[side[s]].at,
                                                    s ? -1 : 1, pyramid[s], best));
        best = larger(best, least);
    }
    return best;
}

/* The least volume of the tetrahedra of the triangles around the centroid of a facet and
 * those of its cells, by those of its pyramids. */
static double least_around(const tm_dual_measures *m, size_t f, const double pyramid[2])
{
    const tm_dual *d = m->d;
    const size_t begin = d->facet.start[f], end = d->facet.start[f + 1];
    const uint32_t *side = d->facet.integer + 2 * f, *node = d->facet.item;
    const double *centre = m->face[f].centre;
    double least = HUGE_VAL, to[2][3], a[3], b[3], normal[3];
    for (int s = 0; s < 2; s++)
        if (side[s] != TM_NONE)
            tm_subtract(to[s], centre, m->centre[side[s]].at);
    tm_subtract(a, d->xyz[node[end - 1]], centre);
    for (size_t i = begin; i < end; i++) {
        tm_subtract(b, d->xyz[node[i]], centre);
        tm_cross(normal, a, b);
        for (int s = 0; s < 2; s++)
            if (side[s] != TM_NONE)
                least = smaller(least, (s ? -1 : 1) * tm_dot(normal, to[s]) / pyramid[s]);
        memcpy(a, b, sizeof a);
    }
    return least;
}

/* A measure as 0 where it is `good` and 1 where it is `bad`. */
static double scaled(double value, double good, double bad)
{
    return (value - good) / (bad - good);
}

double tm_dual_judge_face(const tm_dual_measures *m, size_t f)
{
    const uint32_t *side = m->d->facet.integer + 2 * f;
    const tm_dual_face *face = &m->face[f];
    const tm_dual_centre *c = &m->centre[side[0]];
    const bool inner = side[1] != TM_NONE;
    double to[2][3], line[3], height[2] = {0}, worst = -1, pyramid[2] = {0};
    const double area = tm_norm(face->area);
    if (!(area > 0))
        return 2;
    for (int s = 0; s < 1 + inner; s++) {
        tm_subtract(to[s], face->centre, m->centre[side[s]].at);
        height[s] = (s ? -1 : 1) * tm_dot(face->area, to[s]) / area;
        pyramid[s] = 2 * height[s] * area;
        worst = larger(worst, scaled(height[s] / tm_norm(to[s]), 0.25, 0.02));
    }
    double skew;
    if (inner) {
        const tm_dual_centre *e = &m->centre[side[1]];
        tm_subtract(line, e->at, c->at);
        const double cosine = tm_dot(line, face->area) / (tm_norm(line) * area);
        worst = larger(worst, scaled(cosine, 0.48, 0.35));
        worst =
            larger(worst, scaled(smaller(height[0], height[1]) / (height[0] + height[1]),
                                 0.12, 0.055));
        worst = larger(
            worst, scaled(smaller(c->volume, e->volume) / larger(c->volume, e->volume),
                          0.02, 0.0105));
        skew = skewness_of(m, f, c->at, line, 0.2);
    } else {
        for (int x = 0; x < 3; x++)
            line[x] = face->area[x] * height[0] / area;
        skew = skewness_of(m, f, c->at, line, 0.4);
    }
    worst = larger(worst, scaled(skew, 2, 3.8));
    if (worst < 1)
        worst = larger(worst, scaled(least_around(m, f, pyramid), 0.01, 0.0005));
    if (worst < 1)
        worst = larger(worst, scaled(best_fan(m, f, pyramid), 0.01, 0.0005));
    return worst;
}

/* A facet of a cell, seen from inside: n is its area vector, outward. */
typedef struct {
    double centre[3], n[3], square;
    bool outer;
} plane;

enum { PLANES = 64 };

/* What the planes a are to the centroids of b adds; returns the worst. */
static double judge_planes(const plane *a, size_t as, const plane *b, size_t bs,
                           double *sum)
{
    const double good = -0.02, bad = -0.001, heavy = 3;
    double worst = -1;
    for (size_t i = 0; i < as; i++)
        for (size_t k = 0; k < bs; k++) {
            double to[3];
            if (a[i].outer && b[k].outer)
                continue;
            tm_subtract(to, b[k].centre, a[i].centre);
            const double along = tm_dot(to, a[i].n),
                         lengths2 = a[i].square * tm_norm2(to);
            if ((along <= 0 && along * along >= good * good * lengths2) || lengths2 == 0)
                continue;
            const double x = scaled(along / sqrt(lengths2), good, bad);
            worst = larger(worst, x);
            *sum += x * x + (x > TM_DUAL_BAD ? heavy * (x - TM_DUAL_BAD) : 0);
        }
    return worst;
}

/* Takes up to PLANES facets of a cell, from place `from` on; how many. */
static size_t take_planes(const tm_dual_measures *m, size_t c, size_t from, plane *p)
{
    const size_t end = m->cell->start[c + 1];
    size_t count = 0;
    for (; count < PLANES && from + count < end; count++) {
        const size_t f = m->cell->item[from + count];
        const tm_dual_face *face = &m->face[f];
        const double sign = sign_of(m, f, c);
        memcpy(p[count].centre, face->centre, sizeof p[count].centre);
        for (int x = 0; x < 3; x++)
            p[count].n[x] = sign * face->area[x];
        p[count].square = tm_norm2(face->area);
        p[count].outer = m->d->facet.integer[2 * f + 1] == TM_NONE;
    }
    return count;
}

double tm_dual_judge_cell(const tm_dual_measures *m, size_t c, double *sum)
{
    const size_t begin = m->cell->start[c], end = m->cell->start[c + 1];
    plane a[PLANES], b[PLANES];
    double worst = -1;
    for (size_t i = begin, as; i < end; i += as) {
        as = take_planes(m, c, i, a);
        worst = larger(worst, judge_planes(a, as, a, as, sum));
        for (size_t k = begin, bs; k < end && end - begin > PLANES; k += bs) {
            bs = take_planes(m, c, k, b);
            if (k != i)
                worst = larger(worst, judge_planes(a, as, b, bs, sum));
        }
    }
    return worst;
}
