/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "optimise_surface.h"

#include "../geom/vector.h"
#include "../stream/stream.h"

#include <string.h>

static void make_unit(double v[3])
{
    const double length = tm_norm(v);
    for (size_t i = 0; length > 0 && i < 3; i++)
        v[i] /= length;
}

static void on_surface(const void *of, uint32_t patch, const double point[3],
                       tm_boundary_point *at)
{
    const tm_surface *surface = of;
    tm_surface_point closest = {.triangle = at->guess};
    tm_surface_closest(surface, point, patch, &closest);
    memcpy(at->xyz, closest.xyz, sizeof at->xyz);
    at->guess = closest.triangle;
    const uint32_t *corner = surface->triangle[closest.triangle];
    tm_triangle_normal(at->axis, surface->xyz[corner[0]], surface->xyz[corner[1]],
                       surface->xyz[corner[2]]);
    make_unit(at->axis);
}

static void on_curve(const void *of, uint32_t curve, const double point[3],
                     tm_boundary_point *at)
{
    const tm_surface *surface = of;
    size_t segment;
    tm_surface_closest_on_curve(surface, curve, point, at->xyz, &segment);
    const uint32_t *node = surface->curve_node + surface->curve_start[curve] + segment;
    tm_subtract(at->axis, surface->xyz[node[1]], surface->xyz[node[0]]);
    make_unit(at->axis);
}

static void at_corner(const void *of, uint32_t corner, tm_boundary_point *at)
{
    const tm_surface *surface = of;
    memcpy(at->xyz, surface->xyz[surface->corner[corner]], sizeof at->xyz);
}

tm_boundary tm_boundary_of_surface(const tm_surface *surface)
{
    return (tm_boundary){surface, on_surface, on_curve, at_corner};
}
