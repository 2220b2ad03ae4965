/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_finite_volume.h"

#include "poly_centroids.h"
#include "poly_all_geometry.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>

/* How far the line from `from` along d misses the centroid of a facet, by the facet's
 * extent that way, or `least` of the line's length where that is more. */
static double skewness_of(const tm_poly_centroids *m, size_t f, const double from[3],
                          const double d[3], double least)
{
    const tm_facet_centroid *at = &m->face[f];
    double to[3], miss[3], direction[3];
    tm_subtract(to, at->centre, from);
    double along = tm_dot(at->area, d);
    double share = along != 0 ? tm_dot(at->area, to) / along : 0;
    for (int x = 0; x < 3; x++)
        miss[x] = to[x] - share * d[x];
    double length = tm_norm(miss), extent = least * tm_norm(d);
    for (size_t i = 0; i < tm_facet_corners(m->mesh, f) && length > 0; i++) {
        tm_subtract(direction, tm_facet_corner(m->mesh, f, i), at->centre);
        extent = fmax(extent, fabs(tm_dot(miss, direction)) / length);
    }
    return extent > 0 ? length / extent : 0;
}

double tm_facet_skewness(const tm_poly_centroids *m, size_t f)
{
    const double inner = 0.2, outer = 0.4;
    const uint32_t *side = m->mesh->side[f];
    const tm_cell_centroid *c = &m->cell[side[0]];
    const double *area = m->face[f].area;
    double to[3], d[3];
    if (side[1] != TM_NONE) {
        tm_subtract(d, m->cell[side[1]].centre, c->centre);
        return skewness_of(m, f, c->centre, d, inner);
    }
    const double area2 = tm_norm2(area);
    tm_subtract(to, m->face[f].centre, c->centre);
    for (int x = 0; x < 3; x++)
        d[x] = area2 > 0 ? area[x] * tm_dot(area, to) / area2 : 0;
    return skewness_of(m, f, c->centre, d, outer);
}

static void judge_inner(const tm_poly_centroids *m, size_t f, tm_poly_finite_volume *out)
{
    const double half_turn = 180, pi = acos(-1), rounding = 1e-15;
    const tm_cell_centroid *c = &m->cell[m->mesh->side[f][0]],
                           *e = &m->cell[m->mesh->side[f][1]];
    double d[3];
    tm_subtract(d, e->centre, c->centre);
    double lengths = tm_norm(d) * m->face[f].size;
    double cosine = lengths > 0 ? tm_dot(d, m->face[f].area) / lengths : 1;
    double angle = acos(fmax(-1, fmin(1, cosine))) * half_turn / pi;
    out->max_non_orthogonality = fmax(out->max_non_orthogonality, angle);
    out->mean_non_orthogonality += angle;
    out->non_orthogonal += angle > TM_FV_NON_ORTHOGONALITY;
    out->reversed += !(cosine > rounding);
}

static void judge_facets(const tm_poly_centroids *m, tm_poly_finite_volume *out)
{
    size_t facets = 0, inner = 0;
    out->min_pyramid = HUGE_VAL;
    for (size_t f = 0; f < m->mesh->facets; f++) {
        if (!tm_facet_fits(m->mesh, f))
            continue;
        for (int s = 0; s < 2; s++) {
            uint32_t c = m->mesh->side[f][s];
            double sign = s == 0 ? 1 : -1;
            if (c == TM_NONE)
                continue;
            const double pyramid =
                tm_facet_pyramid(&m->face[f], m->cell[c].centre, sign) / 3;
            out->min_pyramid = fmin(out->min_pyramid, pyramid);
            out->wrong_pyramids += !(pyramid > 0);
        }
        const double skew = tm_facet_skewness(m, f);
        out->max_skewness = fmax(out->max_skewness, skew);
        out->skew += skew > TM_FV_SKEWNESS;
        facets++;
        if (m->mesh->side[f][1] == TM_NONE)
            continue;
        inner++;
        judge_inner(m, f, out);
    }
    if (facets == 0)
        out->min_pyramid = 0;
    if (inner > 0)
        out->mean_non_orthogonality /= (double)inner;
}

static void judge_cells(const tm_poly_centroids *m, double *volume,
                        tm_poly_finite_volume *out)
{
    const double few = 0.05;
    const size_t cells = m->mesh->cells;
    for (size_t c = 0; c < cells; c++)
        volume[c] = m->cell[c].volume;
    qsort(volume, cells, sizeof *volume, tm_compare_reals);
    if (cells > 0) {
        size_t low = (size_t)(few * (double)(cells - 1));
        out->volume_spread =
            volume[low] > 0 ? volume[cells - 1 - low] / volume[low] : HUGE_VAL;
    }
}

tm_status tm_poly_finite_volume_check(tm_poly_finite_volume *measures,
                                      const tm_poly_arrays *mesh, tm_error *error)
{
    tm_poly_centroids m;
    const tm_status status = tm_poly_centroids_find(&m, mesh, error);
    *measures = (tm_poly_finite_volume){.max_bend = m.max_bend};
    if (status == TM_OK)
        judge_facets(&m, measures);
    tm_poly_centroids_free(&m);
    return status;
}

tm_status tm_poly_find_unseen(bool *unseen, const tm_poly_arrays *mesh, tm_error *error)
{
    tm_poly_centroids m;
    const tm_status status = tm_poly_centroids_find(&m, mesh, error);
    for (size_t c = 0; c < mesh->cells; c++)
        unseen[c] = false;
    for (size_t f = 0; f < mesh->facets && status == TM_OK; f++)
        for (int s = 0; s < 2 && tm_facet_fits(mesh, f); s++) {
            const uint32_t c = mesh->side[f][s];
            const double sign = s == 0 ? 1 : -1;
            if (c != TM_NONE)
                unseen[c] |= !(tm_facet_sight(&m, f, s) > 0) ||
                             !(tm_facet_pyramid(&m.face[f], m.cell[c].centre, sign) > 0);
        }
    tm_poly_centroids_free(&m);
    return status;
}

tm_status tm_poly_finite_volume_measure(tm_poly_finite_volume *measures,
                                        const tm_poly_arrays *mesh, tm_error *error)
{
    tm_poly_centroids m;
    tm_status status = tm_poly_centroids_find(&m, mesh, error);
    double *volume = tm_new(mesh->cells, sizeof *volume);
    if (status == TM_OK && !volume)
        status = tm_fail_memory(error);
    *measures = (tm_poly_finite_volume){.max_bend = m.max_bend};
    if (status == TM_OK && volume) {
        judge_facets(&m, measures);
        tm_poly_all_geometry(&m, measures);
        judge_cells(&m, volume, measures);
    }
    tm_poly_centroids_free(&m);
    free(volume);
    return status;
}
