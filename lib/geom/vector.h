/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Vectors of three doubles, and the measures of triangles and tetrahedra in rounded
 * arithmetic. What must be exact is in predicates.h. */
#ifndef TM_GEOM_VECTOR_H
#define TM_GEOM_VECTOR_H

#include <math.h>

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

static inline double tm_triangle_area(const double a[3], const double b[3],
                                      const double c[3])
{
    double normal[3];
    tm_triangle_normal(normal, a, b, c);
    return tm_norm(normal) / 2;
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

#endif
