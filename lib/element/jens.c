/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each edge is measured once, for the corners at both of its ends. Two edges and two
 * corners are computed at a time, in both halves of a 16-byte vector (an extension
 * that GCC and Clang have on every machine). Both halves do what scalar code would, so
 * results do not depend on the machine. They are, to the last bit, (a × b)·c over |a| |b|
 * |c|, where c is an edge to the third neighbour: signs of edges, and a for b, change no
 * rounding. */
#include "jens.h"

#include "../geom/vector.h"

#include <stdbool.h>
#include <string.h>

typedef double pair __attribute__((vector_size(2 * sizeof(double))));

typedef struct vector_pair {
    pair x, y, z;
} vector_pair;

/* The edges of an element, and where their number is odd one more that is not used: their
 * vectors and lengths, in pairs. */
typedef union edge_numbers {
    pair two[TM_ELEMENT_EDGES / 2];
    double one[TM_ELEMENT_EDGES];
} edge_numbers;

typedef struct edge_vectors {
    edge_numbers x, y, z, length;
} edge_vectors;

/* Products of three lengths outside of these are not trusted. */
static const double low = 1e-125;
static const double high = 1e125;

static inline void measure_edges(const tm_element_shape *shape, const double (*xyz)[3],
                                 const uint32_t *item, edge_vectors *edge)
{
    for (size_t e = 0; e < shape->edges; e += 2) {
        const uint8_t *first = shape->edge[e], *second = shape->edge[e + 1];
        const double *a = xyz[item[first[0]]], *b = xyz[item[first[1]]];
        const double *c = xyz[item[second[0]]], *d = xyz[item[second[1]]];
        const pair x = (pair){b[0], d[0]} - (pair){a[0], c[0]};
        const pair y = (pair){b[1], d[1]} - (pair){a[1], c[1]};
        const pair z = (pair){b[2], d[2]} - (pair){a[2], c[2]};
        edge->x.two[e / 2] = x;
        edge->y.two[e / 2] = y;
        edge->z.two[e / 2] = z;
        const pair length2 = x * x + y * y + z * z;
        edge->length.two[e / 2] = (pair){sqrt(length2[0]), sqrt(length2[1])};
    }
}

static inline pair two_of(const edge_numbers *number, size_t i, size_t j)
{
    return (pair){number->one[i], number->one[j]};
}

static inline vector_pair two_edges(const edge_vectors *edge, size_t i, size_t j)
{
    return (vector_pair){two_of(&edge->x, i, j), two_of(&edge->y, i, j),
                         two_of(&edge->z, i, j)};
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
           (tm_norm(edge[0]) * tm_norm(edge[1]) * tm_norm(edge[2]));
}

void tm_scaled_jacobians(const tm_element_shape *shape, const double (*xyz)[3],
                         const uint32_t *item, double jacobian[TM_ELEMENT_CORNERS])
{
    pair value[TM_ELEMENT_CORNERS / 2], product[TM_ELEMENT_CORNERS / 2];
    edge_vectors edge;
    measure_edges(shape, xyz, item, &edge);
    for (size_t i = 0; i < shape->corners; i += 2) {
        const uint8_t *m = shape->corner_edge[i], *n = shape->corner_edge[i + 1];
        value[i / 2] =
            determinant(two_edges(&edge, m[0], n[0]), two_edges(&edge, m[1], n[1]),
                        two_edges(&edge, m[2], n[2]));
        product[i / 2] = two_of(&edge.length, m[0], n[0]) *
                         two_of(&edge.length, m[1], n[1]) *
                         two_of(&edge.length, m[2], n[2]);
    }
    for (size_t i = 0; i < shape->corners; i++) {
        const uint8_t *n = shape->corner[i];
        const double lengths = product[i / 2][i % 2];
        jacobian[i] = low < lengths && lengths < high
                          ? value[i / 2][i % 2] / lengths
                          : tm_scaled_jacobian(xyz[item[n[0]]], xyz[item[n[1]]],
                                               xyz[item[n[2]]], xyz[item[n[3]]]);
    }
}

double tm_jens(size_t nodes, const double (*xyz)[3], const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    double jacobian[TM_ELEMENT_CORNERS];
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
    double jacobian[TM_ELEMENT_CORNERS];
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
