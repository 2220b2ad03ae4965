/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "verdict.h"

#include "../geom/vector.h"
#include "jens.h"

#include <string.h>

enum { BASE_CORNERS = 4 };

static const double per_wedge = 2 / TM_SQRT_3;

static double least(const double *value, size_t count)
{
    double low = value[0];
    for (size_t i = 1; i < count; i++)
        low = value[i] < low ? value[i] : low;
    return low;
}

/* With its three directions the sums of the four edges each. */
static double centre_jacobian(const double (*xyz)[3], const uint32_t *item)
{
    static const unsigned char from[3][4] = {{0, 3, 4, 7}, {0, 1, 4, 5}, {0, 1, 2, 3}};
    static const unsigned char to[3][4] = {{1, 2, 5, 6}, {3, 2, 7, 6}, {4, 5, 6, 7}};
    static const double origin[3] = {0, 0, 0};
    double sum[3][3];
    for (size_t axis = 0; axis < 3; axis++) {
        memset(sum[axis], 0, sizeof sum[axis]);
        for (size_t e = 0; e < 4; e++) {
            const double *a = xyz[item[from[axis][e]]], *b = xyz[item[to[axis][e]]];
            for (size_t i = 0; i < 3; i++)
                sum[axis][i] += b[i] - a[i];
        }
    }
    return tm_scaled_jacobian(origin, sum[0], sum[1], sum[2]);
}

static double tetrahedron_jacobian(const double (*xyz)[3], const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[TM_TET_NODES];
    double j[TM_ELEMENT_CORNERS];
    tm_scaled_jacobians(shape, xyz, item, j);
    double nearest = j[0];
    for (size_t i = 1; i < shape->corners; i++)
        nearest = fabs(j[i]) < fabs(nearest) ? j[i] : nearest;
    return TM_SQRT_2 * nearest;
}

static double pyramid_jacobian(const double (*xyz)[3], const uint32_t *item)
{
    static const unsigned char part[BASE_CORNERS][3] = {
        {0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
    double j[BASE_CORNERS];
    for (size_t i = 0; i < BASE_CORNERS; i++) {
        const uint32_t tet[4] = {item[part[i][0]], item[part[i][1]], item[part[i][2]],
                                 item[4]};
        j[i] = tetrahedron_jacobian(xyz, tet);
    }
    const double low = TM_SQRT_2 * least(j, BASE_CORNERS);
    if (low <= 0)
        return 0;
    return low < 1 ? low : 2 - low;
}

double tm_verdict_scaled_jacobian(size_t nodes, const double (*xyz)[3],
                                  const uint32_t *item)
{
    switch (nodes) {
    case TM_HEX_NODES:
        return fmin(tm_least_scaled_jacobian(nodes, xyz, item),
                    centre_jacobian(xyz, item));
    case TM_WEDGE_NODES:
        return per_wedge * tm_least_scaled_jacobian(nodes, xyz, item);
    case TM_PYRAMID_NODES:
        return pyramid_jacobian(xyz, item);
    default:
        return tetrahedron_jacobian(xyz, item);
    }
}

/* The cube of (w det)^(2/3) / (sum of squares); 0 where det is not positive. */
static double corner_shape3(double determinant, double squares)
{
    return determinant > 0 ? determinant * determinant / (squares * squares * squares)
                           : 0;
}

/* That of the corner at p, without w. */
static double corner3(const double (*p)[3], const unsigned char node[4])
{
    double a[3], b[3], c[3], normal[3];
    tm_subtract(a, p[node[1]], p[node[0]]);
    tm_subtract(b, p[node[2]], p[node[0]]);
    tm_subtract(c, p[node[3]], p[node[0]]);
    tm_cross(normal, a, b);
    return corner_shape3(tm_dot(normal, c), tm_norm2(a) + tm_norm2(b) + tm_norm2(c));
}

static double tetrahedron_shape(const double (*p)[3])
{
    double a[3], b[3], normal[3], squares = 0;
    for (size_t i = 0; i < 4; i++)
        for (size_t j = i + 1; j < 4; j++)
            squares += tm_distance2(p[i], p[j]) / 2;
    tm_subtract(a, p[1], p[0]);
    tm_subtract(b, p[2], p[0]);
    tm_cross(normal, a, b);
    double c[3];
    tm_subtract(c, p[3], p[0]);
    return 3 * cbrt(corner_shape3(TM_SQRT_2 * tm_dot(normal, c), squares));
}

/* Of a quadrilateral, which turns as its two diagonals do. */
static double base_shape(const double (*p)[3])
{
    double diagonal[2][3], normal[3], value[BASE_CORNERS];
    tm_subtract(diagonal[0], p[2], p[0]);
    tm_subtract(diagonal[1], p[3], p[1]);
    tm_cross(normal, diagonal[0], diagonal[1]);
    const double length = tm_norm(normal);
    if (!(length > 0))
        return 0;
    for (size_t i = 0; i < BASE_CORNERS; i++) {
        double a[3], b[3], area[3];
        tm_subtract(a, p[(i + 1) % BASE_CORNERS], p[i]);
        tm_subtract(b, p[(i + BASE_CORNERS - 1) % BASE_CORNERS], p[i]);
        tm_cross(area, a, b);
        const double squares = tm_norm2(a) + tm_norm2(b);
        value[i] = squares > 0 ? 2 * tm_dot(area, normal) / (length * squares) : 0;
    }
    return fmax(least(value, BASE_CORNERS), 0);
}

static double pyramid_shape(const double (*p)[3])
{
    double a[3], b[3], normal[3], up[3], longest = 0;
    tm_subtract(a, p[1], p[0]);
    tm_subtract(b, p[3], p[0]);
    tm_cross(normal, a, b);
    for (size_t i = 0; i < 3; i++)
        up[i] = p[4][i] - (p[0][i] + p[1][i] + p[2][i] + p[3][i]) / BASE_CORNERS;
    for (size_t i = 0; i < BASE_CORNERS; i++) {
        longest = fmax(longest, tm_distance2(p[i], p[(i + 1) % BASE_CORNERS]));
        longest = fmax(longest, tm_distance2(p[i], p[4]));
    }
    const double rise = tm_dot(up, normal) / tm_norm(normal);
    if (!(rise > 0))
        return 0;
    const double regular = sqrt(longest / 2);
    return base_shape(p) * (rise / tm_norm(up)) * fmin(rise / regular, regular / rise);
}

double tm_verdict_shape(size_t nodes, const double (*xyz)[3], const uint32_t *item)
{
    double p[TM_ELEMENT_NODES][3], low = 1;
    for (size_t v = 0; v < nodes; v++)
        memcpy(p[v], xyz[item[v]], sizeof p[v]);
    if (tm_bring_into_range(p, nodes) == 0)
        return 0;
    if (nodes == TM_PYRAMID_NODES)
        return pyramid_shape(p);
    if (nodes != TM_WEDGE_NODES && nodes != TM_HEX_NODES)
        return fmin(tetrahedron_shape(p), 1);
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    for (size_t i = 0; i < shape->corners; i++)
        low = fmin(low, corner3(p, shape->corner[i]));
    /* w = 2/√3, squared in a cube. */
    return fmin(3 * cbrt(nodes == TM_WEDGE_NODES ? low * per_wedge * per_wedge : low), 1);
}
