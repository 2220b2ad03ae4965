/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shortest_vector.h"

#include "../../geom/vector.h"

#include <stdbool.h>
#include <string.h>

enum { CORNERS = 4 };

/* A simplex of some of the vectors, and the weights that make the point of it. */
typedef struct {
    const double *corner[CORNERS];
    double weight[CORNERS];
    int corners;
} simplex;

/* The point of the affine boundary of the corners that is nearest to the origin, as
 * weights; false where they are affinely dependent. */
static bool nearest_of_line_or_plane(const simplex *s, double weight[CORNERS])
{
    const double dependent = 1e-12;
    double u[3], v[3];
    weight[0] = 1;
    if (s->corners == 1)
        return true;
    const double *q = s->corner[0];
    tm_subtract(u, s->corner[1], q);
    double uu = tm_norm2(u), uq = tm_dot(u, q);
    if (s->corners == 2) {
        weight[1] = -uq / uu;
        weight[0] = 1 - weight[1];
        return uu > 0;
    }
    tm_subtract(v, s->corner[2], q);
    double vv = tm_norm2(v), uv = tm_dot(u, v), vq = tm_dot(v, q);
    double determinant = uu * vv - uv * uv;
    weight[1] = (uv * vq - vv * uq) / determinant;
    weight[2] = (uv * uq - uu * vq) / determinant;
    weight[0] = 1 - weight[1] - weight[2];
    return determinant > dependent * uu * vv;
}

/* The origin as weights of four corners; false where they are in a plane. */
static bool origin_in_space(const simplex *s, double weight[CORNERS])
{
    static const double origin[3] = {0, 0, 0};
    const double *const *c = s->corner;
    double all = tm_tet_volume(c[0], c[1], c[2], c[3]);
    weight[0] = tm_tet_volume(origin, c[1], c[2], c[3]) / all;
    weight[1] = tm_tet_volume(c[0], origin, c[2], c[3]) / all;
    weight[2] = tm_tet_volume(c[0], c[1], origin, c[3]) / all;
    weight[3] = 1 - weight[0] - weight[1] - weight[2];
    return isfinite(weight[0] + weight[1] + weight[2]);
}

/* Moves the point to the nearest one of the simplex. Corners that it does not need
 * leave. False where the last corner adds nothing. */
static bool approach(simplex *s)
{
    for (;;) {
        double target[CORNERS] = {0}, step = 1;
        int leaving = -1;
        if (s->corners == CORNERS ? !origin_in_space(s, target)
                                  : !nearest_of_line_or_plane(s, target)) {
            s->corners--;
            return false;
        }
        for (int i = 0; i < s->corners; i++)
            if (target[i] <= 0 && s->weight[i] < step * (s->weight[i] - target[i])) {
                step = s->weight[i] / (s->weight[i] - target[i]);
                leaving = i;
            }
        for (int i = 0; i < s->corners; i++)
            s->weight[i] += step * (target[i] - s->weight[i]);
        if (leaving < 0)
            return true;
        s->corners--;
        s->corner[leaving] = s->corner[s->corners];
        s->weight[leaving] = s->weight[s->corners];
    }
}

/* The vector that goes least along p, if that is less than p itself does. */
static const double *find_lower(const double *const *vector, size_t count,
                                const double p[3])
{
    const double close = 1e-9;
    const double *lowest = NULL;
    double least = tm_norm2(p) * (1 - close);
    for (size_t k = 0; k < count; k++) {
        double along = tm_dot(p, vector[k]);
        if (along < least) {
            least = along;
            lowest = vector[k];
        }
    }
    return lowest;
}

void tm_shortest_vector(const double *const *vector, size_t count, double shortest[3])
{
    enum { ROUNDS = 32 };
    simplex s = {.corner = {vector[0]}, .weight = {1}, .corners = 1};
    for (size_t k = 1; k < count; k++)
        if (tm_norm2(vector[k]) < tm_norm2(s.corner[0]))
            s.corner[0] = vector[k];
    memcpy(shortest, s.corner[0], 3 * sizeof *shortest);
    for (int round = 0; round < ROUNDS; round++) {
        const double *lower = find_lower(vector, count, shortest);
        if (!lower)
            return;
        s.corner[s.corners] = lower;
        s.weight[s.corners++] = 0;
        if (!approach(&s))
            return;
        memset(shortest, 0, 3 * sizeof *shortest);
        for (int i = 0; i < s.corners && s.corners < CORNERS; i++)
            for (int x = 0; x < 3; x++)
                shortest[x] += s.weight[i] * s.corner[i][x];
        if (s.corners == CORNERS)
            return;
    }
}
