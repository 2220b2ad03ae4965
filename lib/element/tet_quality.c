/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_quality.h"

#include "../geom/predicates.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

enum { DIMENSIONS = 3, CORNERS = 4 };

static const double half_turn = 180; /* degrees */
static const double pi = 3.14159265358979323846;

/* As tm_bring_into_range(). */
static double make_unit(double unit[CORNERS][DIMENSIONS], const double a[3],
                        const double b[3], const double c[3], const double d[3])
{
    memcpy(unit[0], a, sizeof unit[0]);
    memcpy(unit[1], b, sizeof unit[1]);
    memcpy(unit[2], c, sizeof unit[2]);
    memcpy(unit[3], d, sizeof unit[3]);
    return tm_bring_into_range(unit, CORNERS);
}

double tm_tet_sine2_scaled(const double a[3], const double b[3], const double c[3],
                           const double d[3])
{
    double unit[CORNERS][DIMENSIONS];
    const double *corner[CORNERS] = {a, b, c, d}, factor = make_unit(unit, a, b, c, d);
    /* Not moved to the origin, edges are rounded as they are at other sizes. */
    for (size_t v = 0; v < CORNERS; v++)
        for (size_t i = 0; i < DIMENSIONS; i++)
            unit[v][i] = factor * corner[v][i];
    bool measured;
    return tm_tet_sine2_measure(unit[0], unit[1], unit[2], unit[3], &measured);
}

double tm_sine2_to_degrees(double sine2)
{
    return asin(sqrt(fmin(fmax(sine2, 0), 1))) * half_turn / pi;
}

double tm_bad_sine2(double degrees)
{
    const double quarter_turn = 90;
    const double limit = fmin(fmax(degrees - TM_ANGLE_TOLERANCE, 0), quarter_turn);
    const double sine = sin(limit * pi / half_turn);
    return sine * sine;
}

/* The angle between faces whose normals, both inward or both outward, have that product:
 * cos α = -n_i·n_j / (|n_i| |n_j|), sin α = D l / (|n_i| |n_j|). */
static double dihedral(double sine, double normal_product)
{
    /* 0 - x, for -x would be -0 at a face without area: an angle of 180°, not 0. */
    return atan2(sine, 0 - normal_product) * half_turn / pi;
}

void tm_tet_dihedrals(const double a[3], const double b[3], const double c[3],
                      const double d[3], double degrees[TM_TET_EDGES])
{
    double p[CORNERS][DIMENSIONS];
    if (make_unit(p, a, b, c, d) == 0) {
        for (size_t e = 0; e < TM_TET_EDGES; e++)
            degrees[e] = 0;
        return;
    }
    double normal[CORNERS][DIMENSIONS]; /* outward if abcd is positive */
    tm_triangle_normal(normal[0], p[1], p[2], p[3]);
    tm_triangle_normal(normal[1], p[0], p[3], p[2]);
    tm_triangle_normal(normal[2], p[0], p[1], p[3]);
    tm_triangle_normal(normal[3], p[0], p[2], p[1]);
    const double determinant = fabs(tm_dot(normal[3], p[3]));
    for (size_t e = 0; e < TM_TET_EDGES; e++) {
        /* The faces at an edge are those opposite to the corners of the opposite edge. */
        const uint8_t *end = tm_edge_corner[e];
        const uint8_t *opposite = tm_edge_corner[TM_TET_EDGES - 1 - e];
        const double length = sqrt(tm_distance2(p[end[0]], p[end[1]]));
        degrees[e] = dihedral(determinant * length,
                              tm_dot(normal[opposite[0]], normal[opposite[1]]));
    }
}

double tm_tet_volume_quality(const double a[3], const double b[3], const double c[3],
                             const double d[3])
{
    double p[CORNERS][DIMENSIONS];
    if (make_unit(p, a, b, c, d) == 0)
        return 0;
    double longest2 = 0;
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        longest2 = fmax(longest2,
                        tm_distance2(p[tm_edge_corner[e][0]], p[tm_edge_corner[e][1]]));
    const double per_volume = 8.48528137423857029281; /* 6√2 */
    return per_volume * tm_tet_volume(p[0], p[1], p[2], p[3]) /
           (longest2 * sqrt(longest2));
}

int tm_tet_turn(const double (*xyz)[3], uint32_t node[4])
{
    const int sign = tm_orient3d(xyz[node[0]], xyz[node[1]], xyz[node[2]], xyz[node[3]]);
    if (sign < 0) {
        const uint32_t last = node[3];
        node[3] = node[2];
        node[2] = last;
    }
    return sign;
}
