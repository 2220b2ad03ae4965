/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_parts.h"

#include "../../base/sum.h"
#include "../../geom/predicates.h"
#include "../../geom/vector.h"

#include <float.h>
#include <math.h>

/* The determinant, and what it would be without signs. */
static double determinant(const double a[3], const double b[3], const double c[3],
                          double *magnitude)
{
    double value = 0;
    *magnitude = 0;
    for (size_t k = 0; k < 3; k++) {
        const size_t l = (k + 1) % 3, m = (k + 2) % 3;
        value += a[k] * (b[l] * c[m] - b[m] * c[l]);
        *magnitude += fabs(a[k]) * (fabs(b[l] * c[m]) + fabs(b[m] * c[l]));
    }
    return value;
}

double tm_poly_volume(const tm_poly_boundary *b, const double (*xyz)[3],
                      double *uncertain)
{
    const double units = 16, determinant_per_volume = 6;
    tm_sum sum = {0};
    double magnitudes = 0;
    const double *origin = b->nodes > 0 ? xyz[b->node[0]] : NULL;
    for (size_t f = 0; f < b->faces; f++) {
        const uint32_t *corner = b->corner + b->face_start[f];
        const size_t count = b->face_start[f + 1] - b->face_start[f];
        for (size_t i = 1; i + 1 < count; i++) {
            double x[3][3], magnitude;
            tm_subtract(x[0], xyz[b->node[corner[0]]], origin);
            tm_subtract(x[1], xyz[b->node[corner[i]]], origin);
            tm_subtract(x[2], xyz[b->node[corner[i + 1]]], origin);
            tm_sum_add(&sum, determinant(x[0], x[1], x[2], &magnitude));
            magnitudes += magnitude;
        }
    }
    *uncertain = units * DBL_EPSILON * magnitudes / determinant_per_volume;
    return tm_sum_value(sum) / determinant_per_volume;
}

/* The node of a tetrahedron that is not in its first face. */
static uint32_t top(const tm_poly_boundary *b)
{
    uint32_t v = 0;
    while (v == b->corner[0] || v == b->corner[1] || v == b->corner[2])
        v++;
    return b->node[v];
}

int tm_poly_sign(const tm_poly_boundary *b, const double (*xyz)[3], double *volume)
{
    double uncertain;
    *volume = tm_poly_volume(b, xyz, &uncertain);
    if (fabs(*volume) > uncertain)
        return *volume > 0 ? 1 : -1;
    if (b->nodes == 4 && b->faces == 4 && tm_poly_boundary_causes(b) == 0)
        return -tm_orient3d(xyz[b->node[b->corner[0]]], xyz[b->node[b->corner[1]]],
                            xyz[b->node[b->corner[2]]], xyz[top(b)]);
    return 0;
}
