/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_set.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

tm_status tm_tet_mesh_add_set(tm_tet_mesh *mesh, const bool *in_set, tm_error *error)
{
    const size_t before = mesh->regions, width = before + 1;
    double *region = mesh->slot_room <= SIZE_MAX / width
                         ? tm_new(mesh->slot_room * width, sizeof *region)
                         : NULL;
    if (!region)
        return tm_fail_memory(error);
    for (size_t t = 0; t < mesh->slots; t++) {
        if (before > 0)
            memcpy(region + t * width, mesh->region + t * before,
                   before * sizeof *region);
        region[t * width + before] = in_set[t];
    }
    free(mesh->region);
    mesh->region = region;
    mesh->regions = width;
    mesh->has_set = true;
    return TM_OK;
}

void tm_tet_mesh_remove_set(tm_tet_mesh *mesh)
{
    if (!mesh->has_set)
        return;
    const size_t width = mesh->regions, after = width - 1;
    for (size_t t = 0; t < mesh->slots && after > 0; t++)
        memmove(mesh->region + t * after, mesh->region + t * width,
                after * sizeof *mesh->region);
    if (after == 0) {
        free(mesh->region);
        mesh->region = NULL;
    }
    mesh->regions = after;
    mesh->has_set = false;
}

size_t tm_tet_mesh_count_set(const tm_tet_mesh *mesh)
{
    size_t count = 0;
    for (uint32_t t = 0; t < mesh->slots; t++)
        count += tm_tet_lives(mesh, t) && tm_tet_is_in_set(mesh, t);
    return count;
}

void tm_tet_mesh_spread_set(tm_tet_mesh *mesh, const uint32_t *tet, size_t count)
{
    bool any = false;
    if (!mesh->has_set)
        return;
    for (size_t i = 0; i < count; i++)
        any |= tm_tet_is_in_set(mesh, tet[i]);
    for (size_t i = 0; i < count && any; i++)
        mesh->region[(tet[i] + (size_t)1) * mesh->regions - 1] = 1;
}
