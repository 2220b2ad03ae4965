/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers that a file gives to regions. */
#include "surface_parts.h"

#include "../base/array.h"

#include <math.h>

tm_status tm_surface_number_regions(tm_surface *surface,
                                    const tm_polygon_surface *polygons, size_t regions,
                                    tm_region_finder *at, const void *context,
                                    tm_error *error)
{
    double next = 0;
    surface->region = tm_new(regions, sizeof *surface->region);
    if (!surface->region)
        return tm_fail_memory(error);
    for (size_t r = 0; r < regions; r++)
        surface->region[r] = NAN;
    for (size_t i = 0; i < polygons->regions; i++) {
        const tm_region *region = &polygons->region[i];
        const double *p = region->point;
        const uint32_t r = at(surface, p, context);
        if (r == TM_NONE)
            return tm_fail(error, TM_ERROR_INPUT,
                           "region %zu, at (%g, %g, %g), is outside", i + 1, p[0], p[1],
                           p[2]);
        if (!isnan(surface->region[r]))
            surface->repeated_regions++;
        else
            surface->region[r] = region->attribute;
        next = fmax(next, floor(region->attribute));
    }
    for (size_t r = 0; r < regions; r++)
        if (isnan(surface->region[r]))
            surface->region[r] = next += 1;
    return TM_OK;
}
