/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The invariants of a tetrahedral mesh, one after the other. */
#include "mesh.h"

#include "../geom/predicates.h"

#include <stdlib.h>

#define FAIL(...) tm_fail(error, TM_ERROR_INTERNAL, __VA_ARGS__)

static tm_status check_counts(const tm_tet_mesh *mesh, tm_error *error)
{
    size_t living = 0, dead = 0;
    for (size_t t = 0; t < mesh->slots; t++)
        living += tm_tet_lives(mesh, (uint32_t)t);
    if (living != mesh->tets)
        return FAIL("%zu tetrahedra live, not %zu", living, mesh->tets);
    for (uint32_t t = mesh->first_dead; t != TM_NONE; t = mesh->tet[t][1]) {
        if (t >= mesh->slots || tm_tet_lives(mesh, t) || dead > mesh->slots)
            return FAIL("the list of dead tetrahedra is broken at %u", t);
        dead++;
    }
    if (living + dead != mesh->slots)
        return FAIL("%zu dead tetrahedra, %zu in their list", mesh->slots - living, dead);
    return TM_OK;
}

static bool has_node(const uint32_t *n, size_t count, uint32_t v)
{
    for (size_t i = 0; i < count; i++)
        if (n[i] == v)
            return true;
    return false;
}

/* Whether the half face has these three nodes. */
static bool is_face(const tm_tet_mesh *mesh, uint32_t half, const uint32_t node[3])
{
    for (uint32_t i = 0; i < 4; i++)
        if (i != half % 4 && !has_node(node, 3, mesh->tet[half / 4][i]))
            return false;
    return true;
}

static tm_status check_half(const tm_tet_mesh *mesh, uint32_t h, tm_error *error)
{
    uint32_t across = mesh->neighbour[h / 4][h % 4];
    if (across & TM_FACE_BIT) {
        uint32_t f = across & ~TM_FACE_BIT;
        if (f >= mesh->faces)
            return FAIL("half face %u: face %u of %zu", h, f, mesh->faces);
        const tm_constrained_face *face = &mesh->face[f];
        if ((face->side[0] != h && face->side[1] != h) || !is_face(mesh, h, face->node))
            return FAIL("half face %u: face %u is not its own", h, f);
        return TM_OK;
    }
    if (across / 4 >= mesh->slots || !tm_tet_lives(mesh, across / 4))
        return FAIL("half face %u: neighbour %u does not live", h, across);
    if (mesh->neighbour[across / 4][across % 4] != h)
        return FAIL("half face %u: neighbour %u does not know it", h, across);
    uint32_t node[3];
    for (uint32_t i = 0, k = 0; i < 4; i++)
        if (i != h % 4)
            node[k++] = mesh->tet[h / 4][i];
    if (!is_face(mesh, across, node))
        return FAIL("half faces %u and %u have different nodes", h, across);
    for (size_t r = 0; r < mesh->regions; r++)
        if (mesh->region[h / 4 * mesh->regions + r] !=
            mesh->region[across / 4 * mesh->regions + r])
            return FAIL("half face %u is between regions and not kept", h);
    return TM_OK;
}

static tm_status check_tets(const tm_tet_mesh *mesh, tm_error *error)
{
    size_t flat = 0;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        if (!tm_tet_lives(mesh, t))
            continue;
        const uint32_t *n = mesh->tet[t];
        for (size_t i = 0; i < 4; i++)
            if (n[i] >= mesh->nodes || has_node(n, i, n[i]))
                return FAIL("tetrahedron %u: node %u is out of range or twice", t, n[i]);
        int sign = tm_orient3d(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                               mesh->xyz[n[3]]);
        flat += sign == 0;
        if (sign < 0 || flat > mesh->flat)
            return FAIL("tetrahedron %u is %s", t, sign < 0 ? "inverted" : "flat");
        for (uint32_t i = 0; i < 4; i++) {
            tm_status status = check_half(mesh, 4 * t + i, error);
            if (status != TM_OK)
                return status;
        }
    }
    return TM_OK;
}

static tm_status check_faces(const tm_tet_mesh *mesh, tm_error *error)
{
    for (size_t f = 0; f < mesh->faces; f++)
        for (int s = 0; s < 2; s++) {
            uint32_t h = mesh->face[f].side[s];
            if (h != TM_NONE && (h / 4 >= mesh->slots || !tm_tet_lives(mesh, h / 4) ||
                                 mesh->neighbour[h / 4][h % 4] != (f | TM_FACE_BIT)))
                return FAIL("face %zu: its side %u does not know it", f, h);
        }
    return TM_OK;
}

static tm_status check_edges(const tm_tet_mesh *mesh, tm_error *error)
{
    size_t listed = 0;
    for (size_t e = 0; e < mesh->edges; e++) {
        const tm_marked_edge *edge = &mesh->edge[e];
        const tm_marked_edge *found =
            tm_tet_mesh_edge(mesh, edge->node[0], edge->node[1]);
        listed += !edge->gone;
        if (edge->gone ? found == edge : found != edge)
            return FAIL("edge %zu is not where it should be in the table", e);
    }
    if (listed != mesh->edge_of.count)
        return FAIL("%zu edges, %zu in the table", listed, mesh->edge_of.count);
    return TM_OK;
}

tm_status tm_tet_mesh_check(const tm_tet_mesh *mesh, tm_error *error)
{
    tm_status status = check_counts(mesh, error);
    if (status == TM_OK)
        status = check_tets(mesh, error);
    if (status == TM_OK)
        status = check_faces(mesh, error);
    if (status == TM_OK)
        status = check_edges(mesh, error);
    return status;
}
