/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether clusters stay star-shaped as they grow. */
#include "cluster_growth.h"

#include "../../base/array.h"
#include "../../geom/kernel.h"
#include "../../geom/vector.h"

#include <string.h>

/* The kernel's ball has at least this part of the extent as its radius, or what is asked
 * for. */
static const double least_ball = 1e-4, least_radius = 1e-8;

/* The plane of a facet, seen from cell c outward, through the innermost of its nodes,
 * from an origin; false where it has no area. */
static bool plane_of(const tm_growth *g, uint32_t f, uint32_t c, const double origin[3],
                     double plane[4])
{
    const tm_cell_faces *faces = g->mesh->faces;
    const uint32_t *node = faces->node + faces->start[f];
    const size_t count = faces->start[f + 1] - faces->start[f];
    const double sign = tm_facet_is_outward(faces, f, c) ? 1 : -1;
    double to[3];
    for (int x = 0; x < 3; x++)
        plane[x] = sign * g->normal[f][x];
    plane[3] = HUGE_VAL;
    for (size_t i = 0; i < count; i++) {
        tm_subtract(to, g->mesh->xyz[node[i]], origin);
        const double distance = tm_dot(plane, to);
        plane[3] = distance < plane[3] ? distance : plane[3];
    }
    return tm_norm2(g->normal[f]) > 0;
}

/* Whether a facet of a cell is on the boundary of the piece with cell c. */
static bool is_outer(const tm_growth *g, uint32_t f, uint32_t cell, uint32_t c)
{
    const uint32_t other = tm_growth_across(g, f, cell);
    return !tm_growth_has(g, other) && (other == TM_NONE || other != c);
}

/* Collects the planes of the piece with cell c; false where one has none. */
static bool collect_planes(tm_growth *g, uint32_t c, size_t *count, bool *memory)
{
    const tm_cell_faces *faces = g->mesh->faces;
    *count = 0;
    for (size_t m = 0; m <= g->size; m++) {
        const uint32_t cell = m < g->size ? g->member[m] : c;
        const size_t start = faces->cell_start[cell], end = faces->cell_start[cell + 1];
        double(*plane)[4] =
            tm_grow(g->plane, &g->plane_room, *count + end - start, sizeof *plane);
        if (!plane) {
            *memory = false;
            return false;
        }
        g->plane = plane;
        for (size_t k = start; k < end; k++)
            if (is_outer(g, faces->cell_facet[k], cell, c) &&
                !plane_of(g, faces->cell_facet[k], cell, g->origin, plane[(*count)++]))
                return false;
    }
    return true;
}

bool tm_growth_find_normals(tm_growth *g)
{
    const tm_cell_faces *faces = g->mesh->faces;
    g->normal = tm_new(faces->facets, sizeof *g->normal);
    for (size_t f = 0; f < faces->facets && g->normal; f++) {
        double *normal = g->normal[f];
        tm_polygon_area(g->mesh->xyz, faces->node + faces->start[f],
                        faces->start[f + 1] - faces->start[f], normal);
        const double length = tm_norm(normal);
        for (int x = 0; x < 3; x++)
            normal[x] = length > 0 ? normal[x] / length : 0;
    }
    return g->normal;
}

bool tm_growth_find_boxes(tm_growth *g)
{
    const tm_cell_faces *faces = g->mesh->faces;
    g->box = tm_new(faces->cells, sizeof *g->box);
    for (size_t c = 0; c < faces->cells && g->box; c++) {
        double *low = g->box[c][0], *high = g->box[c][1];
        for (int x = 0; x < 3; x++) {
            low[x] = HUGE_VAL;
            high[x] = -HUGE_VAL;
        }
        for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1]; k++) {
            const uint32_t f = faces->cell_facet[k];
            for (size_t i = faces->start[f]; i < faces->start[f + 1]; i++)
                for (int x = 0; x < 3; x++) {
                    low[x] = fmin(low[x], g->mesh->xyz[faces->node[i]][x]);
                    high[x] = fmax(high[x], g->mesh->xyz[faces->node[i]][x]);
                }
        }
    }
    return g->box;
}

/* How deep the centre is inside of all facets, those of c with them. */
static double depth_with(const tm_growth *g, uint32_t c)
{
    const tm_cell_faces *faces = g->mesh->faces;
    double plane[4], depth = g->depth;
    for (size_t k = faces->cell_start[c]; k < faces->cell_start[c + 1] && depth >= 0; k++)
        if (is_outer(g, faces->cell_facet[k], c, c))
            depth = plane_of(g, faces->cell_facet[k], c, g->origin, plane)
                        ? fmin(depth, plane[3] - tm_dot(plane, g->centre))
                        : -1;
    return depth;
}

bool tm_growth_stays_star(tm_growth *g, uint32_t c, bool *memory)
{
    double low[3], high[3], centre[3], radius;
    size_t count;
    memcpy(low, g->low, sizeof low);
    memcpy(high, g->high, sizeof high);
    tm_growth_widen(g, c, low, high);
    const double least =
        (g->options->star == TM_STAR_RADIUS ? fmax(g->options->radius, least_radius)
                                            : least_ball) *
        sqrt(tm_distance2(low, high));
    const double depth = depth_with(g, c);
    if (depth >= least) {
        g->depth = depth;
        return true;
    }
    if (!collect_planes(g, c, &count, memory) ||
        !tm_kernel_ball_of((const double(*)[4])g->plane, count, least, centre, &radius) ||
        radius < least)
        return false;
    memcpy(g->centre, centre, sizeof centre);
    g->depth = radius;
    return true;
}
