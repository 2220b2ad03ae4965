/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_parts.h"

#include "../../geom/vector.h"

#include <math.h>
#include <string.h>

/* Patches that are told apart: two meet at an edge, more at a corner, or, where walls
 * meet, at an edge too. */
enum { PATCHES = 8 };

/* Directions that are remembered: more than eight that differ by 37° are rare, and only
 * make the octant smaller later. */
enum { DIRECTIONS = 8 };

/* A point of the surface close to the middle of an octant, away from the border of its
 * triangle. */
static void choose_point(const tm_surface *surface, const double centre[3], double side,
                         double point[3], uint32_t *triangle)
{
    const double away = 0.1; /* sides of the octant, at most */
    tm_surface_point at = {.triangle = TM_NONE};
    tm_surface_closest(surface, centre, TM_NONE, &at);
    const double *p[3];
    double to_middle[3];
    for (int i = 0; i < 3; i++)
        p[i] = surface->xyz[surface->triangle[at.triangle][i]];
    for (int i = 0; i < 3; i++)
        to_middle[i] = (p[0][i] + p[1][i] + p[2][i]) / 3 - at.xyz[i];
    const double far = tm_norm(to_middle);
    const double step = far > 0 ? fmin(1, away * side / far) : 0;
    for (int i = 0; i < 3; i++)
        point[i] = at.xyz[i] + step * to_middle[i];
    *triangle = at.triangle;
}

bool tm_octant_is_thin_at(const tm_surface *surface, uint32_t triangle,
                          const double point[3], double side)
{
    enum { SIDES = 2 };
    const uint32_t *v = surface->triangle[triangle];
    double normal[3];
    tm_triangle_normal(normal, surface->xyz[v[0]], surface->xyz[v[1]],
                       surface->xyz[v[2]]);
    const double length = tm_norm(normal);
    if (!(length > 0))
        return false;
    for (int i = 0; i < 3; i++)
        normal[i] /= length;
    for (int s = 1; s <= SIDES; s++)
        for (int way = -1; way <= 1; way += 2) {
            double q[3];
            for (int i = 0; i < 3; i++)
                q[i] = point[i] + way * s * side * normal[i];
            if (!tm_surface_is_beside(surface, triangle, way < 0, q))
                return true;
        }
    return false;
}

/* Whether the solid or a gap in it ends within two sides of the octant behind or before
 * the surface. */
static bool is_thin(const tm_surface *surface, const double low[3], double side)
{
    double centre[3], point[3];
    uint32_t triangle;
    for (int i = 0; i < 3; i++)
        centre[i] = low[i] + side / 2;
    choose_point(surface, centre, side, point, &triangle);
    return tm_octant_is_thin_at(surface, triangle, point, side);
}

/* Whether triangles look in opposite directions, as those of both sides of a thin wall.
 */
static bool is_opposed(const tm_surface *surface, const uint32_t *triangle, size_t count)
{
    const double opposite = -0.5, same = 0.8; /* cosines */
    double direction[DIRECTIONS][3];
    unsigned directions = 0;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *v = surface->triangle[triangle[i]];
        double normal[3];
        tm_triangle_normal(normal, surface->xyz[v[0]], surface->xyz[v[1]],
                           surface->xyz[v[2]]);
        const double length = tm_norm(normal);
        bool known = length == 0;
        for (int k = 0; k < 3 && length > 0; k++)
            normal[k] /= length;
        for (unsigned d = 0; d < directions; d++) {
            const double cosine = tm_dot(normal, direction[d]);
            if (cosine < opposite)
                return true;
            known |= cosine > same;
        }
        if (!known && directions < DIRECTIONS)
            memcpy(direction[directions++], normal, sizeof normal);
    }
    return false;
}

/* Whether a node is in the octant, or no farther from it than `beside`. */
static bool is_in(const tm_surface *surface, uint32_t v, const double low[3], double side,
                  double beside)
{
    for (int k = 0; k < 3; k++) {
        const double x = surface->xyz[v][k] - low[k];
        if (x < -beside || x > side + beside)
            return false;
    }
    return true;
}

/* Patches, a bit each. */
typedef struct {
    unsigned count;
    uint32_t patch[PATCHES];
} patch_list;

static unsigned bit_of(const patch_list *list, uint32_t patch)
{
    unsigned p = 0;
    while (p < list->count && list->patch[p] != patch)
        p++;
    return p;
}

static bool has_node(const uint32_t node[3], uint32_t v)
{
    return node[0] == v || node[1] == v || node[2] == v;
}

/* Whether all patches come together at an edge of the triangles. */
static bool meet_at_edge(const tm_surface *surface, const patch_list *list,
                         const uint32_t *triangle, size_t count)
{
    for (size_t i = 0; i < 3 * count; i++) {
        const uint32_t *v = surface->triangle[triangle[i / 3]];
        const uint32_t a = v[i % 3], b = v[(i + 1) % 3];
        unsigned met = 0;
        if (surface->across[triangle[i / 3]][i % 3] != TM_NONE)
            continue;
        for (size_t k = 0; k < count; k++) {
            const uint32_t t = triangle[k];
            if (has_node(surface->triangle[t], a) && has_node(surface->triangle[t], b))
                met |= 1u << bit_of(list, surface->patch[t]);
        }
        if (met == (1u << list->count) - 1)
            return true;
    }
    return false;
}

/* Whether patches come together without a corner, more than two and not at an edge, or
 * there are two corners. */
static bool has_many(const tm_surface *surface, const bool *is_corner,
                     const uint32_t *triangle, size_t count, const double low[3],
                     double side)
{
    const unsigned most = surface->walls ? PATCHES : 3;
    patch_list list = {0};
    uint32_t corner = TM_NONE;
    bool corner_near = false;
    for (size_t i = 0; i < count; i++) {
        const uint32_t t = triangle[i];
        if (bit_of(&list, surface->patch[t]) == list.count && list.count < most)
            list.patch[list.count++] = surface->patch[t];
        for (int c = 0; c < 3; c++) {
            const uint32_t v = surface->triangle[t][c];
            if (!is_corner[v] || !is_in(surface, v, low, side, side))
                continue;
            corner_near = true;
            if (!is_in(surface, v, low, side, 0))
                continue;
            if (corner != TM_NONE && corner != v)
                return true;
            corner = v;
        }
    }
    return list.count > 2 && !corner_near &&
           !(surface->walls && meet_at_edge(surface, &list, triangle, count));
}

bool tm_octant_is_crowded(const tm_surface *surface, const bool *is_corner,
                          const uint32_t *triangle, size_t count, const double low[3],
                          double side)
{
    /* Walls look to either side. */
    return (!surface->walls && is_opposed(surface, triangle, count)) ||
           has_many(surface, is_corner, triangle, count, low, side) ||
           is_thin(surface, low, side);
}
