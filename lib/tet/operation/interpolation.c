/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interpolation.h"

#include "../../geom/vector.h"

#include <string.h>

/* Weights of the corners of a tetrahedron that make p. Returns the least one: it is
 * negative where p is outside, and NaN in a flat tetrahedron. */
static double weights_of(const tm_tet_mesh *mesh, const uint32_t n[4], const double p[3],
                         double weight[4])
{
    double least = HUGE_VAL, sum = 0;
    for (int i = 0; i < 4; i++) {
        const double *x[4] = {mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                              mesh->xyz[n[3]]};
        x[i] = p;
        weight[i] = tm_tet_volume(x[0], x[1], x[2], x[3]);
        sum += weight[i];
    }
    for (int i = 0; i < 4; i++) {
        weight[i] /= sum;
        least = fmin(least, weight[i]);
    }
    return sum > 0 ? least : NAN;
}

void tm_tet_interpolate(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                        const double p[3], double *value)
{
    size_t width = mesh->node_attributes;
    const uint32_t *nodes = mesh->tet[tet[0]];
    double weight[4] = {1, 0, 0, 0}, deepest = -HUGE_VAL;
    for (size_t i = 0; i < count && width > 0; i++) {
        double w[4], least = weights_of(mesh, mesh->tet[tet[i]], p, w);
        if (!(least > deepest))
            continue;
        deepest = least;
        nodes = mesh->tet[tet[i]];
        memcpy(weight, w, sizeof weight);
    }
    for (size_t k = 0; k < width; k++) {
        value[k] = 0;
        for (int i = 0; i < 4; i++)
            value[k] += weight[i] * mesh->node_attribute[nodes[i] * width + k];
    }
}
