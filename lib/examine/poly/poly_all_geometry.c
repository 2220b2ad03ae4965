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

static void judge_weight(const tm_poly_centroids *m, size_t f, tm_poly_finite_volume *out)
{
    const uint32_t *side = m->mesh->side[f];
    const double a = height(m, f, m->cell[side[0]].centre);
    const double b = height(m, f, m->cell[side[1]].centre);
    const double weight = a + b > 0 ? fmin(a, b) / (a + b) : 0;
    out->min_weight = fmin(out->min_weight, weight);
    out->small_weights += weight < TM_FV_WEIGHT;
}

static void judge_volumes(const tm_poly_centroids *m, size_t f,
                          tm_poly_finite_volume *out)
{
    const uint32_t *side = m->mesh->side[f];
    const double a = fabs(m->cell[side[0]].volume), b = fabs(m->cell[side[1]].volume);
    const double most = fmax(a, b), ratio = most > 0 ? fmin(a, b) / most : 0;
    out->min_volume_ratio = fmin(out->min_volume_ratio, ratio);
    out->small_volume_ratios += ratio < TM_FV_VOLUME_RATIO;
}

bool tm_facet_is_seen(const tm_poly_centroids *m, size_t f, int s)
{
    const size_t count = tm_facet_corners(m->mesh, f);
    const double *from = m->cell[m->mesh->side[f][s]].centre;
    for (size_t i = 0; i < count; i++) {
        const double volume = tm_tet_volume(
            tm_facet_corner(m->mesh, f, i), tm_facet_corner(m->mesh, f, (i + 1) % count),
            m->face[f].centre, from);
        if (!(s == 0 ? volume < 0 : volume > 0))
            return false;
    }
    return true;
}

static bool is_seen(const tm_poly_centroids *m, size_t f)
{
    for (int s = 0; s < 2; s++)
        if (m->mesh->side[f][s] != TM_NONE && !tm_facet_is_seen(m, f, s))
            return false;
    return true;
}

/* Whether both centroids see the facet as the fan of triangles around a corner. */
static bool is_fan(const tm_poly_centroids *m, size_t f, size_t base)
{
    const size_t count = tm_facet_corners(m->mesh, f);
    for (size_t i = 1; i + 1 < count; i++)
        for (int s = 0; s < 2; s++) {
            const uint32_t c = m->mesh->side[f][s];
            if (c == TM_NONE)
                continue;
            const double volume = tm_tet_volume(
                tm_facet_corner(m->mesh, f, base),
                tm_facet_corner(m->mesh, f, (base + i) % count),
                tm_facet_corner(m->mesh, f, (base + i + 1) % count), m->cell[c].centre);
            if (!(s == 0 ? volume < 0 : volume > 0))
                return false;
        }
    return true;
}

static bool has_fan(const tm_poly_centroids *m, size_t f)
{
    for (size_t base = 0; base < tm_facet_corners(m->mesh, f); base++)
        if (is_fan(m, f, base))
            return true;
    return false;
}

static double determinant(const double a[3][3])
{
    double cross[3];
    tm_cross(cross, a[1], a[2]);
    return tm_dot(a[0], cross);
}

/* Of the sum of n n^T over the facets inside, where n is their area by the mean of these
 * areas. */
static void judge_determinant(const tm_poly_centroids *m, size_t c,
                              tm_poly_finite_volume *out)
{
    const tm_poly_arrays *mesh = m->mesh;
    double sum[3][3] = {{0}}, mean = 0;
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
    const double cube = 8; /* of a cube with all facets inside */
    const double found = fabs(determinant((const double(*)[3])sum)) / cube;
    out->min_determinant = fmin(out->min_determinant, found);
    out->small_determinants += found < TM_FV_DETERMINANT;
}

/* Whether a facet's centroid is beyond the plane of another one, or in it: so are, to
 * checkMesh, the facets around a hanging node. */
static bool is_beyond(const tm_poly_centroids *m, uint32_t f, uint32_t other, size_t c)
{
    const tm_facet_centroid *at = &m->face[f];
    const double sign = m->mesh->side[f][0] == c ? 1 : -1;
    const double rounding = 1e-6;
    double to[3];
    tm_subtract(to, m->face[other].centre, at->centre);
    const double lengths = tm_norm(to) * tm_norm(at->area);
    return lengths > 0 && sign * tm_dot(to, at->area) > -rounding * lengths;
}

static bool is_concave(const tm_poly_centroids *m, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t begin = mesh->cell_start[c], end = mesh->cell_start[c + 1];
    for (size_t i = begin; i < end; i++)
        for (size_t j = begin; j < end; j++)
            if (i != j && is_beyond(m, mesh->cell_facet[i], mesh->cell_facet[j], c))
                return true;
    return false;
}

void tm_poly_all_geometry(const tm_poly_centroids *m, tm_poly_finite_volume *out)
{
    size_t inside = 0;
    out->min_weight = out->min_volume_ratio = out->min_determinant = HUGE_VAL;
    for (size_t f = 0; f < m->mesh->facets; f++) {
        if (!tm_facet_fits(m->mesh, f))
            continue;
        out->unseen += !is_seen(m, f);
        out->no_fan += !has_fan(m, f);
        if (m->mesh->side[f][1] == TM_NONE)
            continue;
        inside++;
        judge_weight(m, f, out);
        judge_volumes(m, f, out);
    }
    for (size_t c = 0; c < m->mesh->cells; c++) {
        judge_determinant(m, c, out);
        out->concave += is_concave(m, c);
    }
    if (inside == 0)
        out->min_weight = out->min_volume_ratio = 0;
    if (m->mesh->cells == 0)
        out->min_determinant = 0;
}
