/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "region_layout.h"

#include "../../base/array.h"

#include <stdlib.h>

void tm_region_lay(tm_region_layout *layout, uint32_t leaf, uint32_t label)
{
    layout->fixed[leaf] = true;
    tm_interior_set_label(layout->interior, layout->lattice.octree, leaf, label);
}

tm_status tm_region_layout_make(tm_region_layout *layout, const tm_octree *octree,
                                const tm_surface *surface, tm_interior *interior,
                                tm_error *error)
{
    *layout =
        (tm_region_layout){.surface = surface,
                           .interior = interior,
                           .history = layout->history,
                           .fixed = calloc(octree->leaves + 1, 1),
                           .taken = calloc(octree->nodes + 1, 1),
                           .sharp = calloc(octree->nodes + 1, 1),
                           .corner_node = tm_new(surface->corners, sizeof(uint32_t))};
    tm_status status =
        layout->fixed && layout->taken && layout->sharp && layout->corner_node
            ? TM_OK
            : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_node_lattice_make(&layout->lattice, octree, error);
    if (status == TM_OK)
        status = tm_walls_find(&layout->walls, surface, error);
    if (status == TM_OK)
        status = tm_wall_sectors_find(&layout->sectors, surface, error);
    if (status == TM_OK)
        status = tm_region_lay_corners(layout, error);
    if (status == TM_OK)
        status = tm_region_lay_lines(layout, error);
    return status;
}

void tm_region_layout_free(tm_region_layout *layout)
{
    tm_node_lattice_free(&layout->lattice);
    tm_walls_free(&layout->walls);
    tm_wall_sectors_free(&layout->sectors);
    free(layout->fixed);
    free(layout->taken);
    free(layout->sharp);
    free(layout->corner_node);
    *layout = (tm_region_layout){0};
}
