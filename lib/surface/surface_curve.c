/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closest place of a curve. The segments first … last - 1 of a curve have a box, and
 * so have both halves, down to a few segments; the box is at the index of the segment in
 * the middle, which no other range has for its middle. */
#include "surface_tree.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <math.h>
#include <string.h>

enum { FEW = 4 };

static void build_range(const tm_surface *surface, size_t first, size_t last)
{
    double *box = surface->tree->curve_box[first + (last - first) / 2];
    for (int i = 0; i < 3; i++) {
        box[i] = HUGE_VAL;
        box[3 + i] = -HUGE_VAL;
    }
    for (size_t s = first; s <= last; s++) {
        const double *p = surface->xyz[surface->curve_node[s]];
        for (int i = 0; i < 3; i++) {
            box[i] = fmin(box[i], p[i]);
            box[3 + i] = fmax(box[3 + i], p[i]);
        }
    }
    if (last - first <= FEW)
        return;
    size_t middle = first + (last - first) / 2;
    build_range(surface, first, middle);
    build_range(surface, middle, last);
}

tm_status tm_surface_curve_build(tm_surface *surface, tm_error *error)
{
    tm_surface_tree *tree = surface->tree;
    tree->curve_box =
        tm_new(surface->curve_start[surface->curves], sizeof *tree->curve_box);
    if (!tree->curve_box)
        return tm_fail_memory(error);
    for (size_t c = 0; c < surface->curves; c++)
        build_range(surface, surface->curve_start[c], surface->curve_start[c + 1] - 1);
    return TM_OK;
}

typedef struct search {
    const tm_surface *surface;
    const double *point;
    double *closest;
    size_t segment;
    double distance2;
} search;

static double box_distance2(const double box[6], const double p[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double d = fmax(fmax(box[i] - p[i], p[i] - box[3 + i]), 0);
        sum += d * d;
    }
    return sum;
}

static void measure(search *s, size_t segment)
{
    const double *a = s->surface->xyz[s->surface->curve_node[segment]];
    const double *b = s->surface->xyz[s->surface->curve_node[segment + 1]];
    double ab[3], ap[3], q[3];
    tm_subtract(ab, b, a);
    tm_subtract(ap, s->point, a);
    double along = tm_dot(ap, ab) / tm_norm2(ab);
    for (int i = 0; i < 3; i++)
        q[i] = along >= 1 ? b[i] : along > 0 ? a[i] + along * ab[i] : a[i];
    double distance2 = tm_distance2(s->point, q);
    if (distance2 < s->distance2) {
        s->distance2 = distance2;
        s->segment = segment;
        memcpy(s->closest, q, sizeof q);
    }
}

static void search_range(search *s, size_t first, size_t last)
{
    if (last - first <= FEW) {
        for (size_t segment = first; segment < last; segment++)
            measure(s, segment);
        return;
    }
    const double(*box)[6] = (const double(*)[6])s->surface->tree->curve_box;
    size_t middle = first + (last - first) / 2;
    double left = box_distance2(box[first + (middle - first) / 2], s->point);
    double right = box_distance2(box[middle + (last - middle) / 2], s->point);
    if (left <= right && left < s->distance2)
        search_range(s, first, middle);
    if (right < s->distance2)
        search_range(s, middle, last);
    if (left > right && left < s->distance2)
        search_range(s, first, middle);
}

void tm_surface_closest_on_curve(const tm_surface *surface, uint32_t curve,
                                 const double point[3], double closest[3],
                                 size_t *segment)
{
    size_t first = surface->curve_start[curve];
    search s = {surface, point, closest, first, HUGE_VAL};
    search_range(&s, first, surface->curve_start[curve + 1] - 1);
    *segment = s.segment - first;
}
