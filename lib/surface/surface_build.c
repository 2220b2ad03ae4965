/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../base/array.h"
#include "surface_parts.h"
#include "surface_tree.h"

#include <stdlib.h>

/* A node counts once for each fan: the corners of triangles, joined across edges. */
static tm_status count_fans(const tm_surface *surface, size_t *fans, tm_error *error)
{
    size_t corners = 3 * surface->triangles;
    bool *met = calloc(corners + 1, sizeof *met);
    if (!met)
        return tm_fail_memory(error);
    *fans = 0;
    for (size_t c = 0; c < corners; c++) {
        if (met[c])
            continue;
        (*fans)++;
        for (unsigned way = 0; way < 2; way++) {
            uint32_t t = (uint32_t)(c / 3), v = surface->triangle[t][c % 3];
            while (t != TM_NONE) {
                const uint32_t *node = surface->triangle[t];
                unsigned i = node[0] == v ? 0 : node[1] == v ? 1 : 2;
                if (met[3 * (size_t)t + i] && t != c / 3)
                    break;
                met[3 * (size_t)t + i] = true;
                t = surface->across[t][way == 0 ? i : (i + 2) % 3];
                if (t == c / 3)
                    break;
            }
        }
    }
    free(met);
    return TM_OK;
}

static tm_status count_euler(tm_surface *surface, tm_error *error)
{
    size_t fans = 0;
    tm_status status = count_fans(surface, &fans, error);
    if (status == TM_OK) {
        size_t edges = (3 * surface->triangles + surface->open_edges) / 2;
        surface->touching = fans - surface->nodes;
        surface->euler = (int64_t)fans - (int64_t)edges + (int64_t)surface->triangles;
    }
    return status;
}

static tm_status shape(tm_surface *surface, const tm_surface_options *options,
                       unsigned base, tm_error *error)
{
    tm_status status =
        tm_surface_connect(surface, options->lenient, options->walls, base, error);
    if (status == TM_OK)
        status = tm_surface_orient(surface, options->lenient, base, error);
    if (status == TM_OK)
        status = tm_surface_mend(surface, error);
    if (status == TM_OK && !surface->walls)
        status = count_euler(surface, error);
    return status;
}

static tm_status prepare(tm_surface *surface, const tm_polygon_surface *polygons,
                         const tm_surface_options *options, tm_error *error)
{
    const unsigned base = polygons->base;
    tm_status status = tm_surface_tree_build(surface, error);
    if (status == TM_OK)
        status = tm_surface_find_crossings(surface, options->lenient, base, error);
    surface->by_winding = surface->open_edges + surface->crossings > 0;
    if (status == TM_OK)
        status = surface->walls ? tm_surface_find_walls(surface, polygons, error)
                                : tm_surface_turn(surface, error);
    if (status == TM_OK)
        status = tm_surface_find_features(surface, options->feature_angle,
                                          options->unless_rough, 0, error);
    if (status == TM_OK) {
        tm_surface_tree_refresh(surface);
        status = tm_surface_curve_build(surface, error);
    }
    if (status == TM_OK && surface->by_winding)
        status = tm_surface_winding_build(surface, error);
    return status;
}

tm_status tm_surface_build(tm_surface *surface, const tm_polygon_surface *polygons,
                           const tm_surface_options *options, tm_error *error)
{
    *surface = (tm_surface){.threads = options->threads};
    tm_status status = tm_surface_triangulate(surface, polygons, error);
    tm_group_init(&surface->group, ".group");
    if (status == TM_OK)
        status =
            tm_group_append(&surface->group, &polygons->group, TM_GROUP_FACES, error);
    if (status == TM_OK)
        status = shape(surface, options, polygons->base, error);
    if (status == TM_OK)
        status = prepare(surface, polygons, options, error);
    if (status == TM_OK && options->regions && !surface->walls)
        status = tm_surface_find_regions(surface, polygons, error);
    return status;
}

void tm_surface_free(tm_surface *surface)
{
    free(surface->xyz);
    free(surface->triangle);
    free(surface->marker);
    tm_group_free(&surface->group);
    free(surface->facet);
    free(surface->origin);
    free(surface->across);
    free(surface->shell);
    free(surface->region);
    free(surface->side);
    free(surface->hole);
    free(surface->patch);
    free(surface->curve_start);
    free(surface->curve_node);
    free(surface->curve_patch);
    free(surface->curve_length);
    free(surface->corner);
    tm_surface_tree_free(surface->tree);
    *surface = (tm_surface){0};
}
