/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectors of three doubles, and the measures of triangles and tetrahedra in rounded
 * arithmetic. What must be exact is in predicates.h. */
#ifndef TM_GEOM_VECTOR_H
#define TM_GEOM_VECTOR_H

#include "../base/extern_c.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

/* out = a - b; out may be a or b. */
static inline void tm_subtract(double out[3], const double a[3], const double b[3])
{
    out[0] = a[0] - b[0];
    out[1] = a[1] - b[1];
    out[2] = a[2] - b[2];
}

/* out = a × b; out must be neither a nor b. */
static inline void tm_cross(double out[3], const double a[3], const double b[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double tm_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double tm_norm2(const double a[3])
{
    return tm_dot(a, a);
}

static inline double tm_norm(const double a[3])
{
    return sqrt(tm_norm2(a));
}

static inline double tm_distance2(const double a[3], const double b[3])
{
    double ab[3];
    tm_subtract(ab, b, a);
    return tm_norm2(ab);
}

/* (b-a) × (c-a): normal to the triangle, as long as twice its area. */
static inline void tm_triangle_normal(double out[3], const double a[3], const double b[3],
                                      const double c[3])
{
    double ab[3];
    double ac[3];
    tm_subtract(ab, b, a);
    tm_subtract(ac, c, a);
    tm_cross(out, ab, ac);
}

/* The vector area of a polygon, ½ Σ (x_i - x_0) × (x_(i+1) - x_0): normal to it, as long
 * as its area where it is plane. O(count). */
static inline void tm_polygon_area(const double (*xyz)[3], const uint32_t *node,
                                   size_t count, double area[3])
{
    area[0] = area[1] = area[2] = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        double normal[3];
        tm_triangle_normal(normal, xyz[node[0]], xyz[node[i]], xyz[node[i + 1]]);
        for (int k = 0; k < 3; k++)
            area[k] += normal[k] / 2;
    }
}

static inline double tm_triangle_area(const double a[3], const double b[3],
                                      const double c[3])
{
    double normal[3];
    tm_triangle_normal(normal, a, b, c);
    return tm_norm(normal) / 2;
}

/* The area of the bilinear surface with the corners a b c d in cyclic order: the length
 * of its normal, which is linear along its lines, by 2 × 2 Gauss points. Exact where the
 * quadrilateral is plane and convex; where d is by h times the side of a square off the
 * plane of the others, the error is below 2e-3 h^4 of the area (h <= 1/2). */
static inline double tm_bilinear_area(const double a[3], const double b[3],
                                      const double c[3], const double d[3])
{
    const double weight = 0.25;
    const double gauss = 0.211324865405187117745; /* (1 - 1/sqrt(3)) / 2 */
    double area = 0;
    for (int i = 0; i < 4; i++) {
        const double u = i & 1 ? gauss : 1 - gauss, v = i & 2 ? gauss : 1 - gauss;
        double along_u[3];
        double along_v[3];
        double normal[3];
        for (int j = 0; j < 3; j++) {
            along_u[j] = (1 - v) * (b[j] - a[j]) + v * (c[j] - d[j]);
            along_v[j] = (1 - u) * (d[j] - a[j]) + u * (c[j] - b[j]);
        }
        tm_cross(normal, along_u, along_v);
        area += tm_norm(normal);
    }
    return weight * area;
}

/* The volume, positive where d lies on the side that (b-a) × (c-a) points to. */
static inline double tm_tet_volume(const double a[3], const double b[3],
                                   const double c[3], const double d[3])
{
    const double determinant_per_volume = 6;
    double normal[3];
    double ad[3];
    tm_triangle_normal(normal, a, b, c);
    tm_subtract(ad, d, a);
    return tm_dot(normal, ad) / determinant_per_volume;
}

/* Moves the points so that the first is the origin; where products of coordinates could
 * leave the range of double, multiplies by a power of two that brings the largest one
 * into [1/2, 1). Returns this factor, 1 in range; 0 where all points are one or a
 * difference overflows. */
static inline double tm_bring_into_range(double (*p)[3], size_t count)
{
    const double small = 1e-20, large = 1e20;
    double largest = 0;
    for (size_t v = count; v-- > 0;) {
        tm_subtract(p[v], p[v], p[0]);
        for (size_t i = 0; i < 3; i++) {
            const double size = fabs(p[v][i]);
            largest = size > largest ? size : largest;
        }
    }
    if (small < largest && largest < large)
        return 1;
    if (!(largest > 0 && isfinite(largest)))
        return 0;
    int exponent;
    frexp(largest, &exponent);
    for (size_t v = 0; v < count; v++)
        for (size_t i = 0; i < 3; i++)
            p[v][i] = ldexp(p[v][i], -exponent);
    return ldexp(1, -exponent);
}

TM_EXTERN_C_END

#endif
