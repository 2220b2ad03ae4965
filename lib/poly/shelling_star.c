/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shelling_star.h"

#include "../base/array.h"
#include "../examine/poly/poly_finite_volume.h"
#include "../geom/kernel.h"
#include "../geom/vector.h"
#include "../geom/predicates.h"
#include "../tet/operation/ball.h"

#include <string.h>

/* The kernel's ball has at least this part of the piece's extent as its radius; */
static const double least_ball = 1e-4;
/* what is asked for none has that still. */
static const double least_radius = 1e-8;

/* A centroid is by so much of the extent inside of what follows. */
static const double least_depth = 1e-6;

/* Cosines of the largest angles between the normal of a face and the line from the
 * centroid to that of the face, 85 degrees; and to that of the cell beyond the face. */
static const double steepest_face = 0.087155742747658, steepest_cell = TM_FV_COSINE;

bool tm_shelling_scale(tm_shelling *s)
{
    const tm_tet_mesh *mesh = s->mesh;
    double low[3], high[3], most = 0, by[3];
    s->xyz = tm_new(mesh->nodes, sizeof *s->xyz);
    for (int x = 0; x < 3; x++) {
        low[x] = HUGE_VAL;
        high[x] = -HUGE_VAL;
        for (size_t v = 0; v < mesh->nodes && !s->options->box; v++) {
            low[x] = fmin(low[x], mesh->xyz[v][x]);
            high[x] = fmax(high[x], mesh->xyz[v][x]);
        }
        if (s->options->box) {
            low[x] = s->options->box[0][x];
            high[x] = s->options->box[1][x];
        }
        most = fmax(most, high[x] - low[x]);
    }
    for (int x = 0; x < 3; x++)
        by[x] = high[x] > low[x] && s->options->star == TM_STAR_BALL
                    ? ldexp(1, ilogb(most / (high[x] - low[x])))
                    : 1;
    for (size_t v = 0; v < mesh->nodes && s->xyz; v++)
        for (int x = 0; x < 3; x++)
            s->xyz[v][x] = by[x] * mesh->xyz[v][x];
    return s->xyz;
}

/* The outer plane of face i of t, its normal of unit length; false where it has none. */
static bool plane_of(const tm_shelling *s, uint32_t t, uint32_t i, double plane[4])
{
    uint32_t n[3];
    double a[3];
    const double(*xyz)[3] = (const double(*)[3])s->xyz;
    tm_tet_face_below(s->mesh, t, i, n);
    tm_triangle_normal(plane, xyz[n[0]], xyz[n[2]], xyz[n[1]]);
    tm_subtract(a, xyz[n[0]], s->origin);
    double length = tm_norm(plane);
    for (int x = 0; x < 3; x++)
        plane[x] /= length;
    plane[3] = tm_dot(plane, a);
    return length > 0;
}

/* Whether face i of t is on the boundary of the piece and t. */
static bool is_outer(const tm_shelling *s, uint32_t t, uint32_t i, uint32_t added)
{
    uint32_t across = s->mesh->neighbour[t][i];
    return across & TM_FACE_BIT ||
           (tm_piece_of(s->piece, across / 4) != s->id && across / 4 != added);
}

/* Adds the volume of t, and that times its centroid from the origin; scaled. */
static void add_moment(const tm_shelling *s, uint32_t t, double moment[4])
{
    const uint32_t *n = s->mesh->tet[t];
    const double(*xyz)[3] = (const double(*)[3])s->xyz;
    const double volume = fabs(tm_tet_volume(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]));
    for (int x = 0; x < 3; x++) {
        double centre = 0;
        for (int i = 0; i < 4; i++)
            centre += (xyz[n[i]][x] - s->origin[x]) / 4;
        moment[x] += volume * centre;
    }
    moment[3] += volume;
}

void tm_shelling_set_centroid(tm_shelling *s)
{
    for (int x = 0; x < 3 && s->moment[3] > 0; x++)
        s->centroid[s->id][x] = s->origin[x] + s->moment[x] / s->moment[3];
}

void tm_shelling_measure(tm_shelling *s, uint32_t t)
{
    for (int i = 0; i < 4; i++)
        for (int x = 0; x < 3; x++) {
            const double place = s->xyz[s->mesh->tet[t][i]][x];
            s->low[x] = fmin(s->low[x], place);
            s->high[x] = fmax(s->high[x], place);
        }
    if (s->options->star == TM_STAR_CENTROID) {
        add_moment(s, t, s->moment);
        tm_shelling_set_centroid(s);
    }
}

/* How deep a point is inside of the outer faces of t, or `depth` if that is less. */
static double depth_with(const tm_shelling *s, uint32_t t, const double point[3],
                         double depth)
{
    double plane[4];
    for (uint32_t i = 0; i < 4; i++)
        if (is_outer(s, t, i, t))
            depth = plane_of(s, t, i, plane)
                        ? fmin(depth, plane[3] - tm_dot(plane, point))
                        : -1;
    return depth;
}

/* Collects the planes of the piece, and of t, if that is one; false where one has none,
 * too. */
static bool collect_planes(tm_shelling *s, uint32_t t, size_t *count, bool *memory)
{
    double(*plane)[4] =
        tm_grow(s->plane, &s->plane_room, 4 * (s->size + 1), sizeof *plane);
    *count = 0;
    if (!plane) {
        *memory = false;
        return false;
    }
    s->plane = plane;
    for (size_t k = 0; k <= s->size; k++) {
        uint32_t u = k < s->size ? s->member[k] : t;
        for (uint32_t i = 0; i < 4 && u != TM_NONE; i++)
            if (is_outer(s, u, i, t) && !plane_of(s, u, i, plane[(*count)++]))
                return false;
    }
    return true;
}

/* How large the piece is, with t if that is one: the diagonal of a box around it. */
static double extent_with(const tm_shelling *s, uint32_t t)
{
    double extent2 = 0;
    for (int x = 0; x < 3; x++) {
        double low = s->low[x], high = s->high[x];
        for (int i = 0; i < 4 && t != TM_NONE; i++) {
            low = fmin(low, s->xyz[s->mesh->tet[t][i]][x]);
            high = fmax(high, s->xyz[s->mesh->tet[t][i]][x]);
        }
        extent2 += (high - low) * (high - low);
    }
    return sqrt(extent2);
}

/* Puts the centre where it is deepest; false where it is no deeper than `least`. */
static bool find_centre(tm_shelling *s, uint32_t t, double least, bool *memory)
{
    double centre[3], radius;
    size_t count;
    if (!collect_planes(s, t, &count, memory) ||
        !tm_kernel_ball_of((const double(*)[4])s->plane, count, least, centre, &radius) ||
        radius < least)
        return false;
    memcpy(s->centre, centre, sizeof centre);
    s->depth = radius;
    return true;
}

/* How deep the centre has to be. */
static double least_of(const tm_shelling *s)
{
    return s->options->star == TM_STAR_RADIUS ? fmax(s->options->radius, least_radius)
                                              : least_ball;
}

/* The same with t; a piece that is not may become deeper. */
static double least_with(tm_shelling *s, uint32_t t, bool *memory)
{
    double least = least_of(s);
    const double extent = extent_with(s, TM_NONE);
    if (s->options->star == TM_STAR_RADIUS && s->depth < least * extent &&
        find_centre(s, TM_NONE, 0, memory))
        least = fmin(least, s->depth / extent);
    return least * extent_with(s, t);
}

static bool keeps_ball(tm_shelling *s, uint32_t t, bool *memory)
{
    const double least = least_with(s, t, memory);
    double depth = depth_with(s, t, s->centre, s->depth);
    if (depth < least)
        return find_centre(s, t, least, memory);
    s->depth = depth;
    return true;
}

/* The way from a point to the centroid of the cell across face i of t; false at the
 * boundary. What is in no piece yet is a cell of its own. */
static bool to_cell_across(const tm_shelling *s, uint32_t t, uint32_t i,
                           const double point[3], double to[3])
{
    const uint32_t across = tm_tet_across(s->mesh, t, i);
    if (across == TM_NONE)
        return false;
    const uint32_t piece = tm_piece_of(s->piece, across / 4);
    double moment[4] = {0};
    if (piece == TM_NONE)
        add_moment(s, across / 4, moment);
    for (int x = 0; x < 3; x++)
        to[x] = (piece != TM_NONE ? s->centroid[piece][x] - s->origin[x]
                 : moment[3] > 0  ? moment[x] / moment[3]
                                  : 0) -
                point[x];
    return piece != TM_NONE || moment[3] > 0;
}

/* How far a point is inside of face i of t, less what that has to be for the steepest
 * angles. It changes by (1 + steepest_cell) times the way of the point at most. */
static double inside_of(const tm_shelling *s, uint32_t t, uint32_t i,
                        const double point[3])
{
    uint32_t n[3];
    double plane[4], to[3];
    if (!plane_of(s, t, i, plane))
        return -HUGE_VAL;
    tm_tet_face_below(s->mesh, t, i, n);
    for (int x = 0; x < 3; x++)
        to[x] = (s->xyz[n[0]][x] + s->xyz[n[1]][x] + s->xyz[n[2]][x]) / 3 - s->origin[x] -
                point[x];
    const double depth = plane[3] - tm_dot(plane, point) - steepest_face * tm_norm(to);
    if (!to_cell_across(s, t, i, point, to))
        return depth;
    return fmin(depth, tm_dot(plane, to) - steepest_cell * tm_norm(to));
}

/* The least of that over the outer faces of t, or `depth` if that is less. */
static double depth_of_centroid(const tm_shelling *s, uint32_t t, uint32_t added,
                                const double point[3], double depth)
{
    for (uint32_t i = 0; i < 4; i++)
        if (is_outer(s, t, i, added))
            depth = fmin(depth, inside_of(s, t, i, point));
    return depth;
}

/* Puts the centre in the centroid of the piece with t, if that sees all. What has been
 * so deep is so still, but for how far the centroid has moved. */
static bool keeps_centroid(tm_shelling *s, uint32_t t)
{
    double moment[4], centre[3];
    memcpy(moment, s->moment, sizeof moment);
    add_moment(s, t, moment);
    if (!(moment[3] > 0))
        return false;
    for (int x = 0; x < 3; x++)
        centre[x] = moment[x] / moment[3];
    const double least = least_depth * extent_with(s, t);
    const double moved = sqrt(tm_distance2(s->centre, centre));
    double depth = depth_of_centroid(s, t, t, centre, HUGE_VAL);
    if (depth < least)
        return false;
    if (s->depth - (1 + steepest_cell) * moved >= least) {
        depth = fmin(depth, s->depth - (1 + steepest_cell) * moved);
    } else {
        for (size_t k = 0; k < s->size && depth >= least; k++)
            depth = depth_of_centroid(s, s->member[k], t, centre, depth);
    }
    if (depth < least)
        return false;
    memcpy(s->centre, centre, sizeof centre);
    s->depth = depth;
    return true;
}

bool tm_shelling_stays_star(tm_shelling *s, uint32_t t, bool *memory)
{
    return s->options->star == TM_STAR_CENTROID ? keeps_centroid(s, t)
                                                : keeps_ball(s, t, memory);
}

bool tm_shelling_is_star(tm_shelling *s, bool *memory)
{
    if (s->size == 1 && s->options->star != TM_STAR_RADIUS) {
        const uint32_t *n = s->mesh->tet[s->member[0]];
        const double(*xyz)[3] = (const double(*)[3])s->mesh->xyz;
        return tm_orient3d(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]) != 0;
    }
    return find_centre(s, TM_NONE, least_of(s) * extent_with(s, TM_NONE), memory);
}
