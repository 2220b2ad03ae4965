/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "certify.h"

#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "jens.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum {
    BASE_CORNERS = 4,
    COEFFICIENTS = 27,
    STRIDE_ETA = 3,
    STRIDE_ZETA = 9,
    HALVINGS = 60 /* 20 in each direction */
};

/* Edge vectors are rounded differences: each coordinate is right to a factor 1 + u (u =
 * TM_HALF_ULP). A coefficient is an average of determinants of three such vectors, each
 * six products; a product meets the factors of its 3 coordinates, 2 in the normal, 1 in
 * the average of normals, 3 in the scalar product and 3 in the sum. With A, B, C the
 * largest coordinates of the three kinds of edges the error is below 6·12·u·ABC, but for
 * terms of u²; what the bound below has more pays for those, and for the rounding of
 * ABC. A halving adds two roundings of something below 6ABC in size. */
static const double coefficient_error = 6 * 16 * TM_HALF_ULP;
static const double halving_error = 6 * 3 * TM_HALF_ULP;

/* Where the largest coordinates are within these nothing that counts underflows, and
 * nothing overflows, products of two determinants included. */
static const double smallest_edge = 1e-45;
static const double longest_edge = 1e45;

typedef double vectors[4][3];

/* The sign of the determinant at corner i of the shape, exactly. */
static int corner_sign(const tm_element_shape *shape, size_t i, const double (*xyz)[3],
                       const uint32_t *item)
{
    const uint8_t *n = shape->corner[i];
    return tm_orient3d(xyz[item[n[0]]], xyz[item[n[1]]], xyz[item[n[2]]],
                       xyz[item[n[3]]]);
}

static bool corners_are_positive(const tm_element_shape *shape, size_t corners,
                                 const double (*xyz)[3], const uint32_t *item)
{
    for (size_t i = 0; i < corners; i++)
        if (corner_sign(shape, i, xyz, item) <= 0)
            return false;
    return true;
}

/* edge[i] = end - begin of so many pairs; returns the largest coordinate. */
static double edge_vectors(vectors edge, const unsigned char (*pair)[2], size_t edges,
                           const double (*xyz)[3], const uint32_t *item)
{
    double largest = 0;
    for (size_t i = 0; i < edges; i++) {
        tm_subtract(edge[i], xyz[item[pair[i][1]]], xyz[item[pair[i][0]]]);
        for (size_t j = 0; j < 3; j++) {
            const double size = fabs(edge[i][j]);
            largest = size > largest ? size : largest;
        }
    }
    return largest;
}

/* Multiplies by a power of two so that the largest coordinate is in [1/2, 1). */
static double normalise(vectors edge, size_t edges, double largest)
{
    if (!(largest > 0 && isfinite(largest)))
        return largest;
    int exponent;
    const double fraction = frexp(largest, &exponent);
    for (size_t i = 0; i < edges; i++)
        for (size_t j = 0; j < 3; j++)
            edge[i][j] = ldexp(edge[i][j], -exponent);
    return fraction;
}

/* The product of the largest coordinates of three kinds of edges. Where one is too small
 * or too large, each kind is scaled by itself first, which does not change the
 * determinant's sign; what then underflows is below 2^-1074 of what is 1. */
static double scale_of(vectors edge[3], const size_t edges[3], const double largest[3])
{
    bool within = true;
    double scale = 1;
    for (size_t i = 0; i < 3; i++)
        within &= smallest_edge < largest[i] && largest[i] < longest_edge;
    for (size_t i = 0; i < 3; i++)
        scale *= within ? largest[i] : normalise(edge[i], edges[i], largest[i]);
    return scale;
}

/* A quadratic c0 B0 + c1 B1 + c2 B2 of which each coefficient is right to ±error and the
 * outer ones are positive: is it positive in [0, 1]? With c1 < 0 it is if c1² < c0 c2. */
static tm_certificate certify_quadratic(const double c[3], double error)
{
    const double margin = 1 + 4 * TM_HALF_ULP;
    const double low[3] = {c[0] - error, c[1] - error, c[2] - error};
    const double high[3] = {c[0] + error, c[1] + error, c[2] + error};
    if (low[1] >= 0)
        return TM_POSITIVE;
    if (low[0] > 0 && low[2] > 0 && low[1] * low[1] * margin < low[0] * low[2])
        return TM_POSITIVE;
    if (high[1] < 0 && high[1] * high[1] > high[0] * high[2] * margin)
        return TM_NOT_POSITIVE;
    return TM_UNDECIDED;
}

/* Along the lateral edge of corner i the determinant is that of u, v, w, where w is the
 * edge, and u and v go from one triangle's edges to the other's. */
static tm_certificate certify_wedge(const double (*xyz)[3], const uint32_t *item)
{
    static const unsigned char side[2][2][2] = {{{0, 2}, {3, 5}}, {{0, 1}, {3, 4}}};
    static const unsigned char lateral[3][2] = {{0, 3}, {1, 4}, {2, 5}};
    static const size_t edges[3] = {2, 2, 3};
    const double half = 0.5;
    const tm_element_shape *shape = &tm_element_shapes[TM_WEDGE_NODES];
    if (!corners_are_positive(shape, shape->corners, xyz, item))
        return TM_NOT_POSITIVE;
    vectors edge[3];
    const double largest[3] = {edge_vectors(edge[0], side[0], 2, xyz, item),
                               edge_vectors(edge[1], side[1], 2, xyz, item),
                               edge_vectors(edge[2], lateral, 3, xyz, item)};
    const double scale = scale_of(edge, edges, largest);
    if (!isfinite(scale))
        return TM_UNDECIDED;
    double normal[2][2][3], middle[3];
    for (size_t i = 0; i < 2; i++)
        for (size_t j = 0; j < 2; j++)
            tm_cross(normal[i][j], edge[0][i], edge[1][j]);
    for (size_t i = 0; i < 3; i++)
        middle[i] = half * (normal[0][1][i] + normal[1][0][i]);
    tm_certificate worst = TM_POSITIVE;
    for (size_t i = 0; i < 3; i++) {
        const double c[3] = {tm_dot(normal[0][0], edge[2][i]), tm_dot(middle, edge[2][i]),
                             tm_dot(normal[1][1], edge[2][i])};
        const tm_certificate one = certify_quadratic(c, coefficient_error * scale);
        if (one == TM_NOT_POSITIVE)
            return one;
        worst = one == TM_UNDECIDED ? one : worst;
    }
    return worst;
}

/* The normals y × z of the edges in η and in ζ by their order in ξ, 0, 1 or 2, and by the
 * position of the first in ζ and of the second in η: sums of the products whose positions
 * in ξ add up to the order, times their weight. */
static void hexahedron_normals(vectors edge[3], double normal[3][2][2][3])
{
    const double half = 0.5;
    for (size_t a = 0; a < 2; a++) {
        for (size_t b = 0; b < 2; b++) {
            /* Edge ξ + 2ζ of those in η, and ξ + 2η of those in ζ. */
            double across[3];
            tm_cross(normal[0][a][b], edge[1][2 * a], edge[2][2 * b]);
            tm_cross(normal[2][a][b], edge[1][2 * a + 1], edge[2][2 * b + 1]);
            tm_cross(normal[1][a][b], edge[1][2 * a], edge[2][2 * b + 1]);
            tm_cross(across, edge[1][2 * a + 1], edge[2][2 * b]);
            for (size_t i = 0; i < 3; i++)
                normal[1][a][b][i] = half * (normal[1][a][b][i] + across[i]);
        }
    }
}

/* The coefficients of the determinant, that of B_i(ξ) B_j(η) B_k(ζ) at i + 3j + 9k. */
static void hexahedron_coefficients(vectors edge[3], double c[COEFFICIENTS])
{
    static const double weight[3] = {1, 0.5, 1};
    double normal[3][2][2][3];
    hexahedron_normals(edge, normal);
    for (size_t i = 0; i < 3; i++) {
        double sum[3][3] = {{0}};
        for (size_t x = 0; x < 4; x++) { /* edge η + 2ζ of those in ξ */
            for (size_t a = 0; a < 2; a++)
                for (size_t b = 0; b < 2; b++)
                    sum[x % 2 + b][x / 2 + a] += tm_dot(normal[i][a][b], edge[0][x]);
        }
        for (size_t j = 0; j < 3; j++)
            for (size_t k = 0; k < 3; k++)
                c[i + STRIDE_ETA * j + STRIDE_ZETA * k] =
                    weight[j] * weight[k] * sum[j][k];
    }
}

/* A part of a hexahedron that is still to be looked at. */
typedef struct box {
    double c[COEFFICIENTS];
    unsigned halvings;
} box;

static double least_coefficient(const double c[COEFFICIENTS])
{
    double least = c[0];
    for (size_t i = 1; i < COEFFICIENTS; i++)
        least = c[i] < least ? c[i] : least;
    return least;
}

/* The least determinant at a corner of the part, where it is the coefficient. */
static double least_corner(const double c[COEFFICIENTS])
{
    static const unsigned char corner[] = {0, 2, 6, 8, 18, 20, 24, 26};
    double least = c[0];
    for (size_t i = 1; i < sizeof corner; i++)
        least = c[corner[i]] < least ? c[corner[i]] : least;
    return least;
}

/* Halves a part in the direction whose turn it is (de Casteljau): it keeps the lower
 * half, *upper gets the other one. */
static void halve(box *part, box *upper)
{
    static const size_t stride[3] = {1, STRIDE_ETA, STRIDE_ZETA};
    const double half = 0.5;
    const size_t axis = part->halvings % 3;
    const size_t step = stride[axis];
    const size_t row[2] = {stride[(axis + 1) % 3], stride[(axis + 2) % 3]};
    for (size_t i = 0; i < 3; i++) {
        for (size_t j = 0; j < 3; j++) {
            double *low = &part->c[i * row[0] + j * row[1]];
            double *high = &upper->c[i * row[0] + j * row[1]];
            const double left = half * (low[0] + low[step]);
            const double right = half * (low[step] + low[2 * step]);
            high[2 * step] = low[2 * step];
            high[step] = right;
            high[0] = half * (left + right);
            low[step] = left;
            low[2 * step] = high[0];
        }
    }
    part->halvings++;
    upper->halvings = part->halvings;
}

/* Looks at the parts one after the other. Undecided parts are left behind, for another
 * one may be negative. */
static tm_certificate halve_again(const double c[COEFFICIENTS], double scale)
{
    box stack[HALVINGS + 1];
    size_t parts = 1;
    tm_certificate found = TM_POSITIVE;
    memcpy(stack[0].c, c, sizeof stack[0].c);
    stack[0].halvings = 0;
    for (size_t looks = 0; parts > 0; looks++) {
        if (looks == TM_CERTIFY_BOXES)
            return TM_UNDECIDED;
        box *part = &stack[parts - 1];
        const double error = scale * (coefficient_error + halving_error * part->halvings);
        if (least_coefficient(part->c) > error) {
            parts--;
        } else if (least_corner(part->c) < -error) {
            return TM_NOT_POSITIVE;
        } else if (part->halvings == HALVINGS) {
            found = TM_UNDECIDED;
            parts--;
        } else {
            halve(part, &stack[parts]);
            parts++;
        }
    }
    return found;
}

static tm_certificate certify_hexahedron(const double (*xyz)[3], const uint32_t *item)
{
    static const unsigned char along[3][4][2] = {{{0, 1}, {3, 2}, {4, 5}, {7, 6}},
                                                 {{0, 3}, {1, 2}, {4, 7}, {5, 6}},
                                                 {{0, 4}, {1, 5}, {3, 7}, {2, 6}}};
    static const size_t edges[3] = {4, 4, 4};
    vectors edge[3];
    double largest[3], c[COEFFICIENTS];
    for (size_t i = 0; i < 3; i++)
        largest[i] = edge_vectors(edge[i], along[i], edges[i], xyz, item);
    const double scale = scale_of(edge, edges, largest);
    hexahedron_coefficients(edge, c);
    if (least_coefficient(c) > coefficient_error * scale)
        return TM_POSITIVE;
    const tm_element_shape *shape = &tm_element_shapes[TM_HEX_NODES];
    if (!corners_are_positive(shape, shape->corners, xyz, item))
        return TM_NOT_POSITIVE;
    return isfinite(scale) ? halve_again(c, scale) : TM_UNDECIDED;
}

tm_certificate tm_certify(size_t nodes, const double (*xyz)[3], const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    switch (nodes) {
    case TM_HEX_NODES:
        return certify_hexahedron(xyz, item);
    case TM_WEDGE_NODES:
        return certify_wedge(xyz, item);
    case TM_PYRAMID_NODES:
        return corners_are_positive(shape, BASE_CORNERS, xyz, item) ? TM_POSITIVE
                                                                    : TM_NOT_POSITIVE;
    default:
        return corner_sign(shape, 0, xyz, item) > 0 ? TM_POSITIVE : TM_NOT_POSITIVE;
    }
}
