/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_slope.h"

#include "../geom/vector.h"

/* With A, B, C the vectors from p to the corners, n_a = B × C … are the normals of the
 * faces opposite a, b, c, each twice as long as its face is large; that of abc is their
 * sum n_p. D = 6 V = -A · n_a, and sin α = D l / (|n_i| |n_j|) at an edge of length l
 * between faces i and j. The logarithms have simple gradients:
 * ∇D = n_p, ∇ln|A| = -A / |A|², ∇ln|n_a| = n_a × (C - B) / |n_a|², ∇n_p = 0. */
typedef struct {
    double to[3][3];     /* A, B, C */
    double normal[4][3]; /* opposite a, b, c, p */
    double bend[3][3];   /* ∇ln|n| of the first three */
    double size[4];      /* |n| */
    double length[3];    /* |A|, |B|, |C| */
    double base[3];      /* |BC|, |CA|, |AB| */
    double determinant;
} shape;

static bool measure_shape(shape *s, const double a[3], const double b[3],
                          const double c[3], const double p[3])
{
    const double low = 1e-100, high = 1e100;
    tm_subtract(s->to[0], a, p);
    tm_subtract(s->to[1], b, p);
    tm_subtract(s->to[2], c, p);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double along[3];
        tm_cross(s->normal[i], s->to[j], s->to[k]);
        tm_subtract(along, s->to[k], s->to[j]);
        tm_cross(s->bend[i], s->normal[i], along);
        double size2 = tm_norm2(s->normal[i]), length2 = tm_norm2(s->to[i]);
        if (!(size2 > low && size2 < high && length2 > low && length2 < high))
            return false;
        for (int x = 0; x < 3; x++)
            s->bend[i][x] /= size2;
        s->size[i] = sqrt(size2);
        s->length[i] = sqrt(length2);
        s->base[i] = tm_norm(along);
    }
    for (int x = 0; x < 3; x++)
        s->normal[3][x] = s->normal[0][x] + s->normal[1][x] + s->normal[2][x];
    s->size[3] = tm_norm(s->normal[3]);
    s->determinant = -tm_dot(s->to[0], s->normal[0]);
    return s->size[3] * s->size[3] > low;
}

static size_t slopes_of_sines(const shape *s, double limit, tm_slope slope[TM_SLOPES])
{
    size_t count = 0;
    for (int i = 0; i < 3; i++) { /* the edge of the base opposite corner i */
        double ratio = s->base[i] / (s->size[i] * s->size[3]);
        double sine = s->determinant * ratio;
        if (sine >= limit)
            continue;
        slope[count].value = sine;
        for (int x = 0; x < 3; x++)
            slope[count].gradient[x] = ratio * s->normal[3][x] - sine * s->bend[i][x];
        count++;
    }
    for (int i = 0; i < 3; i++) { /* the edge from p to corner i */
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double ratio = s->length[i] / (s->size[j] * s->size[k]);
        double sine = s->determinant * ratio;
        if (sine >= limit)
            continue;
        double length2 = s->length[i] * s->length[i];
        slope[count].value = sine;
        for (int x = 0; x < 3; x++)
            slope[count].gradient[x] =
                ratio * s->normal[3][x] -
                sine * (s->to[i][x] / length2 + s->bend[j][x] + s->bend[k][x]);
        count++;
    }
    return count;
}

static size_t slope_of_volume(const shape *s, double limit, tm_slope slope[TM_SLOPES])
{
    const double root2 = 1.41421356237309504880;
    double longest = 0;
    int end = -1; /* of the longest edge, if it is one from p */
    for (int i = 0; i < 3; i++)
        if (s->base[i] > longest)
            longest = s->base[i];
    for (int i = 0; i < 3; i++)
        if (s->length[i] > longest) {
            longest = s->length[i];
            end = i;
        }
    double ratio = root2 / (longest * longest * longest);
    double quality = s->determinant * ratio;
    if (quality >= limit)
        return 0;
    slope->value = quality;
    for (int x = 0; x < 3; x++) {
        slope->gradient[x] = ratio * s->normal[3][x];
        if (end >= 0)
            slope->gradient[x] += 3 * quality * s->to[end][x] / (longest * longest);
    }
    return 1;
}

size_t tm_tet_slopes(tm_tet_measure measure, const double a[3], const double b[3],
                     const double c[3], const double p[3], double limit,
                     tm_slope slope[TM_SLOPES])
{
    shape s;
    if (!measure_shape(&s, a, b, c, p))
        return 0;
    return measure == TM_MEASURE_DIHEDRAL ? slopes_of_sines(&s, limit, slope)
                                          : slope_of_volume(&s, limit, slope);
}
