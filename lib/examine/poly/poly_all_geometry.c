/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_all_geometry.h"

#include <math.h>

/* The distance along the facet's normal from its first cell's centroid, or to its second
 * one's. */
static double height(const tm_poly_centroids *m, size_t f, const double from[3])
{
    const double area = tm_norm(m->face[f].area);
    return area > 0 ? fabs(tm_facet_pyramid(&m->face[f], from, 1)) / area : 0;
}

double tm_facet_weight(const tm_poly_centroids *m, size_t f)
{
    const uint32_t *side = m->mesh->side[f];
    const double a = height(m, f, m->cell[side[0]].centre);
    const double b = height(m, f, m->cell[side[1]].centre);
    return a + b > 0 ? fmin(a, b) / (a + b) : 0;
}

double tm_facet_volume_ratio(const tm_poly_centroids *m, size_t f)
{
    const uint32_t *side = m->mesh->side[f];
    const double a = fabs(m->cell[side[0]].volume), b = fabs(m->cell[side[1]].volume);
    const double most = fmax(a, b);
    return most > 0 ? fmin(a, b) / most : 0;
}

/* Of the triangles of a facet around a point, but for those with its corner `base`. */
static double least_sight(const tm_poly_centroids *m, size_t f, int s,
                          const double point[3], size_t base)
{
    const size_t count = tm_facet_corners(m->mesh, f);
    double least = HUGE_VAL, to[3];
    tm_subtract(to, point, m->cell[m->mesh->side[f][s]].centre);
    const double scale = tm_norm(to) * tm_norm(m->face[f].area) * (s == 0 ? 1 : -1);
    if (scale == 0)
        return 0;
    for (size_t i = 0; i < count; i++) {
        double normal[3];
        if (i == base || (i + 1) % count == base)
            continue;
        tm_triangle_normal(normal, point, tm_facet_corner(m->mesh, f, i),
                           tm_facet_corner(m->mesh, f, (i + 1) % count));
        least = fmin(least, tm_dot(normal, to) / scale);
    }
    return least;
}

double tm_facet_sight(const tm_poly_centroids *m, size_t f, int s)
{
    return least_sight(m, f, s, m->face[f].centre, SIZE_MAX);
}

double tm_facet_fan(const tm_poly_centroids *m, size_t f, double enough)
{
    double best = -HUGE_VAL;
    for (size_t base = 0; base < tm_facet_corners(m->mesh, f) && !(best > enough);
         base++) {
        double least = HUGE_VAL;
        for (int s = 0; s < 2; s++)
            if (m->mesh->side[f][s] != TM_NONE)
                least = fmin(
                    least, least_sight(m, f, s, tm_facet_corner(m->mesh, f, base), base));
        best = fmax(best, least);
    }
    return best;
}

double tm_cell_determinant(const tm_poly_centroids *m, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    const double cube = 8; /* of a cube with all facets inside */
    double sum[3][3] = {{0}}, mean = 0, cross[3];
    size_t inside = 0;
    for (size_t k = mesh->cell_start[c]; k < mesh->cell_start[c + 1]; k++) {
        const uint32_t f = mesh->cell_facet[k];
        if (mesh->side[f][1] == TM_NONE)
            continue;
        const double *area = m->face[f].area;
        mean += tm_norm(area);
        inside++;
        for (int x = 0; x < 3; x++)
            for (int y = 0; y < 3; y++)
                sum[x][y] += area[x] * area[y];
    }
    mean /= inside > 0 ? (double)inside : 1;
    for (int x = 0; x < 3; x++)
        for (int y = 0; y < 3; y++)
            sum[x][y] = mean > 0 ? sum[x][y] / mean / mean : 0;
    tm_cross(cross, sum[1], sum[2]);
    return fabs(tm_dot(sum[0], cross)) / cube;
}

double tm_facet_beyond(const tm_poly_centroids *m, size_t f, size_t other, size_t c)
{
    const tm_facet_centroid *at = &m->face[f];
    double to[3];
    tm_subtract(to, m->face[other].centre, at->centre);
    const double lengths = tm_norm(to) * tm_norm(at->area);
    const double sign = m->mesh->side[f][0] == c ? 1 : -1;
    return lengths > 0 ? sign * tm_dot(to, at->area) / lengths : -1;
}

static bool is_seen(const tm_poly_centroids *m, size_t f)
{
    for (int s = 0; s < 2; s++)
        if (m->mesh->side[f][s] != TM_NONE && !(tm_facet_sight(m, f, s) > 0))
            return false;
    return true;
}

static bool is_concave(const tm_poly_centroids *m, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t begin = mesh->cell_start[c], end = mesh->cell_start[c + 1];
    for (size_t i = begin; i < end; i++)
        for (size_t j = begin; j < end; j++)
            if (i != j && tm_facet_beyond(m, mesh->cell_facet[i], mesh->cell_facet[j],
                                          c) > -TM_FV_PLANE)
                return true;
    return false;
}

static void judge_facet(const tm_poly_centroids *m, size_t f, tm_poly_finite_volume *out)
{
    out->unseen += !is_seen(m, f);
    out->no_fan += !(tm_facet_fan(m, f, 0) > 0);
    if (m->mesh->side[f][1] == TM_NONE)
        return;
    const double weight = tm_facet_weight(m, f), ratio = tm_facet_volume_ratio(m, f);
    out->min_weight = fmin(out->min_weight, weight);
    out->small_weights += weight < TM_FV_WEIGHT;
    out->min_volume_ratio = fmin(out->min_volume_ratio, ratio);
    out->small_volume_ratios += ratio < TM_FV_VOLUME_RATIO;
}

void tm_poly_all_geometry(const tm_poly_centroids *m, tm_poly_finite_volume *out)
{
    size_t inside = 0;
    out->min_weight = out->min_volume_ratio = out->min_determinant = HUGE_VAL;
    for (size_t f = 0; f < m->mesh->facets; f++) {
        if (!tm_facet_fits(m->mesh, f))
            continue;
        judge_facet(m, f, out);
        inside += m->mesh->side[f][1] != TM_NONE;
    }
    for (size_t c = 0; c < m->mesh->cells; c++) {
        const double determinant = tm_cell_determinant(m, c);
        out->min_determinant = fmin(out->min_determinant, determinant);
        out->small_determinants += determinant < TM_FV_DETERMINANT;
        out->concave += is_concave(m, c);
    }
    if (inside == 0)
        out->min_weight = out->min_volume_ratio = 0;
    if (m->mesh->cells == 0)
        out->min_determinant = 0;
}
