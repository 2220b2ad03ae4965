/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_boundary.h"

#include "../base/array.h"
#include "face_table.h"

#include <stdlib.h>

static double region_of(const tm_mixed_regions *regions, uint32_t half)
{
    return regions->value[regions->stride * regions->origin[half >> TM_FACE_SHIFT]];
}

/* Whether a half face is one of those that are listed. */
static bool is_listed(const tm_mixed_regions *regions, uint32_t half, uint32_t mate)
{
    return half == mate || (regions->value && half < mate && mate != TM_NONE &&
                            region_of(regions, half) != region_of(regions, mate));
}

tm_status tm_mixed_boundary_faces(const tm_mixed_mesh *mesh, uint32_t **face,
                                  size_t *faces, tm_error *error)
{
    return tm_mixed_region_faces(mesh, &(tm_mixed_regions){0}, face, faces, error);
}

tm_status tm_mixed_region_faces(const tm_mixed_mesh *mesh,
                                const tm_mixed_regions *regions, uint32_t **face,
                                size_t *faces, tm_error *error)
{
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .elements = mesh->elements,
                               .start = mesh->start,
                               .item = mesh->item};
    const size_t halves = mesh->elements << TM_FACE_SHIFT;
    size_t room = 0;
    *face = NULL;
    *faces = 0;
    uint32_t *mate;
    tm_status status = tm_face_mates(&mate, &view, error);
    for (uint32_t half = 0; half < halves && status == TM_OK; half++) {
        if (!is_listed(regions, half, mate[half]))
            continue;
        uint32_t *grown = tm_grow(*face, &room, *faces + 1, sizeof *grown);
        if (!grown) {
            status = tm_fail_memory(error);
            break;
        }
        *face = grown;
        grown[(*faces)++] = half;
    }
    free(mate);
    return status;
}
