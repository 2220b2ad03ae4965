/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "thin_place.h"

#include "../geom/vector.h"

#include <math.h>
#include <string.h>

/* Whether at that distance the point below the centre of a triangle is not inside, or the
 * one above it is. */
static bool is_thin(const tm_surface *surface, size_t t, double distance,
                    double centre[3])
{
    const uint32_t *v = surface->triangle[t];
    double normal[3];
    double above[3];
    double below[3];
    tm_triangle_normal(normal, surface->xyz[v[0]], surface->xyz[v[1]],
                       surface->xyz[v[2]]);
    const double length = tm_norm(normal);
    if (!(length > 0))
        return false;
    for (int i = 0; i < 3; i++) {
        centre[i] =
            (surface->xyz[v[0]][i] + surface->xyz[v[1]][i] + surface->xyz[v[2]][i]) / 3;
        above[i] = centre[i] + distance / length * normal[i];
        below[i] = centre[i] - distance / length * normal[i];
    }
    return tm_surface_has_inside(surface, above) ||
           !tm_surface_has_inside(surface, below);
}

bool tm_surface_thin_place(const tm_surface *surface, double most, double place[3])
{
    for (int halves = 3; halves >= 0; halves--)
        for (size_t t = 0; t < surface->triangles; t++)
            if (is_thin(surface, t, ldexp(most, -halves), place))
                return true;
    return false;
}
