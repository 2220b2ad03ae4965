/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of the tetrahedra in memory. */
#include "mesh.h"

#include "../base/array.h"
#include "../geom/space_order.h"

#include <stdlib.h>
#include <string.h>

/* The tetrahedra along the curve, and in place[t] where t comes. */
static bool find_order(const tm_tet_mesh *mesh, uint32_t *order, uint32_t *place)
{
    tm_space space = tm_space_around((const double(*)[3])mesh->xyz, mesh->nodes);
    tm_curve_point *placed = tm_new(mesh->slots, sizeof *placed);
    for (uint32_t t = 0; t < mesh->slots && placed; t++)
        placed[t] =
            (tm_curve_point){tm_space_position(&space, mesh->xyz[mesh->tet[t][0]]), t};
    bool done = placed && tm_space_sort(placed, mesh->slots);
    for (uint32_t k = 0; k < mesh->slots && done; k++) {
        order[k] = placed[k].item;
        place[order[k]] = k;
    }
    free(placed);
    return done;
}

static bool reorder_tets(tm_tet_mesh *mesh, const uint32_t *order, const uint32_t *place)
{
    uint32_t(*tet)[4] = tm_new(mesh->slots, sizeof *tet);
    if (!tet)
        return false;
    for (size_t k = 0; k < mesh->slots; k++)
        memcpy(tet[k], mesh->tet[order[k]], sizeof *tet);
    /* The old list becomes that of the neighbours. */
    uint32_t(*neighbour)[4] = mesh->tet;
    for (size_t k = 0; k < mesh->slots; k++)
        for (int i = 0; i < 4; i++) {
            uint32_t h = mesh->neighbour[order[k]][i];
            neighbour[k][i] = h & TM_FACE_BIT ? h : 4 * place[h / 4] + h % 4;
        }
    free(mesh->neighbour);
    mesh->tet = tet;
    mesh->neighbour = neighbour;
    mesh->slot_room = mesh->slots;
    return true;
}

static bool reorder_regions(tm_tet_mesh *mesh, const uint32_t *order)
{
    size_t width = mesh->regions;
    if (width == 0)
        return true;
    double *region = tm_new(mesh->slots * width, sizeof *region);
    for (size_t k = 0; k < mesh->slots && region; k++)
        memcpy(region + k * width, mesh->region + order[k] * width,
               width * sizeof *region);
    if (region) {
        free(mesh->region);
        mesh->region = region;
    }
    return region;
}

tm_status tm_tet_mesh_sort(tm_tet_mesh *mesh, tm_error *error)
{
    uint32_t *order = tm_new(mesh->slots, sizeof *order);
    uint32_t *place = tm_new(mesh->slots, sizeof *place);
    bool done = order && place && find_order(mesh, order, place) &&
                reorder_regions(mesh, order) && reorder_tets(mesh, order, place);
    for (size_t f = 0; f < mesh->faces && done; f++)
        for (int s = 0; s < 2; s++) {
            uint32_t *h = &mesh->face[f].side[s];
            *h = *h == TM_NONE ? TM_NONE : 4 * place[*h / 4] + *h % 4;
        }
    free(order);
    free(place);
    return done ? TM_OK : tm_fail_memory(error);
}
