/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernel.h"

#include "../base/array.h"
#include "vector.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
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
static void set_ball(corner *c)
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

/* How far from the origin planes and ball are. */
static double reach_of(const corner *c)
{
    return c->size + fabs(c->ball[0]) + fabs(c->ball[1]) + fabs(c->ball[2]);
}

/* Whether all planes are met but for rounding: the ball is the largest. */
static bool is_best(const corner *c, double depth)
{
    return c->ball[3] - depth <= tolerance * DBL_EPSILON * reach_of(c);
}

/* Whether no ball can have the radius: from corner to corner that only becomes less, but
 * for the lean and rounding. */
static bool is_below(const corner *c, double least)
{
    const double margin = 1e-9;
    return c->ball[3] + margin * reach_of(c) < least;
}

static double size_of(const double (*plane)[4], size_t count)
{
    double size = 0;
    for (size_t i = 0; i < count; i++)
        size = fabs(plane[i][3]) > size ? fabs(plane[i][3]) : size;
    return size;
}

/* Goes from corner to corner until the ball is the largest, or known to be less than
 * `least`. The best ball that was met is the result. */
static bool find_ball(const double (*plane)[4], size_t count, double least, result *best)
{
    corner c = {.size = size_of(plane, count)};
    *best = (result){.radius = -HUGE_VAL};
    start(&c);
    for (size_t round = 0; round < MOST_ROUNDS; round++) {
        double depth;
        set_ball(&c);
        if (is_below(&c, least))
            return false;
        const size_t cut = nearest(plane, count, c.ball, &depth);
        if (is_real(&c) && depth > best->radius) {
            best->radius = depth;
            memcpy(best->center, c.ball, sizeof best->center);
        }
        if (is_best(&c, depth) || !pivot(&c, plane[cut]))
            break;
    }
    return is_real(&c) && isfinite(best->radius);
}

bool tm_kernel_ball(const double (*plane)[4], size_t count, double center[3],
                    double *radius)
{
    return tm_kernel_ball_of(plane, count, -HUGE_VAL, center, radius);
}

bool tm_kernel_ball_of(const double (*plane)[4], size_t count, double least,
                       double center[3], double *radius)
{
    result best;
    const bool found = find_ball(plane, count, least, &best);
    for (size_t k = 0; k < 3; k++)
        center[k] = found ? best.center[k] : 0;
    *radius = found ? best.radius : 0;
    return found;
}

/* A plane at a distance from the inner point. */
typedef struct tm_kernel_plane {
    double normal[3];
    double distance;
    size_t index;
} tm_kernel_plane;

/* A face in coordinates of its plane, around the foot of the inner point. */
typedef struct face {
    const tm_kernel_plane *plane;
    double u[3];
    double w[3];
    double (*point)[2];
    double (*spare)[2];
    size_t points;
    double radius2; /* the distance of its farthest point from the foot, squared, */
    double reach2;  /* and from the inner point */
} face;

/* Unit normals that differ by less are parallel. */
static const double parallel = 1e-14;

enum { SQUARE = 4 };

void tm_kernel_memory_free(tm_kernel_memory *memory)
{
    free(memory->plane);
    free(memory->polygon);
    *memory = (tm_kernel_memory){0};
}

static bool allocate(tm_kernel_memory *m, size_t count)
{
    void *planes = tm_grow(m->plane, &m->planes, count + 1, sizeof *m->plane);
    m->plane = planes ? planes : m->plane;
    void *points =
        tm_grow(m->polygon, &m->points, 2 * (count + SQUARE), sizeof *m->polygon);
    m->polygon = points ? points : m->polygon;
    return planes && points;
}

static bool comes_before(const tm_kernel_plane *p, const tm_kernel_plane *q)
{
    return p->distance < q->distance ||
           (p->distance == q->distance && p->index < q->index);
}

static int compare(const void *a, const void *b)
{
    return comes_before(a, b) ? -1 : 1;
}

/* Insertion sort is the fastest for few. */
static void sort(tm_kernel_plane *plane, size_t count)
{
    enum { FEW = 48 };
    if (count > FEW) {
        qsort(plane, count, sizeof *plane, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const tm_kernel_plane p = plane[i];
        size_t j = i;
        for (; j > 0 && comes_before(&p, &plane[j - 1]); j--)
            plane[j] = plane[j - 1];
        plane[j] = p;
    }
}

/* Two unit vectors in the plane at right angles. */
static void choose_axes(face *f)
{
    const double *n = f->plane->normal;
    double axis[3] = {0};
    axis[fabs(n[0]) < 0.5 ? 0 : fabs(n[1]) < 0.5 ? 1 : 2] = 1;
    tm_cross(f->u, n, axis);
    const double length = tm_norm(f->u);
    for (size_t k = 0; k < 3; k++)
        f->u[k] /= length;
    tm_cross(f->w, n, f->u);
}

static void find_reach(face *f)
{
    double farthest = 0;
    for (size_t i = 0; i < f->points; i++)
        farthest = fmax(farthest, f->point[i][0] * f->point[i][0] +
                                      f->point[i][1] * f->point[i][1]);
    f->radius2 = farthest;
    f->reach2 = farthest + f->plane->distance * f->plane->distance;
}

static void begin_face(face *f, double reach)
{
    static const double sign[SQUARE][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    choose_axes(f);
    f->points = SQUARE;
    for (size_t i = 0; i < SQUARE; i++)
        for (size_t k = 0; k < 2; k++)
            f->point[i][k] = sign[i][k] * reach;
    find_reach(f);
}

/* Keeps where a·x + b·y ≤ c. A line crosses a convex polygon twice, whatever rounding
 * says, so that no cut adds more than one point. */
static void clip(face *f, double a, double b, double c)
{
    size_t kept = 0, crossings = 0;
    for (size_t i = 0; i < f->points; i++) {
        const double *p = f->point[i], *q = f->point[i + 1 < f->points ? i + 1 : 0];
        const double at_p = a * p[0] + b * p[1] - c, at_q = a * q[0] + b * q[1] - c;
        if (at_p <= 0)
            memcpy(f->spare[kept++], p, sizeof f->spare[0]);
        if (((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) && crossings < 2) {
            crossings++;
            const double s = at_p / (at_p - at_q);
            f->spare[kept][0] = p[0] + s * (q[0] - p[0]);
            f->spare[kept++][1] = p[1] + s * (q[1] - p[1]);
        }
    }
    double(*cut)[2] = f->spare;
    f->spare = f->point;
    f->point = cut;
    f->points = kept;
    find_reach(f);
}

/* Of parallel planes the nearest, which comes first, has the face. Most other lines pass
 * by it. */
static void cut(face *f, const tm_kernel_plane *other, bool is_nearer)
{
    const double a = tm_dot(other->normal, f->u), b = tm_dot(other->normal, f->w);
    const double along = tm_dot(other->normal, f->plane->normal);
    const double c = other->distance - f->plane->distance * along;
    if (fabs(a) + fabs(b) <= parallel)
        f->points = along > 0 && is_nearer ? 0 : f->points;
    else if (c < 0 || c * c < f->radius2 * (a * a + b * b))
        clip(f, a, b, c);
}

static double area(const face *f)
{
    double twice = 0;
    for (size_t i = 1; i + 1 < f->points; i++) {
        const double *p = f->point[0], *q = f->point[i], *r = f->point[i + 1];
        twice += (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    }
    return twice / 2;
}

static void list_planes(tm_kernel_memory *m, const double (*plane)[4], size_t count,
                        const double inner[3])
{
    for (size_t i = 0; i < count; i++) {
        tm_kernel_plane *p = &m->plane[i];
        memcpy(p->normal, plane[i], sizeof p->normal);
        p->distance = plane[i][3] - tm_dot(plane[i], inner);
        p->index = i;
    }
    sort(m->plane, count);
}

void *tm_kernel_volume(tm_kernel_memory *m, const double (*plane)[4], size_t count,
                       const double inner[3], double reach, double *volume)
{
    *volume = 0;
    if (!allocate(m, count))
        return NULL;
    list_planes(m, plane, count, inner);
    for (size_t i = 0; i < count; i++) {
        face f = {.plane = &m->plane[i],
                  .point = m->polygon,
                  .spare = m->polygon + count + SQUARE};
        begin_face(&f, reach);
        for (size_t j = 0; j < count && f.points > 0; j++) {
            const double distance = m->plane[j].distance;
            if (distance > 0 && distance * distance >= f.reach2)
                break;
            if (j != i)
                cut(&f, &m->plane[j], j < i);
        }
        *volume += area(&f) * f.plane->distance / 3;
    }
    return m->plane;
}
