/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "wall_sectors.h"
#include "region_sets.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../../mesh/edge_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* In a sharper sector a region is thinner than an octant for too long. */
static const double least_sector = 3.14159265358979323846 / 12;

/* In a sharper one it has fewer octants by its angle than it needs. */
static const double sharp_sector = 3.14159265358979323846 * 80 / 180;

/* A triangle at an edge where walls meet. */
typedef struct {
    uint64_t edge;
    uint32_t triangle, apex;
} wing;

typedef struct {
    const tm_surface *surface;
    size_t count;
    wing *wing; /* sorted by edge */
} wing_list;

static int compare_wings(const void *a, const void *b)
{
    const wing *p = a, *q = b;
    if (p->edge != q->edge)
        return p->edge < q->edge ? -1 : 1;
    return (p->triangle > q->triangle) - (p->triangle < q->triangle);
}

static tm_status list_wings(wing_list *list, tm_error *error)
{
    const tm_surface *s = list->surface;
    list->wing = tm_new(3 * s->triangles, sizeof *list->wing);
    if (!list->wing)
        return tm_fail_memory(error);
    for (uint32_t t = 0; t < s->triangles; t++)
        for (int i = 0; i < 3; i++)
            if (s->across[t][i] == TM_NONE)
                list->wing[list->count++] =
                    (wing){tm_edge_key(s->triangle[t][i], s->triangle[t][(i + 1) % 3]), t,
                           s->triangle[t][(i + 2) % 3]};
    if (list->count > 0)
        qsort(list->wing, list->count, sizeof *list->wing, compare_wings);
    return TM_OK;
}

/* The first wing of an edge. */
static size_t first_wing(const wing_list *list, uint64_t edge)
{
    size_t begin = 0, end = list->count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (list->wing[middle].edge < edge)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin;
}

/* Fills u and v, across a direction of length 1. */
static void make_frame(tm_sector_frame *frame, const double along[3])
{
    int least = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(along[i]) < fabs(along[least]))
            least = i;
    double axis[3] = {0, 0, 0};
    axis[least] = 1;
    tm_cross(frame->u, along, axis);
    const double length = tm_norm(frame->u);
    for (int i = 0; i < 3; i++)
        frame->u[i] /= length;
    tm_cross(frame->v, along, frame->u);
}

/* A wing seen along the segment. */
typedef struct {
    double angle;
    uint32_t before, behind; /* the regions on its sides, as the angle grows */
} ray;

static int compare_rays(const void *a, const void *b)
{
    const ray *p = a, *q = b;
    return (p->angle > q->angle) - (p->angle < q->angle);
}

static ray see(const tm_surface *s, const wing *w, const tm_sector_frame *frame,
               uint32_t from)
{
    const uint32_t *v = s->triangle[w->triangle];
    double out[3], normal[3], turn[3];
    tm_subtract(out, s->xyz[w->apex], s->xyz[from]);
    const double x = tm_dot(out, frame->u), y = tm_dot(out, frame->v);
    tm_triangle_normal(normal, s->xyz[v[0]], s->xyz[v[1]], s->xyz[v[2]]);
    for (int i = 0; i < 3; i++)
        turn[i] = x * frame->v[i] - y * frame->u[i];
    const bool ahead = tm_dot(normal, turn) > 0; /* it looks where angles are larger */
    return (ray){atan2(y, x), s->side[w->triangle][ahead ? 1 : 0],
                 s->side[w->triangle][ahead ? 0 : 1]};
}

/* Fills the frame of a segment and the labels of its sectors, the smallest first; returns
 * how many, or 0. */
static unsigned look_at(const wing_list *list, const uint32_t *node,
                        tm_sector_frame *frame, uint32_t label[TM_SECTORS], bool *sharp)
{
    const tm_surface *s = list->surface;
    const uint64_t edge = tm_edge_key(node[0], node[1]);
    double along[3];
    ray rays[TM_SECTORS];
    unsigned count = 0, first = 0;
    tm_subtract(along, s->xyz[node[1]], s->xyz[node[0]]);
    const double length = tm_norm(along);
    for (int i = 0; i < 3; i++)
        along[i] /= length;
    make_frame(frame, along);
    for (size_t i = first_wing(list, edge); i < list->count && list->wing[i].edge == edge;
         i++) {
        if (count == TM_SECTORS)
            return 0;
        rays[count++] = see(s, &list->wing[i], frame, node[0]);
    }
    if (count < 3)
        return 0;
    qsort(rays, count, sizeof *rays, compare_rays);
    for (unsigned i = 0; i < count; i++) {
        const ray *next = &rays[(i + 1) % count];
        const double wide = next->angle - rays[i].angle + (i + 1 == count ? 2 * pi : 0);
        *sharp |= wide < sharp_sector;
        if (rays[i].behind != next->before || wide < least_sector)
            return 0;
        for (unsigned k = 0; k < i; k++)
            if (rays[k].behind == rays[i].behind)
                return 0;
        if (rays[i].behind < rays[first].behind)
            first = i;
    }
    for (unsigned i = 0; i < count; i++) {
        label[i] = rays[(first + i) % count].behind;
        frame->begin[i] = rays[(first + i) % count].angle;
    }
    return count;
}

static void find_sectors_of(tm_wall_sectors *sectors, const wing_list *list, size_t curve)
{
    const tm_surface *s = list->surface;
    for (size_t i = s->curve_start[curve]; i + 1 < s->curve_start[curve + 1]; i++) {
        uint32_t label[TM_SECTORS] = {0};
        const unsigned count = look_at(list, s->curve_node + i, &sectors->frame[i], label,
                                       &sectors->sharp[curve]);
        if (i == s->curve_start[curve]) {
            sectors->count[curve] = (uint8_t)count;
            memcpy(sectors->label[curve], label, sizeof label);
        } else if (count != sectors->count[curve] ||
                   memcmp(label, sectors->label[curve], sizeof label) != 0) {
            sectors->count[curve] = 0;
        }
        if (sectors->count[curve] == 0)
            return;
    }
}

tm_status tm_wall_sectors_find(tm_wall_sectors *sectors, const tm_surface *surface,
                               tm_error *error)
{
    wing_list list = {.surface = surface};
    const size_t nodes = surface->curve_start[surface->curves];
    *sectors = (tm_wall_sectors){calloc(surface->curves + 1, sizeof *sectors->sharp),
                                 calloc(surface->curves + 1, sizeof *sectors->count),
                                 tm_new(surface->curves, sizeof *sectors->label),
                                 tm_new(nodes, sizeof *sectors->frame)};
    if (!sectors->sharp || !sectors->count || !sectors->label || !sectors->frame)
        return tm_fail_memory(error);
    const tm_status status = list_wings(&list, error);
    for (size_t c = 0; status == TM_OK && c < surface->curves; c++)
        if (tm_curve_is_of_walls(surface, c))
            find_sectors_of(sectors, &list, c);
    free(list.wing);
    return status;
}

tm_status tm_walls_are_sharp(const tm_surface *surface, bool *sharp, tm_error *error)
{
    tm_wall_sectors sectors;
    const tm_status status = tm_wall_sectors_find(&sectors, surface, error);
    *sharp = false;
    for (size_t c = 0; status == TM_OK && c < surface->curves; c++)
        *sharp |= tm_curve_is_of_walls(surface, c) &&
                  (sectors.sharp[c] || sectors.count[c] == 0);
    tm_wall_sectors_free(&sectors);
    return status;
}

void tm_wall_sectors_free(tm_wall_sectors *sectors)
{
    free(sectors->sharp);
    free(sectors->count);
    free(sectors->label);
    free(sectors->frame);
    *sectors = (tm_wall_sectors){0};
}

/* An angle without full turns: 0 … 2 pi. */
static double whole_turn(double angle)
{
    while (angle < 0)
        angle += 2 * pi;
    while (angle >= 2 * pi)
        angle -= 2 * pi;
    return angle;
}

double tm_sector_beside(const tm_sector_frame *frame, unsigned count, unsigned sector,
                        const double direction[3])
{
    const double x = tm_dot(direction, frame->u), y = tm_dot(direction, frame->v);
    const double across = sqrt(x * x + y * y);
    const double begin = frame->begin[sector], end = frame->begin[(sector + 1) % count];
    const double wide = whole_turn(end - begin);
    const double past = whole_turn(atan2(y, x) - begin); /* its beginning */
    return past <= wide ? 0 : across * fmin(past - wide, 2 * pi - past);
}
