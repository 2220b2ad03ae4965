/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernel.h"

#include "vector.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum {
    ROWS = 4,         /* planes of a corner of the programme */
    MOST_ROUNDS = 500 /* ends what rounding may lead around in a circle */
};

/* The first corner is that of a tetrahedron so many times the size. */
static const double far = 0x1p30;

/* The goal is r + LEAN·x: far below what counts, far above rounding. */
static const double lean[3] = {0x1.6p-40, -0x1.2p-40, 0x1.ap-41};

/* Weights below it are noise of planes that are parallel but for rounding. */
static const double least_pivot = 1e-9;

/* Violations below so many units of rounding are none. */
static const double tolerance = 16;

/* A corner of the linear programme: the ball (x, r) that touches four planes, which hold
 * it together: a weighted sum of their normals, weights ≥ 0, is the lean. */
typedef struct corner {
    double row[ROWS][ROWS]; /* (n, 1) of each plane */
    double d[ROWS];
    double inverse[ROWS][ROWS]; /* of row */
    bool real[ROWS];            /* is a plane of the input */
    double ball[ROWS];          /* x, r */
    double size;                /* of the input: the largest |d| */
} corner;

typedef struct result {
    double center[3];
    double radius;
} result;

/* Between the four faces of a regular tetrahedron around the origin. */
static void start(corner *c)
{
    static const double sign[ROWS][3] = {
        {1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    const double component = sqrt(1.0 / 3), fourth = 0.25;
    for (size_t i = 0; i < ROWS; i++) {
        for (size_t k = 0; k < 3; k++) {
            c->row[i][k] = sign[i][k] * component;
            c->inverse[k][i] = 3 * fourth * c->row[i][k];
        }
        c->row[i][3] = 1;
        c->inverse[3][i] = fourth;
        c->d[i] = far * (c->size > 0 ? c->size : 1);
        c->real[i] = false;
    }
}

static void solve(const corner *c, const double right[ROWS], double out[ROWS])
{
    for (size_t k = 0; k < ROWS; k++)
        out[k] = c->inverse[k][0] * right[0] + c->inverse[k][1] * right[1] +
                 c->inverse[k][2] * right[2] + c->inverse[k][3] * right[3];
}

/* Solved, and once more for what is left: the inverse may be inaccurate. */
static void place_ball(corner *c)
{
    double left[ROWS], more[ROWS];
    solve(c, c->d, c->ball);
    for (size_t i = 0; i < ROWS; i++)
        left[i] = c->d[i] - tm_dot(c->row[i], c->ball) - c->ball[3];
    solve(c, left, more);
    for (size_t k = 0; k < ROWS; k++)
        c->ball[k] += more[k];
}

/* The plane that x is deepest inside of, or outside of least: the nearest one. */
static size_t nearest(const double (*plane)[4], size_t count, const double x[3],
                      double *depth)
{
    size_t at = 0;
    double least = HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        const double left = plane[i][3] - tm_dot(plane[i], x);
        at = left < least ? i : at;
        least = left < least ? left : least;
    }
    *depth = least;
    return at;
}

/* Which of the four gives way: the first whose weight falls to 0 as the new plane, of
 * which they are `part`, takes over. */
static size_t leaving(const corner *c, const double part[ROWS])
{
    size_t out = ROWS;
    double first = HUGE_VAL;
    for (size_t i = 0; i < ROWS; i++) {
        if (part[i] < least_pivot)
            continue;
        const double weight = lean[0] * c->inverse[0][i] + lean[1] * c->inverse[1][i] +
                              lean[2] * c->inverse[2][i] + c->inverse[3][i];
        const double ratio = (weight > 0 ? weight : 0) / part[i];
        if (ratio < first || (ratio == first && out < ROWS && part[i] > part[out])) {
            first = ratio;
            out = i;
        }
    }
    return out;
}

/* Puts a plane in the place of one of the four; false where rounding leaves none. */
static bool pivot(corner *c, const double plane[4])
{
    const double row[ROWS] = {plane[0], plane[1], plane[2], 1};
    double part[ROWS];
    for (size_t i = 0; i < ROWS; i++)
        part[i] = row[0] * c->inverse[0][i] + row[1] * c->inverse[1][i] +
                  row[2] * c->inverse[2][i] + c->inverse[3][i];
    const size_t out = leaving(c, part);
    if (out == ROWS)
        return false;
    for (size_t k = 0; k < ROWS; k++) {
        const double column = c->inverse[k][out] / part[out];
        for (size_t i = 0; i < ROWS; i++)
            c->inverse[k][i] -= part[i] * column;
        c->inverse[k][out] = column;
    }
    memcpy(c->row[out], row, sizeof row);
    c->d[out] = plane[3];
    c->real[out] = true;
    return true;
}

static bool is_real(const corner *c)
{
    return c->real[0] && c->real[1] && c->real[2] && c->real[3];
}

/* Whether all planes are met but for rounding: the ball is the largest. */
static bool is_best(const corner *c, double depth)
{
    const double reach = c->size + fabs(c->ball[0]) + fabs(c->ball[1]) + fabs(c->ball[2]);
    return c->ball[3] - depth <= tolerance * DBL_EPSILON * reach;
}

static double size_of(const double (*plane)[4], size_t count)
{
    double size = 0;
    for (size_t i = 0; i < count; i++)
        size = fabs(plane[i][3]) > size ? fabs(plane[i][3]) : size;
    return size;
}

/* Goes from corner to corner until the ball is the largest, or is one of radius `least`,
 * or there is none of that radius. The best ball that was met is the result. */
static bool find_ball(const double (*plane)[4], size_t count, double least, result *best)
{
    corner c = {.size = size_of(plane, count)};
    *best = (result){.radius = -HUGE_VAL};
    start(&c);
    for (size_t round = 0; round < MOST_ROUNDS; round++) {
        double depth;
        place_ball(&c);
        const size_t cut = nearest(plane, count, c.ball, &depth);
        if (is_real(&c) && depth > best->radius) {
            best->radius = depth;
            memcpy(best->center, c.ball, sizeof best->center);
        }
        if (best->radius >= least || is_best(&c, depth))
            break;
        if (is_real(&c) && c.ball[3] < least && least < HUGE_VAL)
            break;
        if (!pivot(&c, plane[cut]))
            break;
    }
    return is_real(&c) && isfinite(best->radius);
}

static bool write_ball(bool found, const result *best, double center[3], double *radius)
{
    for (size_t k = 0; k < 3; k++)
        center[k] = found ? best->center[k] : 0;
    *radius = found ? best->radius : 0;
    return found;
}

double tm_kernel_depth(const double (*plane)[4], size_t count, const double point[3])
{
    double depth;
    nearest(plane, count, point, &depth);
    return depth;
}

bool tm_kernel_ball(const double (*plane)[4], size_t count, double center[3],
                    double *radius)
{
    result best;
    return write_ball(find_ball(plane, count, HUGE_VAL, &best), &best, center, radius);
}

bool tm_kernel_holds_ball(const double (*plane)[4], size_t count, double least,
                          double center[3], double *radius)
{
    result best;
    const bool found = find_ball(plane, count, least, &best) && best.radius >= least;
    return write_ball(found, &best, center, radius);
}
