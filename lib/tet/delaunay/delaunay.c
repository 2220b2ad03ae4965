/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "delaunay.h"

#include "../../geom/predicates.h"

/* Whether the sphere of t, if it has one, holds node v strictly inside. */
static bool holds(const tm_tet_mesh *mesh, uint32_t t, uint32_t v)
{
    const uint32_t *n = mesh->tet[t];
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]];
    const double *c = mesh->xyz[n[2]], *d = mesh->xyz[n[3]];
    if (mesh->flat > 0 && tm_orient3d(a, b, c, d) == 0)
        return false;
    return tm_insphere(a, b, c, d, mesh->xyz[v]) > 0;
}

size_t tm_tet_mesh_not_delaunay(const tm_tet_mesh *mesh)
{
    size_t wrong = 0;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        if (!tm_tet_lives(mesh, t))
            continue;
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t g = mesh->neighbour[t][i];
            if (g & TM_FACE_BIT || g / 4 < t)
                continue;
            /* Of two positive tetrahedra, one holds what the other does. */
            wrong += holds(mesh, t, mesh->tet[g / 4][g % 4]) ||
                     (mesh->flat > 0 && holds(mesh, g / 4, mesh->tet[t][i]));
        }
    }
    return wrong;
}
