/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../surface_parts.h"
#include "soup.h"

void tm_mend_turn_outward(tm_block *face, const tm_surface *surface,
                          const tm_polygon_surface *polygons, tm_mended *turned)
{
    for (size_t t = 0; t < surface->triangles && surface->walls; t++) {
        if (surface->side[t][0] != 0 || tm_surface_is_as_given(surface, polygons, t))
            continue;
        uint32_t *v = face->integer + 3 * (size_t)surface->facet[t];
        const uint32_t second = v[1];
        v[1] = v[2];
        v[2] = second;
        if (turned->count == 0)
            tm_mend_count(turned, surface->xyz[surface->triangle[t][0]]);
    }
}
