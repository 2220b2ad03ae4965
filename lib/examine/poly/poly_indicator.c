/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_parts.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>

/* One facet. */
typedef struct {
    double area;
    double diameter;
    double min_edge;
    double kernel; /* its area, over that of the facet */
} facet;

typedef double point[2];

static double ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

/* Two directions in the plane with a normal of length 1, counter-clockwise around it. */
static void axes_of(const double normal[3], double axis[2][3])
{
    int least = 0;
    for (int k = 1; k < 3; k++)
        least = fabs(normal[k]) < fabs(normal[least]) ? k : least;
    const double along[3] = {least == 0, least == 1, least == 2};
    tm_cross(axis[1], normal, along);
    const double length = tm_norm(axis[1]);
    for (int k = 0; k < 3; k++)
        axis[1][k] /= length;
    tm_cross(axis[0], axis[1], normal);
}

/* Twice the area. */
static double area_of(const point *p, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return sum;
}

/* What of a convex polygon is left of the line from a to b, to `out`; returns how many
 * corners that has, one more at most. */
static size_t clip(const point *p, size_t count, const point a, const point b, point *out)
{
    size_t made = 0;
    for (size_t i = 0; i < count; i++) {
        const double *from = p[i], *to = p[(i + 1) % count];
        const double f =
            (b[0] - a[0]) * (from[1] - a[1]) - (b[1] - a[1]) * (from[0] - a[0]);
        const double t = (b[0] - a[0]) * (to[1] - a[1]) - (b[1] - a[1]) * (to[0] - a[0]);
        if (f >= 0) {
            out[made][0] = from[0];
            out[made++][1] = from[1];
        }
        if ((f < 0) != (t < 0)) {
            for (int k = 0; k < 2; k++)
                out[made][k] = from[k] + f / (f - t) * (to[k] - from[k]);
            made++;
        }
    }
    return made;
}

/* The share of a polygon that sees all of it: the intersection of the half-planes of its
 * edges. `room` is for 2 count + 10 points. */
static double kernel_of(const point *corner, size_t count, double diameter, point *room)
{
    enum { SQUARE = 4 };
    const double area = area_of(corner, count), far = 2 * diameter;
    point *kernel = room, *other = room + count + SQUARE + 1;
    size_t points = SQUARE;
    for (int i = 0; i < SQUARE; i++) {
        kernel[i][0] = corner[0][0] + (i == 1 || i == 2 ? far : -far);
        kernel[i][1] = corner[0][1] + (i >= 2 ? far : -far);
    }
    for (size_t i = 0; i < count && points > 0; i++) {
        points = clip((const point *)kernel, points, corner[i], corner[(i + 1) % count],
                      other);
        point *swap = kernel;
        kernel = other;
        other = swap;
    }
    return fmax(0, fmin(1, ratio(area_of((const point *)kernel, points), area)));
}

static void measure_lengths(facet *made, const tm_poly_shape_memory *m,
                            const uint32_t *corner, size_t count)
{
    double longest2 = 0, shortest2 = HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        const double *from = m->place[corner[i]].x;
        shortest2 =
            fmin(shortest2, tm_distance2(from, m->place[corner[(i + 1) % count]].x));
        for (size_t j = 0; j < i; j++)
            longest2 = fmax(longest2, tm_distance2(from, m->place[corner[j]].x));
    }
    made->diameter = sqrt(longest2);
    made->min_edge = count > 0 ? sqrt(shortest2) : 0;
}

static facet measure(const tm_poly_shape_memory *m, const tm_poly_boundary *b, size_t f)
{
    enum { TRIANGLE = 3 };
    const uint32_t *corner = b->corner + b->face_start[f];
    const size_t count = b->face_start[f + 1] - b->face_start[f];
    point *flat = m->point;
    double axis[2][3];
    facet made = {.kernel = 1};
    measure_lengths(&made, m, corner, count);
    if (!(tm_norm2(m->normal[f]) > 0))
        return made;
    axes_of(m->normal[f], axis);
    for (size_t i = 0; i < count; i++) {
        double from[3];
        tm_subtract(from, m->place[corner[i]].x, m->place[corner[0]].x);
        for (int k = 0; k < 2; k++)
            flat[i][k] = tm_dot(axis[k], from);
    }
    made.area = area_of((const point *)flat, count) / 2;
    if (count > TRIANGLE)
        made.kernel = kernel_of((const point *)flat, count, made.diameter, flat + count);
    return made;
}

/* Room for the polygons of the largest facet. */
static bool reserve(tm_poly_shape_memory *m, const tm_poly_boundary *b)
{
    enum { ROOM = 10 };
    size_t most = 0;
    for (size_t f = 0; f < b->faces; f++) {
        const size_t count = b->face_start[f + 1] - b->face_start[f];
        most = count > most ? count : most;
    }
    void *moved = tm_grow(m->point, &m->point_room, 3 * most + ROOM, sizeof *m->point);
    m->point = moved ? moved : m->point;
    return moved != NULL;
}

bool tm_poly_indicator(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                       const tm_poly_boundary *b)
{
    const double triangle = 3, tetrahedron = 4, faces = (double)b->faces;
    const double size = cbrt(fmax(0, shape->volume));
    double kernels = shape->kernel_ratio, sizes = 0, counts = 0, smallest = HUGE_VAL;
    if (!reserve(memory, b))
        return false;
    for (size_t f = 0; f < b->faces; f++) {
        const facet at = measure(memory, b, f);
        const double side = sqrt(fmax(0, at.area));
        kernels *= at.kernel;
        sizes += ratio(fmin(side, at.min_edge), fmax(side, at.diameter)) / faces;
        counts += triangle / (double)(b->face_start[f + 1] - b->face_start[f]) / faces;
        smallest = fmin(smallest, at.diameter);
    }
    const double whole = ratio(fmin(size, smallest), fmax(size, shape->diameter));
    shape->rho[0] = kernels;
    shape->rho[1] = (whole + sizes) / 2;
    shape->rho[2] = b->faces > 0 ? (tetrahedron / faces + counts) / 2 : 0;
    return true;
}
