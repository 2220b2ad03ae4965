/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_distance.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../../stream/coordinates.h"
#include "../surface_parts.h"
#include "surface_sharp.h"
#include "../surface_tree.h"

#include <stdlib.h>
#include <string.h>

/* Of the diagonal: how near to the truth a distance is, and what is on a plane. */
static const double accuracy = 1e-6;
static const double on_plane = 1e-12;

enum {
    CORNERS_MOST = 12,       /* of a piece */
    HALVE_EVERY = 4,         /* so that pieces do become small: each such cut is a half */
    PIECES_PER_TRIANGLE = 20 /* that are cut, at most, and so many more in all: */
};
static const size_t pieces_more = 400000;

/* A part of a triangle, or of a segment (two corners), or a point. */
typedef struct piece {
    double corner[CORNERS_MOST][3];
    uint32_t corners;
    uint32_t near; /* a triangle of the other set that is near */
    uint32_t cuts; /* so many it went through */
} piece;

typedef struct measurer {
    const tm_surface *to;
    tm_distance *found;
    double tolerance;
    double flat; /* what is this near to a plane is on it */
    piece *stack;
    size_t height, room;
    size_t left; /* pieces that may still be cut */
    double weight, sum;
} measurer;

typedef struct plane {
    double point[3], normal[3]; /* of length 1 */
} plane;

/* Asks for the closest point and keeps the largest distance. */
static double ask(measurer *m, const double p[3], uint32_t *near)
{
    tm_surface_point at = {.triangle = *near};
    tm_surface_closest(m->to, p, TM_NONE, &at);
    const double distance = sqrt(at.distance2);
    *near = at.triangle;
    if (distance > m->found->most) {
        m->found->most = distance;
        memcpy(m->found->at, p, sizeof m->found->at);
        memcpy(m->found->to, at.xyz, sizeof m->found->to);
    }
    return distance;
}

/* The area of a piece, the length of a segment, 1 of a point. */
static double weight_of(const piece *p)
{
    double weight = 0;
    if (p->corners == 1)
        return 1;
    if (p->corners == 2)
        return sqrt(tm_distance2(p->corner[0], p->corner[1]));
    for (uint32_t i = 2; i < p->corners; i++)
        weight += tm_triangle_area(p->corner[0], p->corner[i - 1], p->corner[i]);
    return weight;
}

static void find_centre(const piece *p, double centre[3])
{
    for (int k = 0; k < 3; k++) {
        centre[k] = 0;
        for (uint32_t i = 0; i < p->corners; i++)
            centre[k] += p->corner[i][k] / p->corners;
    }
}

static bool push(measurer *m, const piece *p)
{
    piece *moved = tm_grow(m->stack, &m->room, m->height + 1, sizeof *moved);
    if (!moved)
        return false;
    m->stack = moved;
    moved[m->height++] = *p;
    return true;
}

static void add_corner(piece *p, const double xyz[3])
{
    memcpy(p->corner[p->corners++], xyz, sizeof p->corner[0]);
}

/* Which side of the plane the corners are on, and whether it cuts the piece in two. */
static bool is_cut(const measurer *m, const piece *p, const plane *by, double *side)
{
    uint32_t above = 0, below = 0, changes = 0;
    for (uint32_t i = 0; i < p->corners; i++) {
        double from[3];
        tm_subtract(from, p->corner[i], by->point);
        side[i] = tm_dot(from, by->normal);
        if (fabs(side[i]) <= m->flat)
            side[i] = 0;
        above += side[i] > 0;
        below += side[i] < 0;
    }
    for (uint32_t i = 0; i < p->corners; i++)
        changes += side[i] * side[(i + 1) % p->corners] < 0;
    const uint32_t largest = p->corners - (above < below ? above : below) + changes;
    return above > 0 && below > 0 && changes <= 2 && largest <= CORNERS_MOST;
}

/* Cuts the piece in two; the corners on the plane are of both. False where it is on one
 * side. */
static bool cut(const measurer *m, const piece *p, const plane *by, piece *above,
                piece *below)
{
    double side[CORNERS_MOST];
    if (!is_cut(m, p, by, side))
        return false;
    *above = *below = (piece){.near = p->near, .cuts = p->cuts + 1};
    for (uint32_t i = 0; i < p->corners; i++) {
        const uint32_t j = (i + 1) % p->corners;
        if (side[i] >= 0)
            add_corner(above, p->corner[i]);
        if (side[i] <= 0)
            add_corner(below, p->corner[i]);
        if (side[i] * side[j] >= 0 || (p->corners == 2 && i == 1))
            continue;
        double meet[3];
        const double part = side[i] / (side[i] - side[j]);
        for (int k = 0; k < 3; k++)
            meet[k] = p->corner[i][k] + part * (p->corner[j][k] - p->corner[i][k]);
        add_corner(above, meet);
        add_corner(below, meet);
    }
    return true;
}

static bool make_unit(double v[3])
{
    const double length = tm_norm(v);
    if (!(length > 0))
        return false;
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return true;
}

/* The plane of a triangle of the other set, its normal to the side that a point is on. */
static bool plane_of(const measurer *m, uint32_t t, const double p[3], plane *is)
{
    const tm_tree_triangle *triangle = &m->to->tree->triangle[m->to->tree->slot[t]];
    const double(*corner)[3] = (const double(*)[3])triangle->corner;
    double from[3];
    if (triangle->thin)
        return false;
    memcpy(is->point, corner[0], sizeof is->point);
    tm_triangle_normal(is->normal, corner[0], corner[1], corner[2]);
    tm_subtract(from, p, is->point);
    if (tm_dot(from, is->normal) < 0)
        for (int k = 0; k < 3; k++)
            is->normal[k] = -is->normal[k];
    return make_unit(is->normal);
}

/* Cuts where both triangles are as far: the plane through the line that theirs have in
 * common. */
static bool cut_between(const measurer *m, const piece *p, const double centre[3],
                        uint32_t a, uint32_t b, piece part[2])
{
    const double parallel = 1e-3; /* radians */
    plane of_a, of_b;
    if (a == b || !plane_of(m, a, centre, &of_a) || !plane_of(m, b, centre, &of_b))
        return false;
    double normal[3], to_b[3];
    tm_subtract(normal, of_a.normal, of_b.normal);
    const double length = tm_norm(normal);
    if (length < parallel)
        return false;
    /* n_a (x - a) = n_b (x - b): (n_a - n_b) (x - a) = n_b (a - b) */
    tm_subtract(to_b, of_a.point, of_b.point);
    const double offset = tm_dot(of_b.normal, to_b) / (length * length);
    plane by;
    for (int k = 0; k < 3; k++) {
        by.point[k] = of_a.point[k] + offset * normal[k];
        by.normal[k] = normal[k] / length;
    }
    return cut(m, p, &by, &part[0], &part[1]);
}

/* The planes across a triangle's own through its edges, normals inward; of a thin one,
 * those across its longest edge through its ends. Returns how many. */
static int find_borders(const measurer *m, uint32_t t, plane border[3])
{
    const tm_tree_triangle *triangle = &m->to->tree->triangle[m->to->tree->slot[t]];
    const double(*corner)[3] = (const double(*)[3])triangle->corner;
    double normal[3], along[3];
    int borders = 0, longest = 0;
    tm_triangle_normal(normal, corner[0], corner[1], corner[2]);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        plane *is = &border[borders];
        if (tm_distance2(corner[i], corner[j]) >
            tm_distance2(corner[longest], corner[(longest + 1) % 3]))
            longest = i;
        memcpy(is->point, corner[i], sizeof is->point);
        tm_subtract(along, corner[j], corner[i]);
        tm_cross(is->normal, normal, along);
        borders += !triangle->thin && make_unit(is->normal);
    }
    for (int end = 0; end < 2 && triangle->thin; end++) {
        const double *from = corner[(longest + end) % 3];
        plane *is = &border[borders];
        memcpy(is->point, from, sizeof is->point);
        tm_subtract(is->normal, corner[(longest + 1 - end) % 3], from);
        borders += make_unit(is->normal);
    }
    return borders;
}

/* Cuts off what is beyond the borders of a triangle: to the stack. False in *cut_any
 * where nothing is; false where memory is out. */
static bool cut_at_borders(measurer *m, const piece *p, uint32_t t, bool *cut_any)
{
    plane border[3];
    const int borders = find_borders(m, t, border);
    piece inside = *p, part[2];
    *cut_any = false;
    for (int i = 0; i < borders; i++) {
        if (!cut(m, &inside, &border[i], &part[0], &part[1]))
            continue;
        *cut_any = true;
        inside = part[0];
        if (!push(m, &part[1]))
            return false;
    }
    inside.cuts = p->cuts + 1;
    return !*cut_any || push(m, &inside);
}

/* Cuts across the line between the two corners that are farthest from each other. */
static bool halve(const measurer *m, const piece *p, piece part[2])
{
    uint32_t a = 0, b = 0;
    double largest2 = 0;
    for (uint32_t i = 0; i < p->corners; i++)
        for (uint32_t j = 0; j < i; j++) {
            const double length2 = tm_distance2(p->corner[i], p->corner[j]);
            if (length2 > largest2) {
                largest2 = length2;
                a = i;
                b = j;
            }
        }
    plane by;
    for (int k = 0; k < 3; k++)
        by.point[k] = p->corner[a][k] / 2 + p->corner[b][k] / 2;
    tm_subtract(by.normal, p->corner[b], p->corner[a]);
    return make_unit(by.normal) && cut(m, p, &by, &part[0], &part[1]);
}

static void drop(measurer *m, const piece *p, double distance, double bound)
{
    const double weight = weight_of(p);
    m->found->bound = fmax(m->found->bound, bound);
    m->weight += weight;
    m->sum += weight * distance;
}

/* The bound on the distance in the piece: see surface_distance.h. *worst is the corner
 * that is farthest from the triangle closest to the centre. */
static double bound_of(const measurer *m, const piece *p, const double centre[3],
                       uint32_t t, double distance, uint32_t *worst)
{
    double by_triangle = 0, radius2 = 0;
    *worst = 0;
    for (uint32_t i = 0; i < p->corners; i++) {
        const double d2 = tm_surface_triangle_distance2(m->to, t, p->corner[i]);
        if (d2 > by_triangle) {
            by_triangle = d2;
            *worst = i;
        }
        radius2 = fmax(radius2, tm_distance2(centre, p->corner[i]));
    }
    return fmin(sqrt(by_triangle), distance + sqrt(radius2));
}

/* Cuts a piece to the stack, or drops it where that cannot be. */
static bool cut_piece(measurer *m, const piece *p, const double centre[3],
                      uint32_t at_centre, uint32_t at_worst, double distance,
                      double bound)
{
    piece part[2];
    bool done = false;
    if (p->cuts % HALVE_EVERY < HALVE_EVERY - 1) {
        done = cut_between(m, p, centre, at_centre, at_worst, part);
        if (!done) {
            if (!cut_at_borders(m, p, at_centre, &done))
                return false;
            if (done)
                return true;
        }
    }
    if (!done && !halve(m, p, part)) {
        drop(m, p, distance, bound);
        return true;
    }
    return push(m, &part[0]) && push(m, &part[1]);
}

/* Drops the piece on top of the stack, or cuts it. */
static bool take_piece(measurer *m)
{
    piece p = m->stack[--m->height];
    double centre[3];
    uint32_t worst;
    find_centre(&p, centre);
    const double distance = ask(m, centre, &p.near);
    const double bound = bound_of(m, &p, centre, p.near, distance, &worst);
    if (bound > m->found->most + m->tolerance && m->left > 0) {
        uint32_t at_worst = p.near;
        ask(m, p.corner[worst], &at_worst);
        if (bound > m->found->most + m->tolerance) {
            m->left--;
            return cut_piece(m, &p, centre, p.near, at_worst, distance, bound);
        }
    }
    drop(m, &p, distance, bound);
    return true;
}

/* A triangle with nodes that are one is a segment or a point. */
static piece piece_of(const tm_surface *from, size_t t, uint32_t near)
{
    const uint32_t *v = from->triangle[t];
    piece p = {.near = near};
    for (int i = 0; i < 3; i++)
        if (i == 0 || (v[i] != v[0] && v[i] != v[i - 1]))
            add_corner(&p, from->xyz[v[i]]);
    return p;
}

/* The nodes first: the largest distance is often near one. */
static bool measure_all(measurer *m, const tm_surface *from)
{
    uint32_t near = TM_NONE;
    bool *asked = calloc(from->nodes + 1, sizeof *asked);
    if (!asked)
        return false;
    for (size_t i = 0; i < 3 * from->triangles; i++) {
        const uint32_t v = from->triangle[i / 3][i % 3];
        if (!asked[v])
            ask(m, from->xyz[v], &near);
        asked[v] = true;
    }
    free(asked);
    for (size_t t = 0; t < from->triangles; t++) {
        const piece p = piece_of(from, t, near);
        if (!push(m, &p))
            return false;
        while (m->height > 0)
            if (!take_piece(m))
                return false;
    }
    return true;
}

static tm_status measure(tm_distance *found, const tm_surface *from, const tm_surface *to,
                         double diagonal, tm_error *error)
{
    *found = (tm_distance){.parts = from->triangles};
    if (from->triangles == 0)
        return TM_OK;
    if (to->triangles == 0) {
        found->most = found->bound = found->mean = HUGE_VAL;
        memcpy(found->at, from->xyz[from->triangle[0][0]], sizeof found->at);
        return TM_OK;
    }
    measurer m = {.to = to,
                  .found = found,
                  .tolerance = accuracy * diagonal,
                  .flat = on_plane * diagonal,
                  .left = PIECES_PER_TRIANGLE * from->triangles + pieces_more};
    const bool done = measure_all(&m, from);
    free(m.stack);
    found->bound = fmax(found->bound, found->most);
    found->mean = m.weight > 0 ? m.sum / m.weight : found->most;
    return done ? TM_OK : tm_fail_memory(error);
}

static tm_status measure_ways(tm_distance found[TM_WAYS], const tm_surface *first,
                              const tm_surface *second, double diagonal, tm_error *error)
{
    const tm_status status = measure(&found[TM_THERE], first, second, diagonal, error);
    return status == TM_OK ? measure(&found[TM_BACK], second, first, diagonal, error)
                           : status;
}

static bool has_markers(const tm_surface *surface)
{
    for (size_t t = 1; t < surface->triangles && surface->marker; t++)
        if (surface->marker[t] != surface->marker[0])
            return true;
    return false;
}

static tm_status compare_sharp(tm_surface_comparison *c, const tm_surface *first,
                               const tm_surface *second, double feature_angle,
                               tm_error *error)
{
    const bool markers_count = has_markers(first) && has_markers(second);
    tm_surface_sharp a, b = {0};
    tm_status status =
        tm_surface_find_sharp(&a, first, feature_angle, markers_count, error);
    if (status == TM_OK)
        status = tm_surface_find_sharp(&b, second, feature_angle, markers_count, error);
    c->rough = b.rough;
    if (status == TM_OK && !c->rough)
        status = measure_ways(c->curve, &a.curve, &b.curve, c->diagonal, error);
    if (status == TM_OK && !c->rough)
        status = measure_ways(c->corner, &a.corner, &b.corner, c->diagonal, error);
    tm_surface_sharp_free(&a);
    tm_surface_sharp_free(&b);
    return status;
}

tm_status tm_surface_compare(tm_surface_comparison *comparison, const tm_surface *first,
                             const tm_surface *second, double feature_angle,
                             tm_error *error)
{
    const double diagonal = sqrt(tm_distance2(second->low, second->high));
    *comparison =
        (tm_surface_comparison){.diagonal = diagonal, .tolerance = accuracy * diagonal};
    const tm_status status =
        measure_ways(comparison->surface, first, second, diagonal, error);
    if (status != TM_OK)
        return status;
    return compare_sharp(comparison, first, second, feature_angle, error);
}

tm_status tm_surface_of_polygons(tm_surface *surface, const tm_polygon_surface *polygons,
                                 tm_error *error)
{
    *surface = (tm_surface){0};
    tm_group_init(&surface->group, ".group");
    const tm_status status = tm_surface_triangulate(surface, polygons, error);
    if (status != TM_OK)
        return status;
    if (surface->triangles == 0)
        return tm_fail(error, TM_ERROR_INPUT, "the surface has no triangle with area");
    return tm_surface_tree_build(surface, error);
}

static tm_status copy_triangles(tm_surface *surface, const double (*xyz)[3], size_t nodes,
                                const uint32_t (*triangle)[3], const int32_t *marker,
                                tm_error *error)
{
    surface->nodes = nodes;
    surface->xyz = tm_new(nodes, sizeof *surface->xyz);
    surface->triangle = tm_new(surface->triangles, sizeof *surface->triangle);
    surface->origin = tm_new(nodes, sizeof *surface->origin);
    if (marker)
        surface->marker = tm_new(surface->triangles, sizeof *marker);
    if (!surface->xyz || !surface->triangle || !surface->origin ||
        (marker && !surface->marker))
        return tm_fail_memory(error);
    memcpy(surface->xyz, xyz, nodes * sizeof *xyz);
    memcpy(surface->triangle, triangle, surface->triangles * sizeof *triangle);
    if (marker)
        memcpy(surface->marker, marker, surface->triangles * sizeof *marker);
    for (size_t v = 0; v < nodes; v++)
        surface->origin[v] = (uint32_t)v;
    return tm_surface_drop_nodes(surface, error);
}

tm_status tm_surface_of_triangles(tm_surface *surface, const double (*xyz)[3],
                                  size_t nodes, const uint32_t (*triangle)[3],
                                  const int32_t *marker, size_t triangles,
                                  tm_error *error)
{
    *surface = (tm_surface){.triangles = triangles};
    tm_group_init(&surface->group, ".group");
    if (triangles == 0)
        return tm_fail(error, TM_ERROR_INPUT, "there is no face to compare");
    const tm_status status = copy_triangles(surface, xyz, nodes, triangle, marker, error);
    return status == TM_OK ? tm_surface_tree_build(surface, error) : status;
}
