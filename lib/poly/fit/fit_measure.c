/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fit_parts.h"

#include "../../geom/vector.h"

#include <math.h>

static size_t corners(const tm_poly_arrays *mesh, size_t f)
{
    return mesh->facet_start[f + 1] - mesh->facet_start[f];
}

static const double *corner(const tm_poly_arrays *mesh, size_t f, size_t i)
{
    return mesh->xyz[mesh->facet_node[mesh->facet_start[f] + i]];
}

/* By its triangles around the mean of its nodes. */
void tm_fit_measure_facet(const tm_fit_mesh *m, size_t f)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t count = corners(mesh, f);
    double mean[3] = {0}, moment[3] = {0}, sum = 0;
    tm_fit_facet *out = &m->facet[f];
    *out = (tm_fit_facet){{0}, {0}};
    for (size_t i = 0; i < count; i++)
        for (int x = 0; x < 3; x++)
            mean[x] += corner(mesh, f, i)[x] / (double)count;
    for (size_t i = 0; i < count; i++) {
        const double *a = corner(mesh, f, i), *b = corner(mesh, f, (i + 1) % count);
        double normal[3];
        tm_triangle_normal(normal, a, b, mean);
        const double area = tm_norm(normal) / 2;
        sum += area;
        for (int x = 0; x < 3; x++) {
            out->area[x] += normal[x] / 2;
            moment[x] += area * (a[x] + b[x] + mean[x]) / 3;
        }
    }
    for (int x = 0; x < 3; x++)
        out->centre[x] = sum > 0 ? moment[x] / sum : mean[x];
}

static double sign_of(const tm_fit_mesh *m, size_t f, size_t c)
{
    return m->mesh->side[f][0] == c ? 1 : -1;
}

/* By the pyramids of its facets and the mean of their centroids. */
void tm_fit_measure_cell(const tm_fit_mesh *m, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t from = mesh->cell_start[c], past = mesh->cell_start[c + 1];
    double mean[3] = {0}, moment[3] = {0}, sum = 0;
    for (size_t i = from; i < past; i++)
        for (int x = 0; x < 3; x++)
            mean[x] += m->facet[mesh->cell_facet[i]].centre[x] / (double)(past - from);
    for (size_t i = from; i < past; i++) {
        const size_t f = mesh->cell_facet[i];
        double to[3];
        tm_subtract(to, m->facet[f].centre, mean);
        const double volume = sign_of(m, f, c) * tm_dot(m->facet[f].area, to) / 3;
        sum += volume;
        for (int x = 0; x < 3; x++)
            moment[x] += volume * (3 * m->facet[f].centre[x] + mean[x]) / 4;
    }
    m->cell[c].volume = sum;
    for (int x = 0; x < 3; x++)
        m->cell[c].centre[x] = sum != 0 ? moment[x] / sum : mean[x];
}

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
static double sine(const tm_fit_mesh *m, size_t f, size_t c, const double point[3])
{
    double to[3];
    tm_subtract(to, point, m->cell[c].centre);
    const double lengths = tm_norm(to) * tm_norm(m->facet[f].area);
    return lengths > 0 ? sign_of(m, f, c) * tm_dot(m->facet[f].area, to) / lengths : 0;
}

static double least_sine(const tm_fit_mesh *m, size_t f, size_t c)
{
    double least = 1;
    for (size_t i = 0; i < corners(m->mesh, f); i++)
        least = fmin(least, sine(m, f, c, corner(m->mesh, f, i)));
    return least;
}

/* The least of the tetrahedra that a facet's triangles around a point, but for those of
 * its node `base`, make with the centroids of the cells beside it; by the facet's area
 * and how far these are. */
static double least_tetrahedron(const tm_fit_mesh *m, size_t f, const double point[3],
                                size_t base)
{
    const tm_poly_arrays *mesh = m->mesh;
    const size_t count = corners(mesh, f);
    double least = HUGE_VAL, to[2][3], scale[2];
    for (int s = 0; s < 2; s++) {
        const uint32_t c = mesh->side[f][s];
        if (c != TM_NONE)
            tm_subtract(to[s], point, m->cell[c].centre);
        scale[s] = c == TM_NONE
                       ? 0
                       : (s == 0 ? 1 : -1) * tm_norm(to[s]) * tm_norm(m->facet[f].area);
    }
    for (size_t i = 0; i < count; i++) {
        double normal[3];
        if (i == base || (i + 1) % count == base)
            continue;
        tm_triangle_normal(normal, point, corner(mesh, f, i),
                           corner(mesh, f, (i + 1) % count));
        for (int s = 0; s < 2; s++)
            if (scale[s] != 0)
                least = fmin(least, tm_dot(normal, to[s]) / scale[s]);
    }
    return least;
}

/* Both of the facet's centroid and, at best, of one of its nodes. */
static double least_of_tetrahedra(const tm_fit_mesh *m, size_t f)
{
    const size_t count = corners(m->mesh, f);
    double best = -HUGE_VAL;
    for (size_t base = 0; base < count; base++)
        best = fmax(best, least_tetrahedron(m, f, corner(m->mesh, f, base), base));
    return fmin(best, least_tetrahedron(m, f, m->facet[f].centre, count));
}

static void judge_line(const tm_fit_mesh *m, size_t f, tm_fit_sum *sum)
{
    const double least_cosine = 0.34202014332566873; /* of 70 degrees */
    const double least_weight = 0.05, least_ratio = 0.01, margin = 0.01;
    const tm_fit_cell *c = &m->cell[m->mesh->side[f][0]],
                      *e = &m->cell[m->mesh->side[f][1]];
    const double *area = m->facet[f].area;
    double d[3], near[3], far[3];
    tm_subtract(d, e->centre, c->centre);
    tm_subtract(near, m->facet[f].centre, c->centre);
    tm_subtract(far, e->centre, m->facet[f].centre);
    const double lengths = tm_norm(d) * tm_norm(area);
    const double a = fabs(tm_dot(area, near)), b = fabs(tm_dot(area, far));
    ask(sum, TM_FIT_OBLIQUE, lengths > 0 ? tm_dot(d, area) / lengths : 0, least_cosine,
        margin);
    ask(sum, TM_FIT_UNEVEN, a + b > 0 ? fmin(a, b) / (a + b) : 0, least_weight, margin);
    const double most = fmax(c->volume, e->volume);
    ask(sum, TM_FIT_UNEQUAL, most > 0 ? fmin(c->volume, e->volume) / most : 0,
        least_ratio, margin / 2);
}

void tm_fit_judge_facet(const tm_fit_mesh *m, size_t f, tm_fit_sum *sum)
{
    const double least = 0.01, tetrahedra = 0.002;
    for (int s = 0; s < 2; s++) {
        const uint32_t c = m->mesh->side[f][s];
        if (c == TM_NONE)
            continue;
        ask(sum, TM_FIT_PYRAMID, sine(m, f, c, m->facet[f].centre), 0, least);
        ask(sum, TM_FIT_BENT, least_sine(m, f, c), 0, least);
    }
    ask(sum, TM_FIT_TETRAHEDRA, least_of_tetrahedra(m, f), 0, tetrahedra);
    if (m->mesh->side[f][1] != TM_NONE)
        judge_line(m, f, sum);
}

/* The determinant of the sum of the squares of the areas of inner facets, of which the
 * mean is 1, where that of a cube is 1: 0 where they all are in one direction. */
static double determinant(const tm_fit_mesh *m, size_t c)
{
    const tm_poly_arrays *mesh = m->mesh;
    double mean = 0, t[3][3] = {{0}};
    size_t inner = 0;
    for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
        const size_t f = mesh->cell_facet[i];
        if (mesh->side[f][1] == TM_NONE)
            continue;
        inner++;
        mean += tm_norm(m->facet[f].area);
        for (int x = 0; x < 3; x++)
            for (int y = 0; y < 3; y++)
                t[x][y] += m->facet[f].area[x] * m->facet[f].area[y];
    }
    mean /= (double)inner;
    double cross[3];
    tm_cross(cross, t[1], t[2]);
    return inner > 0 ? tm_dot(t[0], cross) / (8 * pow(mean, 6)) : 0;
}

void tm_fit_judge_cell(const tm_fit_mesh *m, size_t c, tm_fit_sum *sum)
{
    const double limit = 1e-6, margin = 1e-4;
    const tm_poly_arrays *mesh = m->mesh;
    tm_fit_sum pairs = {{0}, 0};
    for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
        const size_t f = mesh->cell_facet[i];
        const double length = sign_of(m, f, c) * tm_norm(m->facet[f].area);
        for (size_t k = mesh->cell_start[c]; k < mesh->cell_start[c + 1]; k++) {
            if (k == i)
                continue;
            double to[3];
            tm_subtract(to, m->facet[f].centre, m->facet[mesh->cell_facet[k]].centre);
            ask(&pairs, TM_FIT_CONCAVE,
                tm_dot(m->facet[f].area, to) / (length * tm_norm(to)), limit, margin);
        }
    }
    ask(sum, TM_FIT_UNDETERMINED, determinant(m, c), 0.001, 0.001);
    sum->missing += pairs.missing;
    sum->count[TM_FIT_CONCAVE] += pairs.count[TM_FIT_CONCAVE] > 0;
}
