/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The objective that takes inverted elements out of each other: the distortion of the map
 * from the regular element to each corner, its determinant kept positive by a number ε
 * that goes to 0 (V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D.
 * Sokolov, Foldover-free maps in 50 lines of code, ACM Transactions on Graphics 40,
 * 2021):
 *
 *     f = (tr AᵀA / 3)^(3/2) / χ(det A),    χ(D) = (D + √(ε² + D²)) / 2
 *
 * with A = E W⁻¹, E the edges at the corner over the element's size, W those of the
 * regular element. Unlike J_S, whose slope is 0 where all is turned, f pulls the harder
 * the more an element is inverted. */
#include "optimise_parts.h"

#include "../element/jens.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

/* Of a regular corner: (WᵀW)⁻¹, where tr AᵀA = Σ m_ij e_i · e_j, and det W. */
typedef struct regular {
    double m[3][3];
    double determinant;
} regular;

static const regular right = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1};
static const regular tetrahedron = {
    {{1.5, -0.5, -0.5}, {-0.5, 1.5, -0.5}, {-0.5, -0.5, 1.5}}, TM_K_TETRAHEDRON};
static const regular wedge = {{{4.0 / 3, -2.0 / 3, 0}, {-2.0 / 3, 4.0 / 3, 0}, {0, 0, 1}},
                              TM_K_WEDGE};

/* The pyramid is as high as its base is wide: its lateral edges have length √(3/2). */
static const regular base = {{{1.25, 0.25, -0.5}, {0.25, 1.25, -0.5}, {-0.5, -0.5, 1}},
                             1};
static const regular apex = {{{1.25, -1, 0.25}, {-1, 2, -1}, {0.25, -1, 1.25}}, 1};

static const regular *regular_of(size_t nodes, size_t corner)
{
    enum { BASE_CORNERS = 4 };
    switch (nodes) {
    case TM_TET_NODES:
        return &tetrahedron;
    case TM_PYRAMID_NODES:
        return corner < BASE_CORNERS ? &base : &apex;
    case TM_WEDGE_NODES:
        return &wedge;
    default:
        return &right;
    }
}

/* A corner as f sees it. */
typedef struct distortion {
    const regular *of;
    uint32_t node[4];
    double edge[3][3]; /* over the size */
    double third;      /* tr AᵀA / 3 */
    double determinant;
    double root; /* √(ε² + D²) */
    double chi;
} distortion;

/* √(ε² + D²), without the care that hypot() takes: D is near 1. */
static double find_root(double determinant, double epsilon)
{
    return sqrt(epsilon * epsilon + determinant * determinant);
}

/* D + root would lose all digits where D is far below 0. */
static double find_chi(double determinant, double root, double epsilon)
{
    return determinant >= 0 ? (determinant + root) / 2
                            : epsilon * epsilon / (2 * (root - determinant));
}

static void measure(const tm_cluster *cluster, size_t e, size_t corner, double epsilon,
                    distortion *d)
{
    const size_t start = cluster->start[e], nodes = cluster->start[e + 1] - start;
    const uint8_t *at = tm_element_shapes[nodes].corner[corner];
    const double scale = 1 / cluster->element_size[e];
    d->of = regular_of(nodes, corner);
    for (size_t i = 0; i < 4; i++)
        d->node[i] = cluster->item[start + at[i]];
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++)
            d->edge[i][j] =
                (cluster->xyz[d->node[i + 1]][j] - cluster->xyz[d->node[0]][j]) * scale;
    double trace = 0, normal[3];
    for (size_t i = 0; i < 3; i++) {
        const size_t j = (i + 1) % 3;
        trace += d->of->m[i][i] * tm_norm2(d->edge[i]);
        if (d->of->m[i][j] != 0)
            trace += 2 * d->of->m[i][j] * tm_dot(d->edge[i], d->edge[j]);
    }
    tm_cross(normal, d->edge[0], d->edge[1]);
    d->third = trace / 3;
    d->determinant = tm_dot(normal, d->edge[2]) / d->of->determinant;
    d->root = find_root(d->determinant, epsilon);
    d->chi = find_chi(d->determinant, d->root, epsilon);
}

/* Adds the derivative of f at one corner to those of its nodes that move. */
static void add_slope(const tm_cluster *cluster, const distortion *d, double scale)
{
    const double root = sqrt(d->third);
    const double by_edge = scale * root / d->chi;
    const double by_determinant =
        -scale * d->third * root / (d->chi * d->root * d->of->determinant);
    double from[3] = {0, 0, 0};
    for (size_t i = 0; i < 3; i++) {
        const double *m = d->of->m[i];
        double part[3];
        tm_cross(part, d->edge[(i + 1) % 3], d->edge[(i + 2) % 3]);
        for (size_t k = 0; k < 3; k++) {
            part[k] = by_determinant * part[k] +
                      by_edge * (m[0] * d->edge[0][k] + m[1] * d->edge[1][k] +
                                 m[2] * d->edge[2][k]);
            from[k] += part[k];
        }
        const uint32_t v = d->node[i + 1];
        for (size_t k = 0; v < cluster->moving && k < 3; k++)
            cluster->pull[v][k] += part[k];
    }
    const uint32_t v = d->node[0];
    for (size_t k = 0; v < cluster->moving && k < 3; k++)
        cluster->pull[v][k] -= from[k];
}

double tm_untangle_value(tm_cluster *cluster, double epsilon)
{
    double sum = 0;
    cluster->least_determinant = INFINITY;
    memset(cluster->pull, 0, cluster->moving * sizeof *cluster->pull);
    for (size_t e = 0; e < cluster->elements; e++) {
        const size_t nodes = cluster->start[e + 1] - cluster->start[e];
        const double scale = 1 / cluster->element_size[e];
        for (size_t i = 0; i < tm_element_shapes[nodes].corners; i++) {
            distortion d;
            measure(cluster, e, i, epsilon, &d);
            sum += d.third * sqrt(d.third) / d.chi;
            cluster->least_determinant = fmin(cluster->least_determinant, d.determinant);
            add_slope(cluster, &d, scale);
        }
    }
    return sum;
}

/* Their section 3: by how much less than before the value became; but at least by
 * 0.6, where they have 0.1: it takes too many steps, and untangles less. */
double tm_untangle_next(const tm_cluster *cluster, double epsilon, double gain)
{
    const double least = cluster->least_determinant;
    const double rest = 1 - fmax(gain, 0.6);
    if (least >= 0)
        return rest * epsilon;
    const double chi = rest * find_chi(least, find_root(least, epsilon), epsilon);
    return 2 * sqrt(chi * (chi - least));
}
