/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_finite_volume.h"

#include "poly_all_geometry.h"
#include "poly_centroids.h"
#include "poly_parts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"

#include <math.h>
#include <stdlib.h>

/* Facets, or cells, that are judged at a time. The sum of angles is rounded chunk by
 * chunk; ranks' slices are made of whole ones (slice.h). */
enum { CHUNK = 1024 };

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

static void judge_pyramids(const tm_poly_centroids *m, size_t f,
                           tm_poly_finite_volume *out)
{
    for (int s = 0; s < 2; s++) {
        const uint32_t c = m->mesh->side[f][s];
        const double sign = s == 0 ? 1 : -1;
        if (c == TM_NONE)
            continue;
        const double pyramid = tm_facet_pyramid(&m->face[f], m->cell[c].centre, sign) / 3;
        out->min_pyramid = fmin(out->min_pyramid, pyramid);
        out->wrong_pyramids += !(pyramid > 0);
    }
}

static void judge_facet(const tm_poly_centroids *m, size_t f, tm_fv_sums *sums)
{
    tm_poly_finite_volume *out = &sums->of;
    judge_pyramids(m, f, out);
    const double skew = tm_facet_skewness(m, f);
    out->max_skewness = fmax(out->max_skewness, skew);
    out->skew += skew > TM_FV_SKEWNESS;
    sums->facets++;
    if (m->mesh->side[f][1] == TM_NONE)
        return;
    sums->inside++;
    judge_inner(m, f, out);
}

/* Sums ------------------------------------------------------------------------------ */

void tm_fv_sums_begin(tm_fv_sums *sums)
{
    *sums = (tm_fv_sums){.of = {.min_pyramid = HUGE_VAL,
                                .min_weight = HUGE_VAL,
                                .min_volume_ratio = HUGE_VAL,
                                .min_determinant = HUGE_VAL}};
}

static void add(tm_fv_sums *sums, const tm_fv_sums *s)
{
    tm_poly_finite_volume *sum = &sums->of;
    const tm_poly_finite_volume *of = &s->of;
    sums->facets += s->facets;
    sums->inside += s->inside;
    sum->max_non_orthogonality =
        fmax(sum->max_non_orthogonality, of->max_non_orthogonality);
    sum->mean_non_orthogonality += of->mean_non_orthogonality;
    sum->non_orthogonal += of->non_orthogonal;
    sum->reversed += of->reversed;
    sum->max_skewness = fmax(sum->max_skewness, of->max_skewness);
    sum->skew += of->skew;
    sum->min_pyramid = fmin(sum->min_pyramid, of->min_pyramid);
    sum->wrong_pyramids += of->wrong_pyramids;
    sum->max_bend = fmax(sum->max_bend, of->max_bend);
    sum->unseen += of->unseen;
    sum->no_fan += of->no_fan;
    sum->min_weight = fmin(sum->min_weight, of->min_weight);
    sum->small_weights += of->small_weights;
    sum->min_volume_ratio = fmin(sum->min_volume_ratio, of->min_volume_ratio);
    sum->small_volume_ratios += of->small_volume_ratios;
    sum->min_determinant = fmin(sum->min_determinant, of->min_determinant);
    sum->small_determinants += of->small_determinants;
    sum->concave += of->concave;
}

void tm_fv_sums_add(tm_fv_sums *sums, const tm_fv_sums *chunk, size_t chunks)
{
    for (size_t i = 0; i < chunks; i++)
        add(sums, &chunk[i]);
}

void tm_fv_sums_finish(tm_fv_sums *sums, size_t cells)
{
    tm_poly_finite_volume *of = &sums->of;
    if (sums->facets == 0)
        of->min_pyramid = 0;
    if (sums->inside > 0)
        of->mean_non_orthogonality /= (double)sums->inside;
    else
        of->min_weight = of->min_volume_ratio = 0;
    if (cells == 0)
        of->min_determinant = 0;
}

typedef struct judging {
    const tm_poly_centroids *m;
    tm_fv_judged what;
    tm_fv_sums *chunk; /* one for each CHUNK */
} judging;

static void judge_chunk(void *context, size_t first, size_t past)
{
    const judging *j = context;
    tm_fv_sums sums;
    tm_fv_sums_begin(&sums);
    for (size_t i = first; i < past; i++) {
        if (j->what == TM_FV_CELLS) {
            tm_cell_all_geometry(j->m, i, &sums.of);
            continue;
        }
        if (!tm_facet_fits(j->m->mesh, i))
            continue;
        judge_facet(j->m, i, &sums);
        if (j->what == TM_FV_FACETS)
            tm_facet_all_geometry(j->m, i, &sums.of);
    }
    j->chunk[first / CHUNK] = sums;
}

tm_status tm_fv_judge(tm_fv_sums **chunk, size_t *chunks, const tm_poly_centroids *m,
                      tm_fv_judged what, size_t count, unsigned threads, tm_error *error)
{
    *chunks = tm_parallel_chunks(count, CHUNK);
    *chunk = tm_new(*chunks, sizeof **chunk);
    if (!*chunk)
        return tm_fail_memory(error);
    judging j = {m, what, *chunk};
    tm_parallel_runs(threads, count, CHUNK, judge_chunk, &j);
    return TM_OK;
}

/* Of a mesh ------------------------------------------------------------------------- */

static tm_status judge(tm_fv_sums *sums, const tm_poly_centroids *m, tm_fv_judged what,
                       unsigned threads, tm_error *error)
{
    tm_fv_sums *chunk;
    size_t chunks;
    const tm_status status = tm_fv_judge(
        &chunk, &chunks, m, what, what == TM_FV_CELLS ? m->mesh->cells : m->mesh->facets,
        threads, error);
    if (status == TM_OK)
        tm_fv_sums_add(sums, chunk, chunks);
    free(chunk);
    return status;
}

tm_status tm_poly_finite_volume_check(tm_poly_finite_volume *measures,
                                      const tm_poly_arrays *mesh, tm_error *error)
{
    tm_poly_centroids m;
    tm_fv_sums sums;
    tm_status status = tm_poly_centroids_find(&m, mesh, error);
    tm_fv_sums_begin(&sums);
    sums.of.max_bend = m.max_bend;
    if (status == TM_OK)
        status = judge(&sums, &m, TM_FV_FACETS_CHECKED, 1, error);
    tm_fv_sums_finish(&sums, 0);
    sums.of.min_weight = sums.of.min_volume_ratio = 0;
    *measures = sums.of;
    tm_poly_centroids_free(&m);
    return status;
}

size_t tm_fv_few(size_t cells)
{
    const double few = 0.05;
    return cells > 0 ? (size_t)(few * (double)(cells - 1)) : 0;
}

double tm_fv_spread(double low, double high)
{
    return low > 0 ? high / low : HUGE_VAL;
}

static double spread_of(const tm_poly_centroids *m, double *volume)
{
    const size_t cells = m->mesh->cells, few = tm_fv_few(cells);
    for (size_t c = 0; c < cells; c++)
        volume[c] = m->cell[c].volume;
    qsort(volume, cells, sizeof *volume, tm_compare_reals);
    return cells > 0 ? tm_fv_spread(volume[few], volume[cells - 1 - few]) : 0;
}

tm_status tm_poly_finite_volume_measure(tm_poly_finite_volume *measures,
                                        const tm_poly_arrays *mesh, unsigned threads,
                                        tm_error *error)
{
    tm_poly_centroids m;
    tm_fv_sums sums;
    tm_status status = tm_poly_centroids_find(&m, mesh, error);
    double *volume = tm_new(mesh->cells, sizeof *volume);
    if (status == TM_OK && !volume)
        status = tm_fail_memory(error);
    tm_fv_sums_begin(&sums);
    sums.of.max_bend = m.max_bend;
    if (status == TM_OK)
        status = judge(&sums, &m, TM_FV_FACETS, threads, error);
    if (status == TM_OK)
        status = judge(&sums, &m, TM_FV_CELLS, threads, error);
    tm_fv_sums_finish(&sums, mesh->cells);
    if (status == TM_OK && volume)
        sums.of.volume_spread = spread_of(&m, volume);
    *measures = sums.of;
    tm_poly_centroids_free(&m);
    free(volume);
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
