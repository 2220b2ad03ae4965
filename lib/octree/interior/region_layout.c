/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "region_layout.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_region_lay(tm_region_layout *layout, uint32_t leaf, uint32_t label)
{
    layout->fixed[leaf] = true;
    tm_interior_set_label(layout->interior, layout->lattice.octree, leaf, label);
}

static tm_status allocate(tm_region_layout *layout, const tm_octree *octree,
                          tm_error *error)
{
    const tm_surface *s = layout->surface;
    layout->corner_at = tm_new(s->nodes, sizeof *layout->corner_at);
    layout->history = calloc(octree->nodes + 1, sizeof *layout->history);
    layout->line = calloc(s->curves + 1, sizeof *layout->line);
    layout->fixed = tm_new(octree->leaves, sizeof *layout->fixed);
    layout->taken = tm_new(octree->nodes, sizeof *layout->taken);
    layout->sharp = tm_new(octree->nodes, sizeof *layout->sharp);
    layout->corner_node = tm_new(s->corners, sizeof *layout->corner_node);
    return layout->corner_at && layout->history && layout->line && layout->fixed &&
                   layout->taken && layout->sharp && layout->corner_node
               ? TM_OK
               : tm_fail_memory(error);
}

tm_status tm_region_layout_make(tm_region_layout *layout, const tm_octree *octree,
                                const tm_surface *surface, tm_interior *interior,
                                tm_error *error)
{
    *layout = (tm_region_layout){.surface = surface, .interior = interior};
    tm_status status = allocate(layout, octree, error);
    if (status == TM_OK)
        status = tm_node_lattice_make(&layout->lattice, octree, error);
    if (status == TM_OK)
        status = tm_walls_find(&layout->walls, surface, error);
    if (status == TM_OK)
        status = tm_wall_sectors_find(&layout->sectors, surface, error);
    for (unsigned i = 0; status == TM_OK && i < 2; i++)
        status = tm_line_patterns_make(&layout->patterns[i], 3 + i, error);
    if (status != TM_OK)
        return status;
    for (size_t v = 0; v < surface->nodes; v++)
        layout->corner_at[v] = TM_NONE;
    for (uint32_t k = 0; k < surface->corners; k++)
        layout->corner_at[surface->corner[k]] = k;
    return TM_OK;
}

tm_status tm_region_lay_out(tm_region_layout *layout, tm_error *error)
{
    const tm_octree *octree = layout->lattice.octree;
    memset(layout->fixed, 0, octree->leaves * sizeof *layout->fixed);
    memset(layout->taken, 0, octree->nodes * sizeof *layout->taken);
    memset(layout->sharp, 0, octree->nodes * sizeof *layout->sharp);
    layout->lost = 0;
    const tm_status status = tm_region_lay_corners(layout, error);
    return status == TM_OK ? tm_region_lay_lines(layout, error) : status;
}

void tm_region_layout_free(tm_region_layout *layout)
{
    tm_node_lattice_free(&layout->lattice);
    tm_walls_free(&layout->walls);
    tm_wall_sectors_free(&layout->sectors);
    for (int i = 0; i < 2; i++)
        tm_line_patterns_free(&layout->patterns[i]);
    free(layout->corner_at);
    free(layout->history);
    for (size_t c = 0; layout->line && c < layout->surface->curves; c++) {
        free(layout->line[c].node);
        free(layout->line[c].state);
    }
    free(layout->line);
    free(layout->fixed);
    free(layout->taken);
    free(layout->sharp);
    free(layout->corner_node);
    *layout = (tm_region_layout){0};
}
