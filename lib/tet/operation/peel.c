/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "peel.h"

#include <string.h>

bool tm_peel_is_possible(const tm_tet_mesh *mesh, const tm_star *star, tm_star *around)
{
    uint32_t t = star->tet[0];
    if (mesh->neighbour[t][tm_tet_corner(mesh, t, star->a)] & TM_FACE_BIT ||
        mesh->neighbour[t][tm_tet_corner(mesh, t, star->b)] & TM_FACE_BIT)
        return false;
    return tm_star_between(mesh, t, star->ring[0], star->ring[1], around) &&
           tm_star_is_free(mesh, around) &&
           !tm_edge_map_get(&mesh->locked, around->a, around->b);
}

void tm_peel(tm_tet_mesh *mesh, const tm_star *star, const tm_face_renewal renewal[2],
             bool first, uint32_t beyond[2])
{
    uint32_t t = star->tet[0];
    /* Of faces abr and abs, which become ras and rsb, the first gets the half face that
     * was across ars, opposite b; the other one that across brs. */
    for (int i = 0; i < 2; i++) {
        uint32_t old = 4 * t + tm_tet_corner(mesh, t, star->ring[1 - i]);
        uint32_t half = mesh->neighbour[t][tm_tet_corner(mesh, t, i ? star->a : star->b)];
        tm_constrained_face *face = &mesh->face[renewal[i].face];
        if (first)
            memcpy(face->node, renewal[i].node, sizeof face->node);
        face->side[face->side[0] != old] = half;
        mesh->neighbour[half / 4][half % 4] = renewal[i].face | TM_FACE_BIT;
        beyond[i] = half / 4;
    }
    tm_tet_mesh_delete_tet(mesh, t);
    if (mesh->edge_of.count > 0)
        tm_tet_mesh_forget_edge(mesh, star->a, star->b);
}

bool tm_peel_face_is_possible(const tm_tet_mesh *mesh, uint32_t t, uint32_t i)
{
    uint32_t f = mesh->neighbour[t][i];
    if (!(f & TM_FACE_BIT) || tm_tet_across(mesh, t, i) != TM_NONE)
        return false;
    for (uint32_t k = 0; k < 4; k++)
        if (k != i && mesh->neighbour[t][k] & TM_FACE_BIT)
            return false;
    return true;
}

void tm_peel_face(tm_tet_mesh *mesh, uint32_t t, uint32_t i, uint32_t face[3],
                  uint32_t beyond[3])
{
    uint32_t f = mesh->neighbour[t][i] & ~TM_FACE_BIT, made = 0;
    const tm_constrained_face old = mesh->face[f];
    const uint32_t apex = mesh->tet[t][i];
    int side = old.side[0] != 4 * t + i;
    for (uint32_t k = 0; k < 4; k++) {
        if (k == i)
            continue;
        uint32_t half = mesh->neighbour[t][k];
        uint32_t g = made == 0 ? f : (uint32_t)mesh->faces++;
        mesh->face[g] = old;
        for (int n = 0; n < 3; n++)
            if (old.node[n] == mesh->tet[t][k])
                mesh->face[g].node[n] = apex;
        mesh->face[g].side[side] = half;
        mesh->neighbour[half / 4][half % 4] = g | TM_FACE_BIT;
        face[made] = g;
        beyond[made++] = half / 4;
    }
    if (mesh->node_marker)
        mesh->node_marker[apex] = old.marker;
    tm_tet_mesh_delete_tet(mesh, t);
}
