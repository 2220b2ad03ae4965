/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "barycentric.h"

#include "vector.h"

#include <float.h>

/* The edges from corner 0, and at the end the point. */
enum { EDGES = 3, POINT = EDGES };

typedef struct {
    double x[3];         /* what of it is normal to the edges before it */
    double along[EDGES]; /* how much of the part of each of these it has */
    int corner;
} part;

/* Rounded coordinates may be this much off, of their size. */
static const double rounding = 8 * DBL_EPSILON;

/* Of the edges from `first` on the longest becomes the first. */
static void bring_longest(part *edge, int first)
{
    int longest = first;
    for (int i = first + 1; i < EDGES; i++)
        if (tm_norm2(edge[i].x) > tm_norm2(edge[longest].x))
            longest = i;
    const part moved = edge[longest];
    edge[longest] = edge[first];
    edge[first] = moved;
}

/* What is after edge k becomes normal to it. */
static void make_normal(part *edge, int k)
{
    for (int i = k + 1; i <= POINT; i++) {
        edge[i].along[k] = tm_dot(edge[i].x, edge[k].x) / tm_norm2(edge[k].x);
        for (int x = 0; x < 3; x++)
            edge[i].x[x] -= edge[i].along[k] * edge[k].x[x];
    }
}

double tm_barycentric(const double *const corner[4], const double p[3], double weight[4])
{
    part edge[POINT + 1];
    double least = HUGE_VAL, longest2 = 0;
    int edges = 0;
    for (int i = 0; i <= POINT; i++) {
        tm_subtract(edge[i].x, i < POINT ? corner[i + 1] : p, corner[0]);
        edge[i].corner = i + 1;
    }
    for (; edges < EDGES; edges++) {
        bring_longest(edge, edges);
        const double height2 = tm_norm2(edge[edges].x);
        longest2 = fmax(longest2, height2);
        if (!(height2 > rounding * rounding * (longest2 + tm_norm2(corner[0]))))
            break;
        make_normal(edge, edges);
    }
    for (int i = 0; i < 4; i++)
        weight[i] = i == 0;
    for (int k = edges - 1; k >= 0; k--) {
        double *w = &weight[edge[k].corner];
        *w = edge[POINT].along[k];
        for (int i = k + 1; i < edges; i++)
            *w -= weight[edge[i].corner] * edge[i].along[k];
        weight[0] -= *w;
    }
    for (int i = 0; i < 4; i++)
        least = fmin(least, weight[i]);
    if (edges == EDGES)
        return least;
    return fmin(least, -sqrt(tm_norm2(edge[POINT].x) / fmax(longest2, DBL_MIN)));
}
