/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "aspect_ratio.h"

#include "../geom/vector.h"
#include "shape.h"

#include <string.h>

/* The shortest and the longest of the squared lengths so far. */
typedef struct span {
    double shortest, longest;
} span;

static void take(span *s, double length2)
{
    s->shortest = length2 < s->shortest ? length2 : s->shortest;
    s->longest = length2 > s->longest ? length2 : s->longest;
}

static double ratio(const span *s)
{
    return s->longest > 0 ? sqrt(s->shortest / s->longest) : 0;
}

/* The mean of so many of the nodes. */
static void centre(double c[3], const double (*p)[3], const unsigned char *node,
                   size_t count)
{
    for (size_t i = 0; i < 3; i++) {
        c[i] = 0;
        for (size_t v = 0; v < count; v++)
            c[i] += p[node[v]][i];
        c[i] /= (double)count;
    }
}

/* The squared distance between the centres of two groups of nodes. */
static double between(const double (*p)[3], const unsigned char *from, size_t from_count,
                      const unsigned char *to, size_t to_count)
{
    double a[3], b[3];
    centre(a, p, from, from_count);
    centre(b, p, to, to_count);
    return tm_distance2(a, b);
}

static double hexahedron(const double (*p)[3])
{
    static const unsigned char face[3][2][4] = {{{0, 3, 7, 4}, {1, 2, 6, 5}},
                                                {{0, 1, 5, 4}, {3, 2, 6, 7}},
                                                {{0, 1, 2, 3}, {4, 5, 6, 7}}};
    span s = {INFINITY, 0};
    for (size_t i = 0; i < 3; i++)
        take(&s, between(p, face[i][0], 4, face[i][1], 4));
    return ratio(&s);
}

static double wedge(const double (*p)[3])
{
    /* A quadrilateral's nodes in turn, its second and fourth edge lateral ones, and the
     * lateral edge opposite. */
    static const unsigned char side[3][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
    static const unsigned char opposite[3][2] = {{2, 5}, {0, 3}, {1, 4}};
    span s = {INFINITY, 0};
    for (size_t i = 0; i < 3; i++) {
        const unsigned char *q = side[i];
        const unsigned char last[2] = {q[3], q[0]};
        take(&s, between(p, &q[0], 2, &q[2], 2));
        take(&s, between(p, &q[1], 2, last, 2));
        take(&s, between(p, q, 4, opposite[i], 2));
    }
    return ratio(&s);
}

static double pyramid(const double (*p)[3])
{
    static const unsigned char edge[4][2] = {{0, 1}, {3, 2}, {0, 3}, {1, 2}};
    static const unsigned char base[4] = {0, 1, 2, 3};
    double middle[4][3], across[2][3], normal[3], c[3], up[3];
    for (size_t i = 0; i < 4; i++)
        centre(middle[i], p, edge[i], 2);
    tm_subtract(across[0], middle[1], middle[0]);
    tm_subtract(across[1], middle[3], middle[2]);
    centre(c, p, base, 4);
    tm_subtract(up, p[4], c);
    tm_cross(normal, across[0], across[1]);
    const double area2 = tm_norm2(normal);
    const double rise = tm_dot(up, normal);
    span s = {INFINITY, 0};
    take(&s, tm_norm2(across[0]));
    take(&s, tm_norm2(across[1]));
    take(&s, area2 > 0 ? rise * rise / area2 : 0);
    return ratio(&s);
}

static double tetrahedron(const double (*p)[3])
{
    const double per_volume = 8.48528137423857029281; /* 6√2 */
    const double edges = 6;
    double sum = 0;
    for (size_t i = 0; i < 4; i++)
        for (size_t j = i + 1; j < 4; j++)
            sum += tm_distance2(p[i], p[j]);
    const double mean = sum / edges;
    return per_volume * fabs(tm_tet_volume(p[0], p[1], p[2], p[3])) / (mean * sqrt(mean));
}

double tm_aspect_ratio(size_t nodes, const double (*xyz)[3], const uint32_t *item)
{
    double p[TM_ELEMENT_NODES][3];
    for (size_t v = 0; v < nodes; v++)
        memcpy(p[v], xyz[item[v]], sizeof p[v]);
    if (tm_bring_into_range(p, nodes) == 0)
        return 0;
    switch (nodes) {
    case TM_HEX_NODES:
        return hexahedron(p);
    case TM_WEDGE_NODES:
        return wedge(p);
    case TM_PYRAMID_NODES:
        return pyramid(p);
    default:
        return tetrahedron(p);
    }
}
