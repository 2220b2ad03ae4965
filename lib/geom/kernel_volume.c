/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernel_volume.h"

#include "../base/array.h"
#include "vector.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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

static void start(face *f, double reach)
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
        start(&f, reach);
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
