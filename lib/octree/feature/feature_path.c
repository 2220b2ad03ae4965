/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "feature_parts.h"

#include "../../base/array.h"
#include "../../geom/vector.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static tm_status append(tm_path_finder *p, uint32_t s, tm_error *error)
{
    void *path = tm_grow(p->path, &p->path_room, p->path_count + 1, sizeof *p->path);
    if (!path)
        return tm_fail_memory(error);
    p->path = path;
    p->path[p->path_count++] = s;
    return TM_OK;
}

/* A face that has both nodes; the next one after `last`, which is TM_NONE at first. */
static uint32_t common_face(const tm_interior_boundary *boundary, uint32_t s, uint32_t t,
                            uint32_t last)
{
    bool past = last == TM_NONE;
    for (size_t i = boundary->around_start[s]; i < boundary->around_start[s + 1]; i++) {
        const uint32_t f = boundary->around[i];
        if (!past) {
            past = f == last;
            continue;
        }
        for (unsigned c = 0; c < tm_boundary_face_corners(boundary, f); c++)
            if (boundary->face[f][c] == t)
                return f;
    }
    return TM_NONE;
}

/* Whether two nodes of a face are not neighbours on its border. */
static bool is_diagonal(const tm_interior_boundary *boundary, size_t f, uint32_t s,
                        uint32_t t)
{
    return tm_boundary_face_corners(boundary, f) == 4 &&
           (tm_boundary_face_corner(boundary, f, s) + 2) % 4 ==
               tm_boundary_face_corner(boundary, f, t);
}

/* Whether the path can go from s to t at once, where both are in a face with what is now
 * between them. */
static bool can_cut_short(const tm_interior_boundary *boundary, uint32_t s,
                          uint32_t between, uint32_t t)
{
    for (uint32_t f = common_face(boundary, s, t, TM_NONE); f != TM_NONE;
         f = common_face(boundary, s, t, f)) {
        bool has = false;
        for (unsigned c = 0; c < tm_boundary_face_corners(boundary, f); c++)
            has |= boundary->face[f][c] == between;
        if (has && (!is_diagonal(boundary, f, s, t) || boundary->cut[f] == TM_UNCUT))
            return true;
    }
    return false;
}

static void put_on_curve(tm_path_finder *p, uint32_t s)
{
    if (p->feature->kind[s] != TM_ON_PATCH)
        return;
    p->feature->kind[s] = TM_ON_CURVE;
    p->feature->of[s] = p->curve;
}

static void take_off_curve(tm_path_finder *p, uint32_t s)
{
    if (p->feature->kind[s] == TM_ON_CURVE && p->feature->of[s] == p->curve)
        p->feature->kind[s] = TM_ON_PATCH;
}

/* Appends the nodes after the first stop up to the second, and takes them. Two edges of
 * one face would be flattened to a straight angle, so their third side is taken; not
 * where walls meet, which is along the edges. */
static tm_status take(tm_path_finder *p, const tm_path_stop *from, const tm_path_stop *to,
                      tm_error *error)
{
    const size_t begin = p->path_count;
    tm_status status = TM_OK;
    for (uint32_t s = to->node; status == TM_OK && s != from->node; s = p->visit[s].from)
        status = append(p, s, error);
    if (status != TM_OK)
        return status;
    for (size_t i = begin, j = p->path_count; i + 1 < j; i++) {
        const uint32_t s = p->path[i];
        p->path[i] = p->path[--j];
        p->path[j] = s;
    }
    size_t kept = begin;
    for (size_t i = begin; i < p->path_count; i++) {
        const uint32_t previous = kept > begin ? p->path[kept - 1] : from->node;
        if (i + 1 < p->path_count && !tm_curve_is_of_walls(p->surface, p->curve) &&
            can_cut_short(p->boundary, previous, p->path[i], p->path[i + 1]))
            continue;
        p->path[kept++] = p->path[i];
    }
    p->path_count = kept;
    for (size_t i = begin; i < kept; i++)
        put_on_curve(p, p->path[i]);
    return TM_OK;
}

/* Cuts the quadrilaterals whose diagonals the new part of the path takes. */
static tm_status cut_faces(tm_path_finder *p, size_t begin, tm_error *error)
{
    for (size_t i = begin; i < p->path_count; i++) {
        const uint32_t s = p->path[i - 1], t = p->path[i];
        const uint32_t f = common_face(p->boundary, s, t, TM_NONE);
        if (f == TM_NONE || !is_diagonal(p->boundary, f, s, t) ||
            common_face(p->boundary, s, t, f) != TM_NONE)
            continue;
        void *cuts = tm_grow(p->cuts, &p->cut_room, p->cut_count + 1, sizeof *p->cuts);
        if (!cuts)
            return tm_fail_memory(error);
        p->cuts = cuts;
        p->cuts[p->cut_count++] = f;
        p->boundary->cut[f] =
            tm_boundary_face_corner(p->boundary, f, s) % 2 ? TM_CUT_13 : TM_CUT_02;
    }
    return TM_OK;
}

/* Gives back what a path that did not get through has taken. */
static void release(tm_path_finder *p)
{
    for (size_t i = 0; i < p->path_count; i++)
        take_off_curve(p, p->path[i]);
    for (unsigned i = 0; i < p->stops; i++)
        take_off_curve(p, p->stop[i].node);
    for (size_t i = 0; i < p->cut_count; i++)
        p->boundary->cut[p->cuts[i]] = TM_UNCUT;
}

static void mark_edge(tm_path_finder *p, uint32_t s, uint32_t t)
{
    for (uint32_t f = common_face(p->boundary, s, t, TM_NONE); f != TM_NONE;
         f = common_face(p->boundary, s, t, f)) {
        const unsigned k = tm_boundary_face_corners(p->boundary, f);
        const unsigned i = tm_boundary_face_corner(p->boundary, f, s),
                       j = tm_boundary_face_corner(p->boundary, f, t);
        if ((i + 1) % k == j)
            p->on_path[f] |= (uint8_t)(1u << i);
        else if ((j + 1) % k == i)
            p->on_path[f] |= (uint8_t)(1u << j);
    }
}

static void enter(tm_path_finder *p)
{
    for (size_t i = 1; i < p->path_count; i++)
        mark_edge(p, p->path[i - 1], p->path[i]);
    for (size_t i = 0; i < p->path_count; i++) {
        const uint32_t s = p->path[i];
        const bool around = p->path[0] == p->path[p->path_count - 1];
        if (p->feature->kind[s] != TM_ON_CURVE || (i == 0 && !around))
            continue;
        p->feature->along[s][0] = i > 0 ? p->path[i - 1] : p->path[p->path_count - 2];
        p->feature->along[s][1] = i + 1 < p->path_count ? p->path[i + 1] : p->path[1];
    }
}

static tm_status measure(tm_path_finder *p, tm_error *error)
{
    const tm_surface *surface = p->surface;
    const size_t begin = surface->curve_start[p->curve];
    const size_t count = surface->curve_start[p->curve + 1] - begin;
    void *room = tm_grow(p->length, &p->length_room, count, sizeof *p->length);
    if (!room)
        return tm_fail_memory(error);
    p->length = room;
    p->length[0] = 0;
    for (size_t i = 1; i < count; i++)
        p->length[i] = p->length[i - 1] +
                       sqrt(tm_distance2(surface->xyz[surface->curve_node[begin + i - 1]],
                                         surface->xyz[surface->curve_node[begin + i]]));
    p->total = p->length[count - 1];
    return TM_OK;
}

/* The point of the curve at a length along it. */
static void point_on_curve(const tm_path_finder *p, double param, double xyz[3])
{
    const uint32_t *node = p->surface->curve_node + p->surface->curve_start[p->curve];
    size_t i = 0;
    const size_t last =
        p->surface->curve_start[p->curve + 1] - p->surface->curve_start[p->curve] - 2;
    while (i < last && p->length[i + 1] < param)
        i++;
    const double *a = p->surface->xyz[node[i]];
    const double *b = p->surface->xyz[node[i + 1]];
    const double t = (param - p->length[i]) / (p->length[i + 1] - p->length[i]);
    for (int j = 0; j < 3; j++)
        xyz[j] = a[j] + t * (b[j] - a[j]);
}

/* The free node closest to a point of the curve; TM_NONE where it is out of reach. */
static uint32_t node_near(const tm_path_finder *p, double param)
{
    double point[3];
    point_on_curve(p, param, point);
    double distance2;
    tm_boundary_filter filter = {.taken = p->feature->kind};
    if (p->sets) {
        filter.set = p->sets->node;
        filter.which = p->sets->curve[p->curve];
    }
    const uint32_t s = tm_boundary_cells_nearest(p->cells, point, filter, &distance2);
    const double reach = s == TM_NONE ? 0 : p->tube * p->boundary->size[s];
    return distance2 <= reach * reach ? s : TM_NONE;
}

/* Where the path must pass: its ends, and two or three points more where it comes back to
 * where it began. False where a node is missing. */
static bool find_stops(tm_path_finder *p, uint32_t from, uint32_t to)
{
    enum { THIRDS = TM_PATH_STOPS - 1 };
    p->closed = from == to;
    p->stops = 0;
    if (!p->closed) {
        p->stop[p->stops++] = (tm_path_stop){from, 0};
        p->stop[p->stops++] = (tm_path_stop){to, p->total};
        return true;
    }
    for (unsigned i = 0; i < THIRDS; i++) {
        const double param = p->total * i / THIRDS;
        const uint32_t s = i == 0 && from != TM_NONE ? from : node_near(p, param);
        if (s == TM_NONE)
            return false;
        put_on_curve(p, s);
        p->stop[p->stops++] = (tm_path_stop){s, param};
    }
    p->stop[p->stops++] = (tm_path_stop){p->stop[0].node, p->total};
    return true;
}

static tm_status find_path(tm_path_finder *p, bool *found, tm_error *error)
{
    tm_status status = append(p, p->stop[0].node, error);
    for (unsigned i = 1; status == TM_OK && i < p->stops; i++) {
        const size_t begin = p->path_count;
        status = tm_path_search(p, &p->stop[i - 1], &p->stop[i], found, error);
        if (status != TM_OK || !*found)
            return status;
        status = take(p, &p->stop[i - 1], &p->stop[i], error);
        if (status == TM_OK)
            status = cut_faces(p, begin, error);
    }
    return status;
}

tm_status tm_path_along_curve(tm_path_finder *finder, uint32_t curve, uint32_t from,
                              uint32_t to, bool *found, tm_error *error)
{
    tm_path_finder *p = finder;
    *found = false;
    p->curve = curve;
    tm_status status = measure(p, error);
    for (int wide = 0; status == TM_OK && wide < 2 && !*found; wide++) {
        p->tube = wide ? tm_path_wide_tube : tm_path_tube;
        p->path_count = p->cut_count = 0;
        if (find_stops(p, from, to))
            status = find_path(p, found, error);
        if (status == TM_OK && *found)
            enter(p);
        else
            release(p);
    }
    return status;
}
