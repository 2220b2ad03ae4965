/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_parts.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double full_turn = 360; /* degrees */

enum { PLACE, NORMAL, PLANE };

void tm_poly_shape_memory_free(tm_poly_shape_memory *m)
{
    free(m->place);
    free(m->normal);
    free(m->plane);
    free(m->point);
    tm_kernel_memory_free(&m->kernel);
    *m = (tm_poly_shape_memory){0};
}

static bool allocate(tm_poly_shape_memory *m, size_t nodes, size_t faces)
{
    void *places = tm_grow(m->place, &m->room[PLACE], 2 * nodes + 1, sizeof *m->place);
    m->place = places ? places : m->place;
    void *normals = tm_grow(m->normal, &m->room[NORMAL], faces + 1, sizeof *m->normal);
    m->normal = normals ? normals : m->normal;
    void *planes = tm_grow(m->plane, &m->room[PLANE], faces + 1, sizeof *m->plane);
    m->plane = planes ? planes : m->plane;
    return places && normals && planes;
}

static void place_nodes(tm_poly_shape_memory *m, const tm_poly_boundary *b,
                        const double (*xyz)[3])
{
    double mean[3] = {0};
    for (size_t v = 0; v < b->nodes; v++) {
        tm_subtract(m->place[v].x, xyz[b->node[v]], xyz[b->node[0]]);
        for (size_t k = 0; k < 3; k++)
            mean[k] += m->place[v].x[k] / (double)b->nodes;
    }
    for (size_t v = 0; v < b->nodes; v++)
        m->place[v].distance = sqrt(tm_distance2(m->place[v].x, mean));
}

static int compare(const void *a, const void *b)
{
    const tm_poly_point *p = a, *q = b;
    return (p->distance < q->distance) - (p->distance > q->distance);
}

/* The largest distance of two nodes. With the farthest from the mean first, most pairs
 * are known to be closer without a look. */
static double diameter(tm_poly_shape_memory *m, size_t nodes)
{
    tm_poly_point *place = m->place + nodes;
    double largest2 = 0, largest = 0;
    memcpy(place, m->place, nodes * sizeof *place);
    qsort(place, nodes, sizeof *place, compare);
    for (size_t i = 0; i < nodes && 2 * place[i].distance > largest; i++)
        for (size_t j = i + 1;
             j < nodes && place[i].distance + place[j].distance > largest; j++) {
            const double distance2 = tm_distance2(place[i].x, place[j].x);
            if (distance2 > largest2) {
                largest2 = distance2;
                largest = sqrt(distance2);
            }
        }
    return largest;
}

static double min_edge(const tm_poly_shape_memory *m, const tm_poly_boundary *b)
{
    double shortest2 = HUGE_VAL;
    for (size_t e = 0; e < b->edges; e++) {
        const uint32_t *end = b->edge[e].end;
        shortest2 = fmin(shortest2, tm_distance2(m->place[end[0]].x, m->place[end[1]].x));
    }
    return b->edges > 0 ? sqrt(shortest2) : 0;
}

/* The vector area of a face, around its first corner. */
static void area_of(const tm_poly_shape_memory *m, const tm_poly_boundary *b, size_t f,
                    double area[3])
{
    const uint32_t *corner = b->corner + b->face_start[f];
    const size_t count = b->face_start[f + 1] - b->face_start[f];
    memset(area, 0, 3 * sizeof *area);
    for (size_t i = 1; i + 1 < count; i++) {
        double normal[3];
        tm_triangle_normal(normal, m->place[corner[0]].x, m->place[corner[i]].x,
                           m->place[corner[i + 1]].x);
        for (size_t k = 0; k < 3; k++)
            area[k] += normal[k] / 2;
    }
}

/* How far out the innermost node of a face is along its normal. */
static double innermost(const tm_poly_shape_memory *m, const tm_poly_boundary *b,
                        size_t f)
{
    double least = HUGE_VAL;
    for (size_t i = b->face_start[f]; i < b->face_start[f + 1]; i++)
        least = fmin(least, tm_dot(m->normal[f], m->place[b->corner[i]].x));
    return least;
}

/* Normals and planes; returns how many planes there are. */
static size_t find_planes(tm_poly_shape *s, tm_poly_shape_memory *m,
                          const tm_poly_boundary *b)
{
    size_t planes = 0;
    s->min_face_area = b->faces > 0 ? HUGE_VAL : 0;
    for (size_t f = 0; f < b->faces; f++) {
        area_of(m, b, f, m->normal[f]);
        const double area = tm_norm(m->normal[f]);
        s->min_face_area = fmin(s->min_face_area, area);
        for (size_t k = 0; k < 3; k++)
            m->normal[f][k] = area > 0 ? m->normal[f][k] / area : 0;
        if (!(area > 0))
            continue;
        memcpy(m->plane[planes], m->normal[f], sizeof m->normal[f]);
        m->plane[planes++][3] = innermost(m, b, f);
    }
    return planes;
}

/* Inside, between the two faces of an edge; below 0 where that cannot be said. */
static double dihedral(const tm_poly_shape_memory *m, const tm_poly_boundary *b,
                       const tm_poly_edge *e)
{
    const double degrees = full_turn / 2 / acos(-1);
    if (!tm_poly_edge_is_good(e))
        return -1;
    const double *n = m->normal[b->face[e->corner[0]]];
    const double *p = m->normal[b->face[e->corner[1]]];
    double along[3], cross[3];
    tm_subtract(along, m->place[e->end[1]].x, m->place[e->end[0]].x);
    tm_cross(cross, n, p);
    const double length = tm_norm(along);
    if (!(length > 0) || !(tm_norm2(n) > 0) || !(tm_norm2(p) > 0))
        return -1;
    return full_turn / 2 - degrees * atan2(tm_dot(along, cross) / length, tm_dot(n, p));
}

static void find_dihedrals(tm_poly_shape *s, const tm_poly_shape_memory *m,
                           const tm_poly_boundary *b)
{
    s->min_dihedral = full_turn;
    s->max_dihedral = 0;
    for (size_t e = 0; e < b->edges; e++) {
        const double angle = dihedral(m, b, &b->edge[e]);
        if (angle < 0)
            continue;
        s->min_dihedral = fmin(s->min_dihedral, angle);
        s->max_dihedral = fmax(s->max_dihedral, angle);
    }
}

/* The largest ball in the kernel, around center. */
static void find_ball(tm_poly_shape *s, const tm_poly_shape_memory *m, double center[3])
{
    const double(*plane)[4] = (const double(*)[4])m->plane;
    double radius;
    s->star_shaped = tm_kernel_ball(plane, m->planes, center, &radius) &&
                     radius > TM_POLY_STAR * s->diameter;
    s->kernel_radius = s->star_shaped ? radius / s->diameter : 0;
}

/* The centroid, by the tetrahedra of the first node and the triangles around each face's
 * first corner; the mean of the nodes where there is no volume. */
static void find_centroid(const tm_poly_shape *s, const tm_poly_shape_memory *m,
                          const tm_poly_boundary *b, double centroid[3])
{
    const double nodes_by_determinant = 24;
    double moment[3] = {0}, mean[3] = {0};
    for (size_t v = 0; v < b->nodes; v++)
        for (int k = 0; k < 3; k++)
            mean[k] += m->place[v].x[k] / (double)b->nodes;
    for (size_t f = 0; f < b->faces; f++) {
        const uint32_t *corner = b->corner + b->face_start[f];
        for (size_t i = 2; i < b->face_start[f + 1] - b->face_start[f]; i++) {
            const double *x = m->place[corner[0]].x, *y = m->place[corner[i - 1]].x;
            const double *z = m->place[corner[i]].x;
            double cross[3];
            tm_cross(cross, x, y);
            const double determinant = tm_dot(cross, z);
            for (int k = 0; k < 3; k++)
                moment[k] += determinant * (x[k] + y[k] + z[k]);
        }
    }
    for (int k = 0; k < 3; k++)
        centroid[k] =
            s->volume > 0 ? moment[k] / nodes_by_determinant / s->volume : mean[k];
}

static void find_centroid_depth(tm_poly_shape *s, const tm_poly_shape_memory *m,
                                const tm_poly_boundary *b)
{
    double centroid[3], least = HUGE_VAL;
    find_centroid(s, m, b, centroid);
    for (size_t i = 0; i < m->planes; i++)
        least = fmin(least, m->plane[i][3] - tm_dot(m->plane[i], centroid));
    s->centroid_depth = m->planes > 0 && s->diameter > 0 ? least / s->diameter : 0;
}

/* False where memory is out. */
static bool find_kernel_ratio(tm_poly_shape *s, tm_poly_shape_memory *m,
                              const double center[3])
{
    const double(*plane)[4] = (const double(*)[4])m->plane;
    const double beyond = 1 + 1e-9;
    double volume;
    s->kernel_ratio = 0;
    if (!s->star_shaped)
        return true;
    if (!tm_kernel_volume(&m->kernel, plane, m->planes, center, beyond * s->diameter,
                          &volume))
        return false;
    if (s->volume > 0 && volume > 0)
        s->kernel_ratio = volume < s->volume ? volume / s->volume : 1;
    return true;
}

tm_status tm_poly_ball_measure(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                               const tm_poly_boundary *b, const double (*xyz)[3],
                               double center[3], tm_error *error)
{
    double uncertain;
    if (!allocate(memory, b->nodes, b->faces))
        return tm_fail_memory(error);
    place_nodes(memory, b, xyz);
    shape->volume = tm_poly_volume(b, xyz, &uncertain);
    shape->diameter = diameter(memory, b->nodes);
    memory->planes = find_planes(shape, memory, b);
    find_ball(shape, memory, center);
    return TM_OK;
}

tm_status tm_poly_shape_measure(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                                const tm_poly_boundary *b, const double (*xyz)[3],
                                tm_error *error)
{
    double center[3];
    const tm_status status = tm_poly_ball_measure(shape, memory, b, xyz, center, error);
    if (status != TM_OK)
        return status;
    shape->min_edge = min_edge(memory, b);
    find_dihedrals(shape, memory, b);
    find_centroid_depth(shape, memory, b);
    return find_kernel_ratio(shape, memory, center) && tm_poly_indicator(shape, memory, b)
               ? TM_OK
               : tm_fail_memory(error);
}
