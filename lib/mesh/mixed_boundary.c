/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_boundary.h"

#include "../base/array.h"
#include "face_table.h"

#include <stdlib.h>

tm_status tm_mixed_boundary_faces(const tm_mixed_mesh *mesh, uint32_t **face,
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
        if (mate[half] != half)
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
