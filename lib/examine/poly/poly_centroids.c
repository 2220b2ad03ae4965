/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_centroids.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>

/* A triangle needs no others. */
static double measure_triangle(const tm_poly_arrays *mesh, size_t f,
                               tm_facet_centroid *out)
{
    const double *a = tm_facet_corner(mesh, f, 0), *b = tm_facet_corner(mesh, f, 1);
    const double *c = tm_facet_corner(mesh, f, 2);
    tm_triangle_normal(out->area, a, b, c);
    for (int x = 0; x < 3; x++) {
        out->area[x] /= 2;
        out->centre[x] = (a[x] + b[x] + c[x]) / 3;
    }
    out->size = tm_norm(out->area);
    return 0;
}

/* The centroid and area of a facet by its triangles around the mean of its nodes; returns
 * the sum of their areas, 0 where that is not needed. */
static double measure_face(const tm_poly_arrays *mesh, size_t f, tm_facet_centroid *out)
{
    const size_t count = tm_facet_corners(mesh, f);
    double mean[3] = {0}, moment[3] = {0}, sum = 0;
    if (count == 3)
        return measure_triangle(mesh, f, out);
    *out = (tm_facet_centroid){.size = 0};
    for (size_t i = 0; i < count; i++)
        for (int x = 0; x < 3; x++)
            mean[x] += tm_facet_corner(mesh, f, i)[x] / (double)count;
    for (size_t i = 0; i < count; i++) {
        const double *a = tm_facet_corner(mesh, f, i),
                     *b = tm_facet_corner(mesh, f, (i + 1) % count);
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
    out->size = tm_norm(out->area);
    return sum;
}

/* Calls a function for each cell of each facet; `sign` is 1 for the first one. */
static void for_sides(const tm_poly_centroids *m,
                      void (*visit)(const tm_poly_centroids *, size_t f,
                                    tm_cell_centroid *c, double sign))
{
    for (size_t f = 0; f < m->mesh->facets; f++)
        for (int s = 0; s < 2 && tm_facet_fits(m->mesh, f); s++)
            if (m->mesh->side[f][s] != TM_NONE)
                visit(m, f, &m->cell[m->mesh->side[f][s]], s == 0 ? 1 : -1);
}

static void add_face(const tm_poly_centroids *m, size_t f, tm_cell_centroid *c,
                     double sign)
{
    (void)sign;
    c->facets++;
    for (int x = 0; x < 3; x++)
        c->mean[x] += m->face[f].centre[x];
}

static void add_pyramid(const tm_poly_centroids *m, size_t f, tm_cell_centroid *c,
                        double sign)
{
    double volume = tm_facet_pyramid(&m->face[f], c->mean, sign);
    c->volume += volume / 3;
    for (int x = 0; x < 3; x++)
        c->centre[x] += volume * (3 * m->face[f].centre[x] + c->mean[x]) / 4;
}

static void finish_mean(tm_cell_centroid *c)
{
    for (int x = 0; x < 3 && c->facets > 0; x++)
        c->mean[x] /= (double)c->facets;
}

static void finish_centre(tm_cell_centroid *c)
{
    for (int x = 0; x < 3; x++)
        c->centre[x] = c->volume != 0 ? c->centre[x] / (3 * c->volume) : c->mean[x];
}

static void measure_cells(const tm_poly_centroids *m)
{
    for_sides(m, add_face);
    for (size_t c = 0; c < m->mesh->cells; c++)
        finish_mean(&m->cell[c]);
    for_sides(m, add_pyramid);
    for (size_t c = 0; c < m->mesh->cells; c++)
        finish_centre(&m->cell[c]);
}

tm_status tm_poly_centroids_find_facets(tm_poly_centroids *c, const tm_poly_arrays *mesh,
                                        tm_error *error)
{
    *c = (tm_poly_centroids){.mesh = mesh, .face = tm_new(mesh->facets, sizeof *c->face)};
    if (!c->face)
        return tm_fail_memory(error);
    for (size_t f = 0; f < mesh->facets; f++) {
        const double sum = measure_face(mesh, f, &c->face[f]);
        if (sum > 0)
            c->max_bend = fmax(c->max_bend, 1 - c->face[f].size / sum);
    }
    return TM_OK;
}

tm_status tm_poly_centroids_find(tm_poly_centroids *c, const tm_poly_arrays *mesh,
                                 tm_error *error)
{
    const tm_status status = tm_poly_centroids_find_facets(c, mesh, error);
    if (status != TM_OK)
        return status;
    c->cell = calloc(mesh->cells + 1, sizeof *c->cell);
    if (!c->cell)
        return tm_fail_memory(error);
    measure_cells(c);
    return TM_OK;
}

void tm_facet_centroid_find(const tm_poly_centroids *c, size_t f)
{
    measure_face(c->mesh, f, &c->face[f]);
}

void tm_cell_centroid_find(const tm_poly_centroids *c, size_t cell)
{
    const tm_poly_arrays *mesh = c->mesh;
    const size_t begin = mesh->cell_start[cell], end = mesh->cell_start[cell + 1];
    tm_cell_centroid *out = &c->cell[cell];
    *out = (tm_cell_centroid){{0}, 0, {0}, 0};
    for (size_t i = begin; i < end; i++)
        add_face(c, mesh->cell_facet[i], out, 0);
    finish_mean(out);
    for (size_t i = begin; i < end; i++) {
        const uint32_t f = mesh->cell_facet[i];
        add_pyramid(c, f, out, mesh->side[f][0] == cell ? 1 : -1);
    }
    finish_centre(out);
}

void tm_poly_centroids_free(tm_poly_centroids *c)
{
    free(c->face);
    free(c->cell);
    *c = (tm_poly_centroids){0};
}
