/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solids.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Polygons of k nodes, one after the other, each cut from its first node. */
static void add_polygons(surface *s, const uint32_t *node, size_t polygons, size_t k)
{
    for (size_t p = 0; p < polygons; p++)
        for (size_t i = 2; i < k; i++)
            add_triangle(s, node[p * k], node[p * k + i - 1], node[p * k + i]);
}

/* The corners of [low, high]³: the one with x at bit 0, y at bit 1, z at bit 2. */
static void add_cube_nodes(surface *s, double low, double high)
{
    for (unsigned i = 0; i < 8; i++) {
        const double at[3] = {i & 1 ? high : low, i & 2 ? high : low, i & 4 ? high : low};
        add_node(s, at);
    }
}

/* Its sides, seen from outside; the last is the top. */
static const uint32_t side[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

void make_star(surface *s)
{
    const double half = 0.125, tip = 0.5;
    add_cube_nodes(s, -half, half);
    for (size_t f = 0; f < 6; f++) {
        const int axis = f < 2 ? 0 : f < 4 ? 1 : 2;
        double at[3] = {0, 0, 0};
        at[axis] = f % 2 ? tip : -tip;
        const uint32_t apex = add_node(s, at);
        for (size_t i = 0; i < 4; i++)
            add_triangle(s, side[f][i], side[f][(i + 1) % 4], apex);
    }
}

void make_slit(surface *s)
{
    const double half = 0.0349, from = 0.25, to = 0.75, depth = 0.5;
    const double at[6][3] = {{0.5 - half, from, 1}, {0.5 + half, from, 1},
                             {0.5 + half, to, 1},   {0.5 - half, to, 1},
                             {0.5, from, depth},    {0.5, to, depth}};
    static const uint32_t four[6][4] = {{4, 5, 9, 8},  {5, 7, 10, 9},   {7, 6, 11, 10},
                                        {6, 4, 8, 11}, {8, 12, 13, 11}, {9, 10, 13, 12}};
    static const uint32_t three[2][3] = {{8, 9, 12}, {11, 13, 10}};
    add_cube_nodes(s, 0, 1);
    for (size_t i = 0; i < 6; i++)
        add_node(s, at[i]);
    add_polygons(s, side[0], 5, 4);
    add_polygons(s, four[0], 6, 4);
    add_polygons(s, three[0], 2, 3);
}

void make_spike(surface *s)
{
    enum { SIDES = 7 };
    const double radius = 0.125, height = 2;
    uint32_t base[SIDES];
    for (unsigned i = 0; i < SIDES; i++) {
        const double turn = 2 * pi * i / SIDES;
        base[i] =
            add_node(s, (const double[3]){radius * cos(turn), radius * sin(turn), 0});
    }
    const uint32_t apex = add_node(s, (const double[3]){0, 0, height});
    for (unsigned i = 0; i < SIDES; i++)
        add_triangle(s, base[i], base[(i + 1) % SIDES], apex);
    for (unsigned i = 2; i < SIDES; i++)
        add_triangle(s, base[0], base[i], base[i - 1]);
}

void make_wedge(surface *s)
{
    const double high = sin(pi / 180);
    const double at[6][3] = {{0, 0, 0}, {0, 1, 0},    {1, 0, 0},
                             {1, 1, 0}, {1, 0, high}, {1, 1, high}};
    static const uint32_t four[3][4] = {{0, 1, 3, 2}, {0, 4, 5, 1}, {2, 3, 5, 4}};
    for (size_t i = 0; i < 6; i++)
        add_node(s, at[i]);
    add_polygons(s, four[0], 3, 4);
    add_triangle(s, 0, 2, 4);
    add_triangle(s, 1, 5, 3);
}

void make_step(surface *s)
{
    enum { SIDES = 5 };
    static const double outline[SIDES][2] = {
        {0, 0}, {1, 0}, {0.9, 0.1}, {0.35, 0.12}, {0.45, 0.4}};
    for (unsigned z = 0; z < 2; z++)
        for (unsigned i = 0; i < SIDES; i++)
            add_node(s, (const double[3]){outline[i][0], outline[i][1], 0.5 * z});
    static const uint32_t three[3][3] = {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}};
    for (unsigned i = 0; i < 3; i++) {
        add_triangle(s, three[i][0], three[i][2], three[i][1]);
        add_triangle(s, SIDES + three[i][0], SIDES + three[i][1], SIDES + three[i][2]);
    }
    for (uint32_t i = 0; i < SIDES; i++) {
        const uint32_t j = (i + 1) % SIDES;
        add_triangle(s, i, j, SIDES + j);
        add_triangle(s, i, SIDES + j, SIDES + i);
    }
}

void make_spool(surface *s)
{
    enum { SIDES = 48, RINGS = 8 };
    static const double ring[RINGS][2] = {/* radius, height */
                                          {1, 0},    {1, 0.2}, {0.15, 0.2}, {0.15, 0.6},
                                          {0.15, 1}, {1, 1},   {1, 1.2},    {0.5, 1.2}};
    const uint32_t low = add_node(s, (const double[3]){0, 0, 0});
    const uint32_t high = add_node(s, (const double[3]){0, 0, 1.2});
    for (unsigned r = 0; r < RINGS; r++)
        for (unsigned i = 0; i < SIDES; i++) {
            const double turn = 2 * pi * i / SIDES;
            add_node(s, (const double[3]){ring[r][0] * cos(turn), ring[r][0] * sin(turn),
                                          ring[r][1]});
        }
    for (uint32_t i = 0; i < SIDES; i++) {
        const uint32_t j = (i + 1) % SIDES, first = high + 1;
        add_triangle(s, low, first + j, first + i);
        for (uint32_t r = 0; r + 1 < RINGS; r++) {
            const uint32_t a = first + r * SIDES, b = a + SIDES;
            add_triangle(s, a + i, a + j, b + j);
            add_triangle(s, a + i, b + j, b + i);
        }
        const uint32_t last = first + (RINGS - 1) * SIDES;
        add_triangle(s, high, last + i, last + j);
    }
}
