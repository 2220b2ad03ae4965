/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_all_geometry.h"

#include <math.h>
#include <string.h>

/* The distance along the facet's normal from its first cell's centroid, or to its second
 * one's. */
static double height(const tm_poly_centroids *m, size_t f, const double from[3])
{
    const double area = m->face[f].size;
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

/* From the centroids of the sides from … to - 1, of the triangles of a facet around a
 * point, but for those with its corner `base`; or what is not above `above`. The triangle
 * that ends before the base comes first, then the one that begins after it: they are the
 * smallest, so that few others are looked at if something is above. */
static double least_sight(const tm_poly_centroids *m, size_t f, int from, int to,
                          const double point[3], size_t base, double above)
{
    const size_t count = tm_facet_corners(m->mesh, f);
    const double area = m->face[f].size;
    double least = HUGE_VAL, line[2][3], p[3], q[3], normal[3];
    for (int s = from; s < to; s++) {
        tm_subtract(line[s], point, m->cell[m->mesh->side[f][s]].centre);
        const double scale = tm_norm(line[s]) * area * (s == 0 ? 1 : -1);
        if (scale == 0)
            return 0;
        for (int x = 0; x < 3; x++)
            line[s][x] /= scale;
    }
    size_t last = base < count ? (base + count - 2) % count : count - 1;
    tm_subtract(p, tm_facet_corner(m->mesh, f, last), point);
    for (size_t k = 0; k < count && least > above; k++) {
        const size_t i = last + 1 < count ? last + 1 : 0;
        tm_subtract(q, tm_facet_corner(m->mesh, f, i), point);
        tm_cross(normal, p, q);
        for (int s = from; s < to && last != base && i != base; s++) {
            const double sight = tm_dot(normal, line[s]);
            least = sight < least ? sight : least;
        }
        memcpy(p, q, sizeof p);
        last = i;
    }
    return least;
}

static int sides_of(const tm_poly_centroids *m, size_t f)
{
    return m->mesh->side[f][1] == TM_NONE ? 1 : 2;
}

double tm_facet_sight(const tm_poly_centroids *m, size_t f, int s)
{
    return least_sight(m, f, s, s + 1, m->face[f].centre, SIZE_MAX, -HUGE_VAL);
}

double tm_facet_sights(const tm_poly_centroids *m, size_t f)
{
    return least_sight(m, f, 0, sides_of(m, f), m->face[f].centre, SIZE_MAX, -HUGE_VAL);
}

double tm_facet_fan(const tm_poly_centroids *m, size_t f, double enough)
{
    double best = -HUGE_VAL;
    for (size_t base = 0; base < tm_facet_corners(m->mesh, f) && !(best > enough); base++)
        best = fmax(best, least_sight(m, f, 0, sides_of(m, f),
                                      tm_facet_corner(m->mesh, f, base), base, best));
    return best;
}

double tm_determinant_of(const double spread[3][3], double area, size_t inside)
{
    const double cube = 8; /* of a cube with all facets inside */
    const double mean = inside > 0 ? area / (double)inside : 0;
    double sum[3][3], cross[3];
    for (int x = 0; x < 3; x++)
        for (int y = 0; y < 3; y++)
            sum[x][y] = mean > 0 ? spread[x][y] / mean / mean : 0;
    tm_cross(cross, sum[1], sum[2]);
    return fabs(tm_dot(sum[0], cross)) / cube;
}

double tm_cell_determinant(const tm_poly_centroids *m, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    double spread[3][3] = {{0}}, sum = 0;
    size_t inside = 0;
    for (size_t k = mesh->cell_start[c]; k < mesh->cell_start[c + 1]; k++) {
        const uint32_t f = mesh->cell_facet[k];
        if (mesh->side[f][1] == TM_NONE)
            continue;
        const double *area = m->face[f].area;
        sum += tm_norm(area);
        inside++;
        for (int x = 0; x < 3; x++)
            for (int y = 0; y < 3; y++)
                spread[x][y] += area[x] * area[y];
    }
    return tm_determinant_of((const double(*)[3])spread, sum, inside);
}

double tm_facet_beyond(const tm_poly_centroids *m, size_t f, size_t other, size_t c)
{
    const tm_facet_centroid *at = &m->face[f];
    double to[3];
    tm_subtract(to, m->face[other].centre, at->centre);
    const double lengths = tm_norm(to) * at->size;
    const double sign = m->mesh->side[f][0] == c ? 1 : -1;
    return lengths > 0 ? sign * tm_dot(to, at->area) / lengths : -1;
}

bool tm_cell_is_concave(const tm_poly_centroids *m, size_t c)
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

void tm_facet_all_geometry(const tm_poly_centroids *m, size_t f,
                           tm_poly_finite_volume *out)
{
    out->unseen += !(tm_facet_sights(m, f) > 0);
    out->no_fan += !(tm_facet_fan(m, f, 0) > 0);
    if (m->mesh->side[f][1] == TM_NONE)
        return;
    const double weight = tm_facet_weight(m, f), ratio = tm_facet_volume_ratio(m, f);
    out->min_weight = fmin(out->min_weight, weight);
    out->small_weights += weight < TM_FV_WEIGHT;
    out->min_volume_ratio = fmin(out->min_volume_ratio, ratio);
    out->small_volume_ratios += ratio < TM_FV_VOLUME_RATIO;
}

void tm_cell_all_geometry(const tm_poly_centroids *m, size_t c,
                          tm_poly_finite_volume *out)
{
    const double determinant = tm_cell_determinant(m, c);
    out->min_determinant = fmin(out->min_determinant, determinant);
    out->small_determinants += determinant < TM_FV_DETERMINANT;
    out->concave += tm_cell_is_concave(m, c);
}
