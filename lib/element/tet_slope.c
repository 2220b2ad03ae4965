/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_slope.h"

#include "../geom/vector.h"

#include <string.h>

/* With A, B, C the vectors from p to the corners, n_a = B × C … are the normals of the
 * faces opposite a, b, c, each twice as long as its face is large; that of abc is their
 * sum n_p. D = 6 V = -A · n_a, and sin α = D l / (|n_i| |n_j|) at an edge of length l
 * between faces i and j. The logarithms have simple gradients:
 * ∇D = n_p, ∇ln|A| = -A / |A|², ∇ln|n_a| = n_a × (C - B) / |n_a|², ∇n_p = 0. Most edges
 * are not asked for: sin² tells that without a root or a division. */
typedef struct {
    double to[3][3];     /* A, B, C */
    double along[3][3];  /* C - B, A - C, B - A */
    double normal[4][3]; /* opposite a, b, c, p */
    double normal2[4];   /* |n|² */
    double length2[3];   /* |A|², … */
    double base2[3];     /* |C - B|², … */
    double determinant;
    double factor; /* of all lengths, so that products of them are in range */
} shape;

static bool measure_shape(shape *s, const double a[3], const double b[3],
                          const double c[3], const double p[3])
{
    const double low = 1e-100, high = 1e100;
    double corner[4][3] = {
        {p[0], p[1], p[2]}, {a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}};
    s->factor = tm_bring_into_range(corner, 4);
    bool is_measured = s->factor > 0 && isfinite(s->factor);
    memcpy(s->to, corner + 1, sizeof s->to);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        tm_cross(s->normal[i], s->to[j], s->to[k]);
        tm_subtract(s->along[i], s->to[k], s->to[j]);
        s->normal2[i] = tm_norm2(s->normal[i]);
        s->length2[i] = tm_norm2(s->to[i]);
        s->base2[i] = tm_norm2(s->along[i]);
        is_measured &= s->normal2[i] > low && s->normal2[i] < high &&
                       s->length2[i] > low && s->length2[i] < high;
    }
    for (int x = 0; x < 3; x++)
        s->normal[3][x] = s->normal[0][x] + s->normal[1][x] + s->normal[2][x];
    s->normal2[3] = tm_norm2(s->normal[3]);
    s->determinant = -tm_dot(s->to[0], s->normal[0]);
    return is_measured && s->normal2[3] > low && s->normal2[3] < high;
}

/* Whether the sine at an edge with length² l2, whose faces have that product of |n|², is
 * below the limit. */
static bool is_below(const shape *s, double l2, double faces, double limit)
{
    return s->determinant <= 0 ||
           s->determinant * s->determinant * l2 < limit * limit * faces;
}

/* Adds ∇ln|n_i| to a sum. */
static void add_bend(const shape *s, int i, double sum[3])
{
    double bend[3];
    tm_cross(bend, s->normal[i], s->along[i]);
    for (int x = 0; x < 3; x++)
        sum[x] += bend[x] / s->normal2[i];
}

/* The slope at an edge, where sum is the gradient of the logarithm of what D is divided
 * by. */
static tm_slope slope_of_sine(const shape *s, double l2, double faces,
                              const double sum[3])
{
    double ratio = sqrt(l2 / faces);
    tm_slope slope = {.value = s->determinant * ratio};
    for (int x = 0; x < 3; x++)
        slope.gradient[x] = ratio * s->normal[3][x] - slope.value * sum[x];
    return slope;
}

static size_t slopes_of_sines(const shape *s, double limit, tm_slope slope[TM_SLOPES])
{
    size_t count = 0;
    for (int i = 0; i < 3; i++) { /* the edge of the base opposite corner i */
        double faces = s->normal2[i] * s->normal2[3], sum[3] = {0, 0, 0};
        if (!is_below(s, s->base2[i], faces, limit))
            continue;
        add_bend(s, i, sum);
        slope[count++] = slope_of_sine(s, s->base2[i], faces, sum);
    }
    for (int i = 0; i < 3; i++) { /* the edge from p to corner i */
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double faces = s->normal2[j] * s->normal2[k], sum[3];
        if (!is_below(s, s->length2[i], faces, limit))
            continue;
        for (int x = 0; x < 3; x++)
            sum[x] = s->to[i][x] / s->length2[i];
        add_bend(s, j, sum);
        add_bend(s, k, sum);
        slope[count++] = slope_of_sine(s, s->length2[i], faces, sum);
    }
    return count;
}

static size_t slope_of_volume(const shape *s, double limit, tm_slope slope[TM_SLOPES])
{
    const double root2 = 1.41421356237309504880;
    double longest2 = 0;
    int end = -1; /* of the longest edge, if it is one from p */
    for (int i = 0; i < 3; i++)
        longest2 = s->base2[i] > longest2 ? s->base2[i] : longest2;
    for (int i = 0; i < 3; i++)
        if (s->length2[i] > longest2) {
            longest2 = s->length2[i];
            end = i;
        }
    double ratio = root2 / (longest2 * sqrt(longest2));
    double quality = s->determinant * ratio;
    if (quality >= limit)
        return 0;
    slope->value = quality;
    for (int x = 0; x < 3; x++) {
        slope->gradient[x] = ratio * s->normal[3][x];
        if (end >= 0)
            slope->gradient[x] += 3 * quality * s->to[end][x] / longest2;
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
    size_t count = measure == TM_MEASURE_DIHEDRAL ? slopes_of_sines(&s, limit, slope)
                                                  : slope_of_volume(&s, limit, slope);
    for (size_t k = 0; k < count; k++)
        for (int x = 0; x < 3; x++)
            slope[k].gradient[x] *= s.factor;
    return count;
}
