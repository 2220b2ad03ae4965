/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_finite_volume.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    double centre[3], area[3]; /* of a facet; outward from its first cell */
} face;

typedef struct {
    double centre[3], volume;
    double mean[3]; /* of the centroids of its facets */
    double low[3], high[3];
    size_t facets;
} cell;

typedef struct {
    const tm_poly_arrays *mesh;
    face *face;
    cell *cell;
} measuring;

static const double *corner(const tm_poly_arrays *mesh, size_t f, size_t i)
{
    return mesh->xyz[mesh->facet_node[mesh->facet_start[f] + i]];
}

static size_t corners(const tm_poly_arrays *mesh, size_t f)
{
    return mesh->facet_start[f + 1] - mesh->facet_start[f];
}

/* The centroid and area of a facet by its triangles around the mean of its nodes; returns
 * the sum of their areas. */
static double measure_face(const tm_poly_arrays *mesh, size_t f, face *out)
{
    const size_t count = corners(mesh, f);
    double mean[3] = {0}, moment[3] = {0}, sum = 0;
    *out = (face){{0}, {0}};
    for (size_t i = 0; i < count; i++)
        for (int x = 0; x < 3; x++)
            mean[x] += corner(mesh, f, i)[x] / (double)count;
    for (size_t i = 0; i < count; i++) {
        const double *a = corner(mesh, f, i), *b = corner(mesh, f, (i + 1) % count);
        double normal[3];
        tm_triangle_normal(normal, a, b, mean);
        double area = tm_norm(normal) / 2;
        sum += area;
        for (int x = 0; x < 3; x++) {
            out->area[x] += normal[x] / 2;
            moment[x] += area * (a[x] + b[x] + mean[x]) / 3;
        }
    }
    for (int x = 0; x < 3; x++)
        out->centre[x] = sum > 0 ? moment[x] / sum : mean[x];
    return sum;
}

/* Whether the facet is one of the cells that it names. */
static bool fits(const tm_poly_arrays *mesh, size_t f)
{
    return corners(mesh, f) >= 3 && mesh->side[f][0] < mesh->cells &&
           (mesh->side[f][1] == TM_NONE || mesh->side[f][1] < mesh->cells);
}

/* Calls a function for each cell of each facet; `sign` is 1 for the first one. */
static void for_sides(const measuring *m,
                      void (*visit)(const measuring *, size_t f, cell *c, double sign))
{
    for (size_t f = 0; f < m->mesh->facets; f++)
        for (int s = 0; s < 2 && fits(m->mesh, f); s++)
            if (m->mesh->side[f][s] != TM_NONE)
                visit(m, f, &m->cell[m->mesh->side[f][s]], s == 0 ? 1 : -1);
}

static void add_face(const measuring *m, size_t f, cell *c, double sign)
{
    (void)sign;
    c->facets++;
    for (int x = 0; x < 3; x++)
        c->mean[x] += m->face[f].centre[x];
    for (size_t i = 0; i < corners(m->mesh, f); i++)
        for (int x = 0; x < 3; x++) {
            c->low[x] = fmin(c->low[x], corner(m->mesh, f, i)[x]);
            c->high[x] = fmax(c->high[x], corner(m->mesh, f, i)[x]);
        }
}

/* Three times the volume of the pyramid of a facet and a point. */
static double pyramid(const face *f, const double apex[3], double sign)
{
    double to[3];
    tm_subtract(to, f->centre, apex);
    return sign * tm_dot(f->area, to);
}

static void add_pyramid(const measuring *m, size_t f, cell *c, double sign)
{
    double volume = pyramid(&m->face[f], c->mean, sign);
    c->volume += volume / 3;
    for (int x = 0; x < 3; x++)
        c->centre[x] += volume * (3 * m->face[f].centre[x] + c->mean[x]) / 4;
}

static void measure_cells(const measuring *m)
{
    for (size_t c = 0; c < m->mesh->cells; c++)
        for (int x = 0; x < 3; x++) {
            m->cell[c].low[x] = HUGE_VAL;
            m->cell[c].high[x] = -HUGE_VAL;
        }
    for_sides(m, add_face);
    for (size_t c = 0; c < m->mesh->cells; c++)
        for (int x = 0; x < 3 && m->cell[c].facets > 0; x++)
            m->cell[c].mean[x] /= (double)m->cell[c].facets;
    for_sides(m, add_pyramid);
    for (size_t c = 0; c < m->mesh->cells; c++)
        for (int x = 0; x < 3; x++)
            m->cell[c].centre[x] = m->cell[c].volume != 0
                                       ? m->cell[c].centre[x] / (3 * m->cell[c].volume)
                                       : m->cell[c].mean[x];
}

/* Whether a point sees all triangles of a facet around its centroid. */
static bool sees(const measuring *m, size_t f, const double point[3], double sign)
{
    const size_t count = corners(m->mesh, f);
    for (size_t i = 0; i < count; i++) {
        const double *a = corner(m->mesh, f, i);
        const double *b = corner(m->mesh, f, (i + 1) % count);
        if (!(sign * tm_tet_volume(a, b, m->face[f].centre, point) < 0))
            return false;
    }
    return true;
}

/* How far the line from `from` along d misses the centroid of a facet, by the facet's
 * extent that way, or `least` of the line's length where that is more. */
static double skewness_of(const measuring *m, size_t f, const double from[3],
                          const double d[3], double least)
{
    const face *at = &m->face[f];
    double to[3], miss[3], direction[3];
    tm_subtract(to, at->centre, from);
    double along = tm_dot(at->area, d);
    double share = along != 0 ? tm_dot(at->area, to) / along : 0;
    for (int x = 0; x < 3; x++)
        miss[x] = to[x] - share * d[x];
    double length = tm_norm(miss), extent = least * tm_norm(d);
    for (size_t i = 0; i < corners(m->mesh, f) && length > 0; i++) {
        tm_subtract(direction, corner(m->mesh, f, i), at->centre);
        extent = fmax(extent, fabs(tm_dot(miss, direction)) / length);
    }
    return extent > 0 ? length / extent : 0;
}

static void judge_inner(const measuring *m, size_t f, tm_poly_finite_volume *out)
{
    const double half_turn = 180, pi = acos(-1), least = 0.2;
    const cell *c = &m->cell[m->mesh->side[f][0]], *e = &m->cell[m->mesh->side[f][1]];
    double d[3];
    tm_subtract(d, e->centre, c->centre);
    double lengths = tm_norm(d) * tm_norm(m->face[f].area);
    double cosine = lengths > 0 ? tm_dot(d, m->face[f].area) / lengths : 1;
    double angle = acos(fmax(-1, fmin(1, cosine))) * half_turn / pi;
    double skew = skewness_of(m, f, c->centre, d, least);
    out->max_non_orthogonality = fmax(out->max_non_orthogonality, angle);
    out->mean_non_orthogonality += angle;
    out->non_orthogonal += angle > TM_FV_NON_ORTHOGONALITY;
    out->max_skewness = fmax(out->max_skewness, skew);
    out->skew += skew > TM_FV_SKEWNESS;
}

/* On the boundary the line is along the normal. */
static void judge_outer(const measuring *m, size_t f, tm_poly_finite_volume *out)
{
    const double least = 0.4;
    const cell *c = &m->cell[m->mesh->side[f][0]];
    const double *area = m->face[f].area, area2 = tm_norm2(area);
    double to[3], d[3];
    tm_subtract(to, m->face[f].centre, c->centre);
    for (int x = 0; x < 3; x++)
        d[x] = area2 > 0 ? area[x] * tm_dot(area, to) / area2 : 0;
    double skew = skewness_of(m, f, c->centre, d, least);
    out->max_skewness = fmax(out->max_skewness, skew);
    out->skew += skew > TM_FV_SKEWNESS;
}

static void judge_facets(const measuring *m, tm_poly_finite_volume *out)
{
    size_t inner = 0;
    for (size_t f = 0; f < m->mesh->facets; f++) {
        bool unseen = false;
        if (!fits(m->mesh, f))
            continue;
        for (int s = 0; s < 2; s++) {
            uint32_t c = m->mesh->side[f][s];
            double sign = s == 0 ? 1 : -1;
            if (c == TM_NONE)
                continue;
            out->wrong_pyramids += !(pyramid(&m->face[f], m->cell[c].centre, sign) > 0);
            unseen |= !sees(m, f, m->cell[c].centre, sign);
        }
        out->unseen += unseen;
        inner += m->mesh->side[f][1] != TM_NONE;
        if (m->mesh->side[f][1] != TM_NONE)
            judge_inner(m, f, out);
        else
            judge_outer(m, f, out);
    }
    if (inner > 0)
        out->mean_non_orthogonality /= (double)inner;
}

static int compare(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

static void judge_cells(const measuring *m, double *volume, tm_poly_finite_volume *out)
{
    const double few = 0.05;
    const size_t cells = m->mesh->cells;
    for (size_t c = 0; c < cells; c++) {
        volume[c] = m->cell[c].volume;
        if (m->cell[c].facets > 0)
            out->max_diameter = fmax(out->max_diameter,
                                     sqrt(tm_distance2(m->cell[c].low, m->cell[c].high)));
    }
    qsort(volume, cells, sizeof *volume, compare);
    if (cells > 0) {
        size_t low = (size_t)(few * (double)(cells - 1));
        out->volume_spread =
            volume[low] > 0 ? volume[cells - 1 - low] / volume[low] : HUGE_VAL;
    }
}

/* Makes room and measures facets and cells. */
static bool start(measuring *m, const tm_poly_arrays *mesh, double *max_bend)
{
    *m = (measuring){.mesh = mesh,
                     .face = tm_new(mesh->facets, sizeof *m->face),
                     .cell = calloc(mesh->cells + 1, sizeof *m->cell)};
    if (!m->face || !m->cell)
        return false;
    for (size_t f = 0; f < mesh->facets; f++) {
        double sum = measure_face(mesh, f, &m->face[f]);
        if (sum > 0)
            *max_bend = fmax(*max_bend, 1 - tm_norm(m->face[f].area) / sum);
    }
    measure_cells(m);
    return true;
}

tm_status tm_poly_find_unseen(bool *unseen, const tm_poly_arrays *mesh, tm_error *error)
{
    measuring m;
    double max_bend = 0;
    bool done = start(&m, mesh, &max_bend);
    for (size_t c = 0; c < mesh->cells; c++)
        unseen[c] = false;
    for (size_t f = 0; f < mesh->facets && done; f++)
        for (int s = 0; s < 2 && fits(mesh, f); s++) {
            const uint32_t c = mesh->side[f][s];
            const double sign = s == 0 ? 1 : -1;
            if (c != TM_NONE)
                unseen[c] |= !sees(&m, f, m.cell[c].centre, sign) ||
                             !(pyramid(&m.face[f], m.cell[c].centre, sign) > 0);
        }
    free(m.face);
    free(m.cell);
    return done ? TM_OK : tm_fail_memory(error);
}

tm_status tm_poly_finite_volume_measure(tm_poly_finite_volume *measures,
                                        const tm_poly_arrays *mesh, tm_error *error)
{
    measuring m;
    double *volume = tm_new(mesh->cells, sizeof *volume);
    *measures = (tm_poly_finite_volume){0};
    bool done = start(&m, mesh, &measures->max_bend) && volume;
    if (done) {
        judge_facets(&m, measures);
        judge_cells(&m, volume, measures);
    }
    free(m.face);
    free(m.cell);
    free(volume);
    return done ? TM_OK : tm_fail_memory(error);
}
