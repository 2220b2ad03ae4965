/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "feature_parts.h"

#include "../../geom/vector.h"

#include <math.h>
#include <string.h>

/* Where a node of a path will be, about. */
static void point_of(const tm_feature *feature, const tm_interior_boundary *boundary,
                     const tm_surface *surface, uint32_t s, double xyz[3])
{
    size_t segment;
    tm_boundary_node_point(boundary, s, xyz);
    if (feature->kind[s] == TM_ON_CORNER) {
        memcpy(xyz, surface->xyz[surface->corner[feature->of[s]]], 3 * sizeof *xyz);
    } else if (feature->kind[s] == TM_ON_CURVE) {
        const double point[3] = {xyz[0], xyz[1], xyz[2]};
        tm_surface_closest_on_curve(surface, feature->of[s], point, xyz, &segment);
    }
}

/* The cosine of the angle at b of a face abc… on a patch with that normal; -1 where the
 * angle is more than 180°. */
static double cosine_at(const double a[3], const double b[3], const double c[3],
                        const double normal[3])
{
    double ba[3];
    double bc[3];
    double cross[3];
    tm_subtract(ba, a, b);
    tm_subtract(bc, c, b);
    tm_cross(cross, bc, ba);
    const double lengths = tm_norm(ba) * tm_norm(bc);
    if (lengths == 0)
        return 1;
    return tm_dot(cross, normal) < 0 ? -1 : tm_dot(ba, bc) / lengths;
}

/* The normal of the surface next to a node. */
static void normal_at(const tm_surface *surface, const tm_surface_point *at,
                      double normal[3])
{
    const uint32_t *t = surface->triangle[at->triangle];
    tm_triangle_normal(normal, surface->xyz[t[0]], surface->xyz[t[1]],
                       surface->xyz[t[2]]);
}

/* Whether a curve where walls meet goes around corner i of a face: its nodes are on edges
 * there, and only later spread along it. */
static bool is_passed_by_walls(const tm_feature *feature, const tm_surface *surface,
                               const uint32_t face[4], unsigned i)
{
    const uint32_t before = face[(i + 3) % 4], after = face[(i + 1) % 4];
    if (feature->kind[face[i]] != TM_ON_CURVE ||
        !tm_curve_is_of_walls(surface, feature->of[face[i]]))
        return false;
    const uint32_t *along = feature->along[face[i]];
    return (along[0] == before && along[1] == after) ||
           (along[0] == after && along[1] == before);
}

void tm_feature_cut_wide(const tm_feature *feature, tm_interior_boundary *boundary,
                         const tm_surface *surface, const uint8_t *on_path,
                         const tm_surface_point *at)
{
    const double wide = -0.6;   /* the cosine of 127° */
    const double straight = -2; /* wider than all: three nodes of one curve */
    for (size_t f = 0; f < boundary->faces; f++) {
        double widest = wide;
        if (on_path[f] == 0 || boundary->cut[f] != TM_UNCUT ||
            tm_boundary_face_corners(boundary, f) != 4)
            continue;
        for (unsigned i = 0; i < 4; i++) {
            const unsigned before = (i + 3) % 4, after = (i + 1) % 4;
            double p[3][3];
            double normal[3];
            if (!(on_path[f] >> i & 1) || !(on_path[f] >> before & 1))
                continue;
            point_of(feature, boundary, surface, boundary->face[f][before], p[0]);
            point_of(feature, boundary, surface, boundary->face[f][i], p[1]);
            point_of(feature, boundary, surface, boundary->face[f][after], p[2]);
            normal_at(surface, &at[boundary->face[f][(i + 2) % 4]], normal);
            const double cosine =
                is_passed_by_walls(feature, surface, boundary->face[f], i)
                    ? straight
                    : cosine_at(p[0], p[1], p[2], normal);
            if (cosine < widest) {
                widest = cosine;
                boundary->cut[f] = i % 2 ? TM_CUT_13 : TM_CUT_02;
            }
        }
    }
}
