/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "marching.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static size_t index_of(const marching *m, const size_t line[3])
{
    const size_t lines = m->cells + 1;
    return (line[2] * lines + line[1]) * lines + line[0];
}

static void place_of(const marching *m, const size_t line[3], double at[3])
{
    for (int i = 0; i < 3; i++)
        at[i] = m->low + m->side * (double)line[i] / (double)m->cells;
}

/* The node between two corners of a cell, a and b: bit i is the high side along axis i.
 * It is kept away from both, so that no triangle is too small. */
static uint32_t node_between(marching *m, const size_t cell[3], unsigned a, unsigned b)
{
    const unsigned from = a < b ? a : b, to = a < b ? b : a;
    const size_t p[3] = {cell[0] + (from & 1), cell[1] + (from >> 1 & 1),
                         cell[2] + (from >> 2)};
    const size_t q[3] = {cell[0] + (to & 1), cell[1] + (to >> 1 & 1),
                         cell[2] + (to >> 2)};
    uint32_t *number = &m->number[7 * index_of(m, p) + (from ^ to) - 1];
    if (*number == absent) {
        const double u = m->value[index_of(m, p)], v = m->value[index_of(m, q)];
        const double t = fmin(0.95, fmax(0.05, u / (u - v)));
        double at[3], other[3];
        place_of(m, p, at);
        place_of(m, q, other);
        for (int i = 0; i < 3; i++)
            at[i] = at[i] + (other[i] - at[i]) * t;
        *number = add_node(m->surface, at);
    }
    return *number;
}

/* A tetrahedron with a positive volume, of which `inside` corners come first. */
static void add_cut(marching *m, const size_t cell[3], const unsigned corner[4],
                    unsigned inside)
{
    uint32_t node[4][4] = {{0}};
    for (unsigned i = 0; i < inside; i++)
        for (unsigned j = inside; j < 4; j++)
            node[i][j] = node_between(m, cell, corner[i], corner[j]);
    if (inside == 1) {
        add_triangle(m->surface, node[0][1], node[0][2], node[0][3]);
    } else if (inside == 2) {
        add_triangle(m->surface, node[0][2], node[0][3], node[1][3]);
        add_triangle(m->surface, node[0][2], node[1][3], node[1][2]);
    } else if (inside == 3) {
        add_triangle(m->surface, node[0][3], node[1][3], node[2][3]);
    }
}

/* Sorts the corners of a tetrahedron with a positive volume, the inside first, and cuts.
 */
static void cut_tetrahedron(marching *m, const size_t cell[3], const unsigned corner[4])
{
    unsigned sorted[4], inside = 0, outside = 0, swaps = 0;
    for (unsigned i = 0; i < 4; i++) {
        const unsigned c = corner[i];
        const size_t at[3] = {cell[0] + (c & 1), cell[1] + (c >> 1 & 1),
                              cell[2] + (c >> 2)};
        if (m->value[index_of(m, at)] >= 0) {
            sorted[3 - outside++] = c;
        } else {
            sorted[inside++] = c;
            swaps += outside;
        }
    }
    swaps += outside * (outside - 1) / 2; /* they are there last first */
    if (outside > 0 && swaps % 2 != 0) {
        const unsigned a = inside < 3 ? 2 : 0, c = sorted[a];
        sorted[a] = sorted[a + 1];
        sorted[a + 1] = c;
    }
    add_cut(m, cell, sorted, inside);
}

/* How fast a function grows at a point. */
static void slope_of(shape_function *function, const double at[3], double step,
                     double slope[3])
{
    for (int i = 0; i < 3; i++) {
        double low[3] = {at[0], at[1], at[2]}, high[3] = {at[0], at[1], at[2]};
        low[i] -= step;
        high[i] += step;
        slope[i] = (function(high) - function(low)) / (2 * step);
    }
}

/* Takes a point to where the function vanishes; false if it is not close to that. */
static bool restore(shape_function *function, double step, double at[3])
{
    for (int round = 0; round < 3; round++) {
        double slope[3];
        slope_of(function, at, step, slope);
        const double square =
            slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2];
        const double value = function(at);
        for (int i = 0; i < 3; i++)
            at[i] -= value * slope[i] / square;
    }
    return fabs(function(at)) < step;
}

/* Puts every node in the middle of its neighbours, and from there back to where the
 * function vanishes. */
static void relax(marching *m, shape_function *function, double (*sum)[4])
{
    surface *s = m->surface;
    const double step = m->side / (double)m->cells / 64;
    memset(sum, 0, s->nodes * sizeof *sum);
    for (size_t t = 0; t < s->triangles; t++)
        for (int c = 0; c < 3; c++) {
            double *to = sum[s->triangle[t][c]];
            const double *from = s->xyz[s->triangle[t][(c + 1) % 3]];
            for (int i = 0; i < 3; i++)
                to[i] += from[i];
            to[3]++;
        }
    for (size_t node = 0; node < s->nodes; node++) {
        double at[3];
        for (int i = 0; i < 3; i++)
            at[i] = sum[node][i] / sum[node][3];
        if (restore(function, step, at))
            memcpy(s->xyz[node], at, sizeof at);
    }
}

void make_marching(marching *m, shape_function *function)
{
    static const unsigned path[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                        {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}};
    const size_t n = m->cells, lines = n + 1;
    size_t room = 0, at[3];
    m->value = grow(NULL, lines * lines * lines, &room, sizeof *m->value);
    m->number = all_absent(7 * lines * lines * lines);
    for (at[2] = 0; at[2] <= n; at[2]++)
        for (at[1] = 0; at[1] <= n; at[1]++)
            for (at[0] = 0; at[0] <= n; at[0]++) {
                double xyz[3];
                place_of(m, at, xyz);
                m->value[index_of(m, at)] = function(xyz);
            }
    for (at[2] = 0; at[2] < n; at[2]++)
        for (at[1] = 0; at[1] < n; at[1]++)
            for (at[0] = 0; at[0] < n; at[0]++)
                for (int i = 0; i < 6; i++)
                    cut_tetrahedron(m, at, path[i]);
    room = 0;
    double(*sum)[4] = grow(NULL, m->surface->nodes, &room, sizeof *sum);
    for (int round = 0; round < 6; round++)
        relax(m, function, sum);
    free(sum);
    free(m->value);
    free(m->number);
}
