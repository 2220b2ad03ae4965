/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shells within shells: which region each is around. */
#include "surface_parts.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "surface_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_surface_shell_volumes(const tm_surface *surface, double *volume)
{
    memset(volume, 0, surface->components * sizeof *volume);
    for (size_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        volume[surface->shell[t]] +=
            tm_tet_volume(surface->xyz[surface->triangle[0][0]], surface->xyz[v[0]],
                          surface->xyz[v[1]], surface->xyz[v[2]]);
    }
}

/* The innermost shell around a point: the smallest; TM_NONE where there is none. */
static uint32_t shell_around(const tm_surface *surface, const double *volume,
                             const double point[3])
{
    uint32_t least = TM_NONE;
    for (uint32_t s = 0; s < surface->components; s++)
        if (tm_surface_is_within(surface, s, point) &&
            (least == TM_NONE || fabs(volume[s]) < fabs(volume[least])))
            least = s;
    return least;
}

/* The numbers of the file; those that have none get the next whole ones. */
static tm_status number_shells(tm_surface *surface, const tm_polygon_surface *polygons,
                               const double *volume, tm_error *error)
{
    double next = 0;
    surface->region = tm_new(surface->components, sizeof *surface->region);
    if (!surface->region)
        return tm_fail_memory(error);
    for (size_t s = 0; s < surface->components; s++)
        surface->region[s] = NAN;
    for (size_t r = 0; r < polygons->regions; r++) {
        const tm_region *region = &polygons->region[r];
        const double *p = region->point;
        const uint32_t s = shell_around(surface, volume, p);
        if (s == TM_NONE)
            return tm_fail(error, TM_ERROR_INPUT,
                           "region %zu, at (%g, %g, %g), is outside", r + 1, p[0], p[1],
                           p[2]);
        if (!isnan(surface->region[s]))
            surface->repeated_regions++;
        else
            surface->region[s] = region->attribute;
        next = fmax(next, floor(region->attribute));
    }
    for (size_t s = 0; s < surface->components; s++)
        if (isnan(surface->region[s]))
            surface->region[s] = next += 1;
    return TM_OK;
}

static tm_status find_holes(tm_surface *surface, const tm_polygon_surface *polygons,
                            const double *volume, tm_error *error)
{
    surface->hole = tm_new(polygons->holes, sizeof *surface->hole);
    if (!surface->hole)
        return tm_fail_memory(error);
    for (size_t h = 0; h < polygons->holes; h++) {
        const uint32_t s = shell_around(surface, volume, polygons->hole[h]);
        if (s != TM_NONE && volume[s] < 0)
            memcpy(surface->hole[surface->holes++], polygons->hole[h],
                   sizeof *surface->hole);
    }
    return TM_OK;
}

tm_status tm_surface_find_regions(tm_surface *surface, const tm_polygon_surface *polygons,
                                  tm_error *error)
{
    double *volume = tm_new(surface->components, sizeof *volume);
    if (!volume)
        return tm_fail_memory(error);
    tm_surface_shell_volumes(surface, volume);
    tm_status status = TM_OK;
    surface->regions = true;
    if (polygons->regions > 0)
        status = number_shells(surface, polygons, volume, error);
    if (status == TM_OK && polygons->holes > 0)
        status = find_holes(surface, polygons, volume, error);
    free(volume);
    return status;
}
