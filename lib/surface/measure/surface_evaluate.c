/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_evaluate.h"

#include "../../geom/vector.h"
#include "../point_table.h"

#include <string.h>

bool tm_surface_find_known(const tm_polygon_surface *polygons, const tm_block *node,
                           bool *known, size_t *unknown)
{
    tm_point_table table = {0};
    const bool ok = tm_point_table_fill(&table, polygons->xyz, polygons->nodes);
    *unknown = 0;
    for (size_t v = 0; v < node->count && ok; v++) {
        known[v] =
            tm_point_table_find(&table, polygons->xyz, node->real + 3 * v) != UINT32_MAX;
        *unknown += !known[v];
    }
    tm_point_table_free(&table);
    return ok;
}

/* How much of a triangle is beside the edge from a to b, seen from p: along its normal.
 */
static double part_of(const double normal[3], const double a[3], const double b[3],
                      const double p[3])
{
    double beside[3];
    tm_triangle_normal(beside, a, b, p);
    return fmax(tm_dot(normal, beside), 0);
}

/* The weights of the corners at p, which is in the triangle or on its border. */
static void find_weights(const tm_surface *surface, uint32_t t, const double p[3],
                         double weight[3])
{
    const uint32_t *v = surface->triangle[t];
    const double *x[3] = {surface->xyz[v[0]], surface->xyz[v[1]], surface->xyz[v[2]]};
    double normal[3], sum = 0;
    tm_triangle_normal(normal, x[0], x[1], x[2]);
    for (int i = 0; i < 3; i++)
        sum += weight[i] = part_of(normal, x[(i + 1) % 3], x[(i + 2) % 3], p);
    for (int i = 0; i < 3; i++)
        weight[i] = sum > 0 ? weight[i] / sum : 1.0 / 3;
}

void tm_surface_evaluate(const tm_surface *surface, const tm_polygon_surface *polygons,
                         tm_block *node, bool *known)
{
    static const double near = 1e-8; /* TetGen takes so for one plane */
    const size_t k = polygons->attributes;
    const double most2 = near * near * tm_distance2(surface->low, surface->high);
    tm_surface_point at = {.triangle = TM_NONE};
    for (size_t v = 0; v < node->count; v++) {
        const double *p = node->real + 3 * v;
        double weight[3];
        if (known[v])
            continue;
        tm_surface_closest(surface, p, TM_NONE, &at);
        if (at.distance2 > most2)
            continue;
        find_weights(surface, at.triangle, at.xyz, weight);
        known[v] = true;
        for (size_t a = 0; a < k; a++) {
            double sum = 0;
            for (int i = 0; i < 3; i++) {
                const uint32_t corner = surface->triangle[at.triangle][i];
                sum += weight[i] * polygons->attribute[k * surface->origin[corner] + a];
            }
            node->attribute[k * v + a] = sum;
        }
    }
}
