/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two corners are computed at a time, in both halves of a 16-byte vector (an extension
 * that GCC and Clang have on every machine). Both halves do what scalar code would, so
 * results do not depend on the machine. */
#include "jens.h"

#include "../geom/vector.h"

#include <stdbool.h>
#include <string.h>

enum { TETRAHEDRON = 4, PYRAMID = 5, WEDGE = 6, HEXAHEDRON = 8 };

#define ALL_4(k) (k), (k), (k), (k)

const tm_element_shape tm_element_shapes[TM_ELEMENT_NODES_MOST + 1] = {
    [TETRAHEDRON] = {4,
                     {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}},
                     {ALL_4(TM_K_TETRAHEDRON)}},
    [PYRAMID] = {8,
                 {{0, 1, 3, 4},
                  {1, 2, 0, 4},
                  {2, 3, 1, 4},
                  {3, 0, 2, 4},
                  {4, 2, 1, 0},
                  {4, 3, 2, 1},
                  {4, 0, 3, 2},
                  {4, 1, 0, 3}},
                 {ALL_4(TM_K_PYRAMID_BASE), ALL_4(TM_K_PYRAMID_APEX)}},
    [WEDGE] = {6,
               {{0, 2, 1, 3},
                {1, 0, 2, 4},
                {2, 1, 0, 5},
                {3, 4, 5, 0},
                {4, 5, 3, 1},
                {5, 3, 4, 2}},
               {ALL_4(TM_K_WEDGE), TM_K_WEDGE, TM_K_WEDGE}},
    [HEXAHEDRON] = {8,
                    {{0, 1, 3, 4},
                     {1, 2, 0, 5},
                     {2, 3, 1, 6},
                     {3, 0, 2, 7},
                     {4, 7, 5, 0},
                     {5, 4, 6, 1},
                     {6, 5, 7, 2},
                     {7, 6, 4, 3}},
                    {ALL_4(TM_K_HEXAHEDRON), ALL_4(TM_K_HEXAHEDRON)}},
};

typedef double pair __attribute__((vector_size(2 * sizeof(double))));

typedef struct vector_pair {
    pair x, y, z;
} vector_pair;

/* Products of three squared lengths outside of these are not trusted. */
static const double low = 1e-250;
static const double high = 1e250;

/* (to - from) of both corners. */
static inline vector_pair edges(const double from[2][3], const double a[3],
                                const double b[3])
{
    return (vector_pair){(pair){a[0], b[0]} - (pair){from[0][0], from[1][0]},
                         (pair){a[1], b[1]} - (pair){from[0][1], from[1][1]},
                         (pair){a[2], b[2]} - (pair){from[0][2], from[1][2]}};
}

static inline pair norm2(vector_pair v)
{
    return v.x * v.x + v.y * v.y + v.z * v.z;
}

static inline pair determinant(vector_pair a, vector_pair b, vector_pair c)
{
    return (a.y * b.z - a.z * b.y) * c.x + (a.z * b.x - a.x * b.z) * c.y +
           (a.x * b.y - a.y * b.x) * c.z;
}

/* The edges from p scaled so that the largest coordinate is in [1/2, 1). False where one
 * is of length 0 or overflows. */
static bool scaled_edges(const double p[3], const double *const to[3], double edge[3][3])
{
    for (int i = 0; i < 3; i++) {
        tm_subtract(edge[i], to[i], p);
        const double largest =
            fmax(fabs(edge[i][0]), fmax(fabs(edge[i][1]), fabs(edge[i][2])));
        if (!(largest > 0 && isfinite(largest)))
            return false;
        int exponent;
        frexp(largest, &exponent);
        for (int j = 0; j < 3; j++)
            edge[i][j] = ldexp(edge[i][j], -exponent);
    }
    return true;
}

double tm_scaled_jacobian(const double p[3], const double a[3], const double b[3],
                          const double c[3])
{
    double edge[3][3], normal[3];
    if (!scaled_edges(p, (const double *const[]){a, b, c}, edge))
        return 0;
    tm_cross(normal, edge[0], edge[1]);
    return tm_dot(normal, edge[2]) /
           sqrt(tm_norm2(edge[0]) * tm_norm2(edge[1]) * tm_norm2(edge[2]));
}

void tm_scaled_jacobians(const tm_element_shape *shape, const double (*xyz)[3],
                         const uint32_t *item, double jacobian[TM_CORNERS_MOST])
{
    double p[TM_ELEMENT_NODES_MOST][3];
    const size_t corners = shape->corners;
    for (size_t i = 0; i < corners; i += 2) {
        const unsigned char *first = shape->node[i], *second = shape->node[i + 1];
        memcpy(p[0], xyz[item[first[0]]], sizeof p[0]);
        memcpy(p[1], xyz[item[second[0]]], sizeof p[1]);
        const vector_pair a = edges(p, xyz[item[first[1]]], xyz[item[second[1]]]);
        const vector_pair b = edges(p, xyz[item[first[2]]], xyz[item[second[2]]]);
        const vector_pair c = edges(p, xyz[item[first[3]]], xyz[item[second[3]]]);
        const pair product = norm2(a) * norm2(b) * norm2(c);
        const pair length = {sqrt(product[0]), sqrt(product[1])};
        const pair value = determinant(a, b, c) / length;
        for (size_t j = 0; j < 2; j++) {
            const unsigned char *n = shape->node[i + j];
            jacobian[i + j] = low < product[j] && product[j] < high
                                  ? value[j]
                                  : tm_scaled_jacobian(xyz[item[n[0]]], xyz[item[n[1]]],
                                                       xyz[item[n[2]]], xyz[item[n[3]]]);
        }
    }
}

double tm_jens(size_t nodes, const double (*xyz)[3], const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    double jacobian[TM_CORNERS_MOST];
    tm_scaled_jacobians(shape, xyz, item, jacobian);
    double least = 1;
    for (size_t i = 0; i < shape->corners; i++) {
        const double value = tm_jens_of(jacobian[i], shape->k[i]);
        least = value < least ? value : least;
    }
    return least;
}

double tm_least_scaled_jacobian(size_t nodes, const double (*xyz)[3],
                                const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    double jacobian[TM_CORNERS_MOST];
    tm_scaled_jacobians(shape, xyz, item, jacobian);
    double least = 1;
    for (size_t i = 0; i < shape->corners; i++)
        least = jacobian[i] < least ? jacobian[i] : least;
    return least;
}

/* With unit vectors u, v, w along the edges a, b, c: ∂J/∂a = (v × w - J u) / |a|, and so
 * on in turn; what moves all three by as much moves p the other way. */
double tm_scaled_jacobian_slope(const double p[3], const double a[3], const double b[3],
                                const double c[3], double slope[4][3])
{
    const double *const to[3] = {a, b, c};
    double unit[3][3], length[3];
    memset(slope, 0, 4 * sizeof *slope);
    for (int i = 0; i < 3; i++) {
        tm_subtract(unit[i], to[i], p);
        length[i] = tm_norm(unit[i]);
        if (!(length[i] > 0 && isfinite(length[i])))
            return tm_scaled_jacobian(p, a, b, c);
        for (int j = 0; j < 3; j++)
            unit[i][j] /= length[i];
    }
    double across[3][3];
    for (int i = 0; i < 3; i++)
        tm_cross(across[i], unit[(i + 1) % 3], unit[(i + 2) % 3]);
    const double value = tm_dot(across[0], unit[0]);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            slope[i + 1][j] = (across[i][j] - value * unit[i][j]) / length[i];
            slope[0][j] -= slope[i + 1][j];
        }
    }
    return value;
}
