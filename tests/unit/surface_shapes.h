/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Surfaces with known insides, as polygons of a file. */
#ifndef TESTS_UNIT_SURFACE_SHAPES_H
#define TESTS_UNIT_SURFACE_SHAPES_H

#include "../../lib/surface/polygon_surface.h"
#include "../../lib/geom/vector.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const double shapes_pi = 3.14159265358979323846;

static inline uint32_t add_node(tm_polygon_surface *p, double x, double y, double z)
{
    tm_error error;
    const double xyz[3] = {x, y, z};
    assert_int_equal(tm_polygon_surface_add_node(p, xyz, &error), TM_OK);
    return (uint32_t)p->nodes - 1;
}

static inline void add_polygon(tm_polygon_surface *p, const uint32_t *node, size_t k)
{
    tm_error error;
    assert_int_equal(tm_polygon_surface_add_polygon(p, node, k, &error), TM_OK);
}

static inline void add_triangle(tm_polygon_surface *p, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t node[3] = {a, b, c};
    add_polygon(p, node, 3);
}

/* Six quadrilaterals; inward: they turn the other way. */
static inline void add_box(tm_polygon_surface *p, const double low[3],
                           const double high[3], bool inward)
{
    static const unsigned char side[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    uint32_t corner[8];
    for (unsigned i = 0; i < 8; i++)
        corner[i] = add_node(p, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                             i & 4 ? high[2] : low[2]);
    for (int f = 0; f < 6; f++) {
        uint32_t node[4];
        for (int i = 0; i < 4; i++)
            node[i] = corner[side[f][inward ? 3 - i : i]];
        add_polygon(p, node, 4);
    }
}

static inline void add_cube(tm_polygon_surface *p, double x, double y, double z,
                            double side)
{
    const double low[3] = {x, y, z}, high[3] = {x + side, y + side, z + side};
    add_box(p, low, high, false);
}

/* An octahedron's faces cut to n² triangles each, moved to the sphere. Nodes on common
 * edges are there several times. */
static inline void add_sphere(tm_polygon_surface *p, const double centre[3],
                              double radius, int n, bool inward)
{
    for (unsigned octant = 0; octant < 8; octant++) {
        const double sx = octant & 1 ? -1 : 1, sy = octant & 2 ? -1 : 1;
        const double sz = octant & 4 ? -1 : 1;
        const bool turned = (sx * sy * sz < 0) != inward;
        uint32_t first = (uint32_t)p->nodes;
        for (int i = 0; i <= n; i++)
            for (int k = 0; k <= n - i; k++) {
                const double x = i, y = k, z = n - i - k;
                const double scale = radius / sqrt(x * x + y * y + z * z);
                add_node(p, centre[0] + sx * x * scale, centre[1] + sy * y * scale,
                         centre[2] + sz * z * scale);
            }
        for (int i = 0; i < n; i++) {
            uint32_t next = first + (uint32_t)(n - i + 1);
            for (int k = 0; k < n - i; k++) {
                uint32_t a = first + (uint32_t)k, b = next + (uint32_t)k;
                add_triangle(p, a, turned ? a + 1 : b, turned ? b : a + 1);
                if (k + 1 < n - i)
                    add_triangle(p, b, turned ? a + 1 : b + 1, turned ? b + 1 : a + 1);
            }
            first = next;
        }
    }
}

/* n × m quadrilaterals. */
static inline void add_torus(tm_polygon_surface *p, double large, double small,
                             uint32_t n, uint32_t m)
{
    uint32_t first = (uint32_t)p->nodes;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t k = 0; k < m; k++) {
            double a = 2 * shapes_pi * i / n, b = 2 * shapes_pi * k / m;
            double r = large + small * cos(b);
            add_node(p, r * cos(a), r * sin(a), small * sin(b));
        }
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t k = 0; k < m; k++) {
            uint32_t i1 = (i + 1) % n, k1 = (k + 1) % m;
            const uint32_t node[4] = {first + i * m + k, first + i1 * m + k,
                                      first + i1 * m + k1, first + i * m + k1};
            add_polygon(p, node, 4);
        }
}

/* A prism between z = 0 and height over a polygon that turns counter-clockwise: two
 * polygons and k quadrilaterals. */
static inline void add_prism(tm_polygon_surface *p, const double (*xy)[2], uint32_t k,
                             double height)
{
    uint32_t bottom[256], top[256];
    assert_true(k <= 256);
    for (uint32_t i = 0; i < k; i++) {
        bottom[k - 1 - i] = add_node(p, xy[i][0], xy[i][1], 0);
        top[i] = add_node(p, xy[i][0], xy[i][1], height);
    }
    add_polygon(p, bottom, k);
    add_polygon(p, top, k);
    for (uint32_t i = 0; i < k; i++) {
        uint32_t next = (i + 1) % k;
        const uint32_t node[4] = {bottom[k - 1 - i], bottom[k - 1 - next], top[next],
                                  top[i]};
        add_polygon(p, node, 4);
    }
}

/* Triangles from the outline in the plane z = 0 to (0, 0, up) and (0, 0, down). */
static inline void add_bipyramid(tm_polygon_surface *p, const double (*xy)[2], uint32_t k,
                                 double up, double down)
{
    uint32_t top = add_node(p, 0, 0, up), bottom = add_node(p, 0, 0, down);
    uint32_t first = (uint32_t)p->nodes;
    for (uint32_t i = 0; i < k; i++)
        add_node(p, xy[i][0], xy[i][1], 0);
    for (uint32_t i = 0; i < k; i++) {
        uint32_t a = first + i, b = first + (i + 1) % k;
        add_triangle(p, a, b, top);
        add_triangle(p, b, a, bottom);
    }
}

/* A regular polygon whose corners are at two radii in turn. */
static inline void make_star(double (*xy)[2], uint32_t k, double even, double odd)
{
    for (uint32_t i = 0; i < k; i++) {
        double r = i % 2 == 0 ? even : odd;
        xy[i][0] = r * cos(2 * shapes_pi * i / k);
        xy[i][1] = r * sin(2 * shapes_pi * i / k);
    }
}

static inline void turn_nodes(tm_polygon_surface *p, double angle)
{
    const double c = cos(angle), s = sin(angle);
    for (size_t v = 0; v < p->nodes; v++) {
        double *x = p->xyz[v];
        const double turned[3] = {c * x[0] - s * x[1], s * x[0] + c * x[1], x[2]};
        x[0] = turned[0];
        x[1] = c * turned[1] - s * turned[2];
        x[2] = s * turned[1] + c * turned[2];
    }
}

#endif
