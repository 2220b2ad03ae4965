/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_curvature.h"

#include "../../geom/vector.h"
#include "../surface_parts.h"

#include <math.h>

/* The angle between two vectors. */
static double angle_between(const double a[3], const double b[3])
{
    double cross[3];
    tm_cross(cross, a, b);
    return atan2(tm_norm(cross), tm_dot(a, b));
}

/* The height of a triangle over its edge from corner i. */
static double height_over(const tm_surface *s, size_t t, unsigned i)
{
    const uint32_t *v = s->triangle[t];
    double normal[3];
    tm_triangle_normal(normal, s->xyz[v[0]], s->xyz[v[1]], s->xyz[v[2]]);
    const double edge2 = tm_distance2(s->xyz[v[i]], s->xyz[v[(i + 1) % 3]]);
    return edge2 > 0 ? tm_norm(normal) / sqrt(edge2) : 0;
}

/* What the normal turns across edge i of triangle t; 0 where that is open or sharp, or a
 * triangle has no normal of its own. */
static double turn_across(const tm_surface *s, uint32_t t, unsigned i)
{
    const uint32_t n = s->across[t][i];
    double a[3], b[3];
    if (n == TM_NONE || s->patch[n] != s->patch[t] || !tm_surface_own_normal(s, t, a) ||
        !tm_surface_own_normal(s, n, b))
        return 0;
    return angle_between(a, b);
}

/* How far the middle of a triangle is from its edge i: a third of its height; half where
 * it is part of a flat quadrilateral, across one of the other edges. */
static double middle_from(const tm_surface *s, uint32_t t, unsigned i)
{
    const double thirds = 3, halves = 2, flat = 0.05;
    const double turn = turn_across(s, t, i);
    const bool is_part = turn_across(s, t, (i + 1) % 3) < flat * turn ||
                         turn_across(s, t, (i + 2) % 3) < flat * turn;
    return height_over(s, t, i) / (is_part ? halves : thirds);
}

void tm_surface_find_curvature(const tm_surface *surface, double *curvature)
{
    const tm_surface *s = surface;
    for (size_t t = 0; t < s->triangles; t++)
        curvature[t] = 0;
    for (uint32_t t = 0; t < s->triangles; t++)
        for (unsigned i = 0; i < 3; i++) {
            const uint32_t n = s->across[t][i];
            const double turn = n != TM_NONE && n > t ? turn_across(s, t, i) : 0;
            if (turn == 0)
                continue;
            const double apart =
                middle_from(s, t, i) + middle_from(s, n, tm_surface_side(s, n, t));
            curvature[t] = fmax(curvature[t], turn / apart);
            curvature[n] = fmax(curvature[n], turn / apart);
        }
}
