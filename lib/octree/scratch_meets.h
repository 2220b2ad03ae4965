/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef SCRATCH_MEETS_H
#define SCRATCH_MEETS_H
#include "../geom/vector.h"
#include "../surface/surface.h"
static inline bool scratch_meets(const tm_surface *S, uint32_t t, const double low[3],
                                 const double high[3])
{
    double v[3][3], h[3], scale = 0;
    for (int i = 0; i < 3; i++) {
        const double c = (low[i] + high[i]) / 2;
        h[i] = (high[i] - low[i]) / 2;
        scale = fmax(scale, fmax(fabs(low[i]), fabs(high[i])));
        for (int k = 0; k < 3; k++)
            v[k][i] = S->xyz[S->triangle[t][k]][i] - c;
    }
    const double eps = 1e-14 * scale;
    for (int i = 0; i < 3; i++) {
        h[i] += eps;
        const double lo = fmin(v[0][i], fmin(v[1][i], v[2][i]));
        const double hi = fmax(v[0][i], fmax(v[1][i], v[2][i]));
        if (lo > h[i] || hi < -h[i])
            return false;
    }
    double e[3][3], n[3];
    for (int k = 0; k < 3; k++)
        tm_subtract(e[k], v[(k + 1) % 3], v[k]);
    tm_cross(n, e[0], e[1]);
    if (fabs(tm_dot(n, v[0])) > fabs(n[0]) * h[0] + fabs(n[1]) * h[1] + fabs(n[2]) * h[2])
        return false;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3;
            const double p = e[k][a] * v[k][b] - e[k][b] * v[k][a];
            const double q = e[k][a] * v[(k + 2) % 3][b] - e[k][b] * v[(k + 2) % 3][a];
            const double r = fabs(e[k][a]) * h[b] + fabs(e[k][b]) * h[a];
            if (fmin(p, q) > r || fmax(p, q) < -r)
                return false;
        }
    return true;
}
static inline size_t scratch_cull(const tm_surface *S, const uint32_t *from, size_t n,
                                  const double low[3], const double high[3],
                                  size_t enough, uint32_t *to)
{
    size_t k = 0;
    for (size_t i = 0; i < n && k < enough; i++)
        if (scratch_meets(S, from[i], low, high))
            to[k++] = from[i];
    return k;
}
#endif
