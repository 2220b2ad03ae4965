/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "peel.h"

#include <string.h>

/* The edge of a tetrahedron between two nodes, 0 … 5. */
static unsigned edge_of(const tm_tet_mesh *mesh, uint32_t t, uint32_t p, uint32_t q)
{
    uint32_t i = tm_tet_corner(mesh, t, p), j = tm_tet_corner(mesh, t, q);
    unsigned e = 0;
    while (!(tm_edge_corner[e][0] == i && tm_edge_corner[e][1] == j) &&
           !(tm_edge_corner[e][0] == j && tm_edge_corner[e][1] == i))
        e++;
    return e;
}

bool tm_peel_is_possible(const tm_tet_mesh *mesh, const tm_star *star, tm_star *around)
{
    uint32_t t = star->tet[0];
    if (mesh->neighbour[t][tm_tet_corner(mesh, t, star->a)] & TM_FACE_BIT ||
        mesh->neighbour[t][tm_tet_corner(mesh, t, star->b)] & TM_FACE_BIT)
        return false;
    unsigned e = edge_of(mesh, t, star->ring[0], star->ring[1]);
    return tm_star_around(mesh, t, e, around) && tm_star_is_free(mesh, around) &&
           !tm_edge_map_get(&mesh->locked, around->a, around->b);
}

void tm_peel(tm_tet_mesh *mesh, const tm_star *star, const tm_face_renewal renewal[2],
             bool first, uint32_t beyond[2])
{
    uint32_t t = star->tet[0];
    /* Of faces abr and abs, which become ras and rsb, the first gets the half face that was
     * across ars, opposite b; the other one that across brs. */
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
