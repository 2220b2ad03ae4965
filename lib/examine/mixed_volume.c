/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_volume.h"

#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "../element/jens.h"
#include "../element/shape.h"

/* Six times the volume of the cone from the origin to a triangle. */
static double cone_to_triangle(const double a[3], const double b[3], const double c[3])
{
    double normal[3];
    tm_cross(normal, a, b);
    return tm_dot(normal, c);
}

/* Six times that of the cone to a bilinear quadrilateral. */
static double cone_to_quadrilateral(const double a[3], const double b[3],
                                    const double c[3], const double d[3])
{
    const double quarter = 0.25;
    double ac[3], bd[3], normal[3];
    tm_subtract(ac, c, a);
    tm_subtract(bd, d, b);
    tm_cross(normal, ac, bd);
    const double sum[3] = {(a[0] + c[0]) + (b[0] + d[0]), (a[1] + c[1]) + (b[1] + d[1]),
                           (a[2] + c[2]) + (b[2] + d[2])};
    return quarter * tm_dot(sum, normal);
}

double tm_mixed_volume(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    const double six = 6;
    if (k == TM_TET_NODES)
        return tm_tet_volume(xyz[node[0]], xyz[node[1]], xyz[node[2]], xyz[node[3]]);
    const tm_element_shape *shape = &tm_element_shapes[k];
    const uint8_t apex = (uint8_t)(k - 1); /* all cones begin there */
    double at[TM_ELEMENT_NODES][3], sum = 0;
    for (size_t i = 0; i < k; i++)
        tm_subtract(at[i], xyz[node[i]], xyz[node[apex]]);
    for (size_t f = 0; f < shape->faces; f++) {
        const uint8_t *n = shape->face[f];
        if (tm_mixed_face_nodes(n) == 4)
            sum += cone_to_quadrilateral(at[n[0]], at[n[1]], at[n[2]], at[n[3]]);
        else if (n[0] != apex && n[1] != apex && n[2] != apex)
            sum += cone_to_triangle(at[n[0]], at[n[1]], at[n[2]]);
    }
    return sum / six;
}

tm_mixed_corners tm_mixed_corners_of(const double (*xyz)[3], const uint32_t *node,
                                     size_t k)
{
    const tm_element_shape *shape = &tm_element_shapes[k];
    tm_mixed_corners count = {0};
    for (size_t i = 0; i < shape->determinants; i++) {
        const uint8_t *n = shape->corner[i];
        const int sign = tm_orient3d(xyz[node[n[0]]], xyz[node[n[1]]], xyz[node[n[2]]],
                                     xyz[node[n[3]]]);
        count.negative += sign < 0;
        count.zero += sign == 0;
        count.positive += sign > 0;
    }
    return count;
}
