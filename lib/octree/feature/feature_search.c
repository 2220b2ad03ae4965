/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "feature_parts.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>

static bool before(tm_path_step a, tm_path_step b)
{
    return a.cost < b.cost || (a.cost == b.cost && a.node < b.node);
}

static tm_status push(tm_path_finder *p, tm_path_step step, tm_error *error)
{
    void *heap = tm_grow(p->heap, &p->heap_room, p->heap_count + 1, sizeof *p->heap);
    if (!heap)
        return tm_fail_memory(error);
    p->heap = heap;
    size_t i = p->heap_count++;
    for (; i > 0 && before(step, p->heap[(i - 1) / 2]); i = (i - 1) / 2)
        p->heap[i] = p->heap[(i - 1) / 2];
    p->heap[i] = step;
    return TM_OK;
}

static tm_path_step pop(tm_path_finder *p)
{
    const tm_path_step top = p->heap[0];
    const tm_path_step last = p->heap[--p->heap_count];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < p->heap_count; i = child) {
        if (child + 1 < p->heap_count && before(p->heap[child + 1], p->heap[child]))
            child++;
        if (!before(p->heap[child], last))
            break;
        p->heap[i] = p->heap[child];
    }
    p->heap[i] = last;
    return top;
}

/* The node's closest point on the curve. */
static tm_path_visit *look_at(tm_path_finder *p, uint32_t s)
{
    tm_path_visit *v = &p->visit[s];
    const uint32_t curve = p->curve;
    if (v->curve_round == curve + 1)
        return v;
    double xyz[3];
    double closest[3];
    size_t segment;
    tm_boundary_node_point(p->boundary, s, xyz);
    tm_surface_closest_on_curve(p->surface, curve, xyz, closest, &segment);
    const uint32_t begin =
        p->surface->curve_node[p->surface->curve_start[curve] + segment];
    v->curve_round = curve + 1;
    v->distance2 = tm_distance2(xyz, closest);
    v->param = p->length[segment] + sqrt(tm_distance2(p->surface->xyz[begin], closest));
    return v;
}

/* The distance of two points along the curve; around it where it is closed. */
static double along_curve(const tm_path_finder *p, double a, double b)
{
    const double d = fabs(a - b);
    return p->closed && d > p->total / 2 ? p->total - d : d;
}

/* Whether a node may be on the path from one stop to the next. */
static bool may_pass(const tm_path_finder *p, const tm_path_visit *v, uint32_t s,
                     const tm_path_stop *from, const tm_path_stop *to)
{
    const double size = p->boundary->size[s];
    if (p->sets && p->sets->node[s] != p->sets->curve[p->curve])
        return false;
    if (p->feature->kind[s] != TM_ON_PATCH ||
        v->distance2 > p->tube * p->tube * size * size)
        return false;
    const double middle = (from->param + to->param) / 2;
    const double half = (to->param - from->param) / 2 + p->tube * size;
    return along_curve(p, v->param, middle) <= half;
}

/* Whether the path may go from one node to the next: only between the curve's regions. */
static bool may_step(const tm_path_finder *p, uint32_t s, uint32_t t)
{
    return !p->sets ||
           tm_region_set_between(p->boundary, s, t) == p->sets->curve[p->curve];
}

/* The neighbours of s: along edges and, of faces that are not cut, diagonals. A
 * quadrilateral's other three corners; each comes up to twice. */
static unsigned face_neighbours(const tm_interior_boundary *boundary, size_t f,
                                uint32_t s, uint32_t to[3])
{
    const unsigned k = tm_boundary_face_corners(boundary, f);
    const uint32_t *face = boundary->face[f];
    const unsigned i = tm_boundary_face_corner(boundary, f, s);
    to[0] = face[(i + 1) % k];
    to[1] = face[(i + k - 1) % k];
    to[2] = face[(i + 2) % k];
    return k == 4 && boundary->cut[f] == TM_UNCUT ? 3 : 2;
}

static tm_status relax(tm_path_finder *p, uint32_t s, uint32_t to, tm_error *error)
{
    const tm_path_visit *a = &p->visit[s];
    tm_path_visit *b = look_at(p, to);
    const double nearness = 0.1; /* edges on the curve are not free */
    double here[3];
    double there[3];
    tm_boundary_node_point(p->boundary, s, here);
    tm_boundary_node_point(p->boundary, to, there);
    const double edge = sqrt(tm_distance2(here, there));
    const double size = fmin(p->boundary->size[s], p->boundary->size[to]);
    const double off = (a->distance2 + b->distance2) / (size * size);
    const double cost =
        a->cost + along_curve(p, a->param, b->param) + edge * (nearness + off);
    if (b->round == p->round && b->cost <= cost)
        return TM_OK;
    b->round = p->round;
    b->cost = cost;
    b->from = s;
    b->done = false;
    return push(p, (tm_path_step){cost, to}, error);
}

tm_status tm_path_search(tm_path_finder *p, const tm_path_stop *from,
                         const tm_path_stop *to, bool *found, tm_error *error)
{
    tm_path_visit *first = look_at(p, from->node);
    p->round++;
    p->heap_count = 0;
    *first = (tm_path_visit){.curve_round = first->curve_round,
                             .round = p->round,
                             .from = TM_NONE,
                             .param = from->param,
                             .distance2 = first->distance2};
    *found = false;
    tm_status status = push(p, (tm_path_step){0, from->node}, error);
    while (status == TM_OK && p->heap_count > 0) {
        const uint32_t s = pop(p).node;
        if (p->visit[s].done)
            continue;
        p->visit[s].done = true;
        if (s == to->node && s != from->node) {
            *found = true;
            break;
        }
        for (size_t i = p->boundary->around_start[s];
             status == TM_OK && i < p->boundary->around_start[s + 1]; i++) {
            uint32_t next[3];
            const unsigned n =
                face_neighbours(p->boundary, p->boundary->around[i], s, next);
            for (unsigned j = 0; status == TM_OK && j < n; j++) {
                const tm_path_visit *v = look_at(p, next[j]);
                if ((next[j] == to->node || may_pass(p, v, next[j], from, to)) &&
                    may_step(p, s, next[j]))
                    status = relax(p, s, next[j], error);
            }
        }
    }
    return status;
}
