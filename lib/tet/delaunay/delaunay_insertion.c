/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "delaunay_insertion.h"

#include "../../base/array.h"
#include "../mesh_measure.h"
#include "../operation/star_insertion.h"

#include <stdlib.h>
#include <string.h>

tm_delaunay tm_delaunay_for(const tm_tet_mesh *mesh)
{
    return (tm_delaunay){.cavity = {.flatness = tm_facet_flatness(mesh)}};
}

void tm_delaunay_free(tm_delaunay *d)
{
    tm_delaunay_cavity_free(&d->cavity);
    free(d->created);
    free(d->region);
    *d = (tm_delaunay){0};
}

static bool reserve(tm_delaunay *d, const tm_tet_mesh *mesh, size_t tets)
{
    uint32_t *created = tm_grow(d->created, &d->created_room, tets, sizeof *created);
    d->created = created ? created : d->created;
    double *region =
        tm_grow(d->region, &d->region_room, tets * mesh->regions, sizeof *region);
    d->region = region ? region : d->region;
    return created && region;
}

/* Forgets the edges of .edge that go with the cavity. */
static void forget_edges(tm_tet_mesh *mesh, const tm_delaunay_cavity *cavity)
{
    for (size_t k = cavity->ball; k < cavity->size && mesh->edge_of.count > 0; k++) {
        const uint32_t *n = mesh->tet[cavity->tet[k]];
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++)
                if (!tm_edge_map_get(&cavity->side, n[i], n[j]))
                    tm_tet_mesh_forget_edge(mesh, n[i], n[j]);
    }
}

/* The slots of the new tetrahedra, each with the region of what was behind its face. */
static void take_slots(tm_tet_mesh *mesh, tm_delaunay *d)
{
    const tm_delaunay_cavity *cavity = &d->cavity;
    size_t width = mesh->regions;
    for (size_t k = 0; k < cavity->faces && width > 0; k++)
        memcpy(d->region + k * width, mesh->region + cavity->face[k].half / 4 * width,
               width * sizeof *d->region);
    for (size_t k = 0; k < cavity->faces; k++) {
        uint32_t t = k < cavity->size ? cavity->tet[k] : tm_tet_mesh_new_tet(mesh);
        d->created[k] = t;
        if (width > 0)
            memcpy(mesh->region + t * width, d->region + k * width,
                   width * sizeof *d->region);
    }
    for (size_t k = cavity->faces; k < cavity->size; k++)
        tm_tet_mesh_delete_tet(mesh, cavity->tet[k]);
    d->made = cavity->faces;
}

/* Gives the open constrained faces their nodes; their sides are to come. */
static void renew_constrained(tm_tet_mesh *mesh, const tm_delaunay_cavity *cavity)
{
    for (size_t k = 0; k < cavity->constrained_count; k++) {
        tm_constrained_face *face = &mesh->face[cavity->constrained[k].face];
        if (!cavity->constrained[k].open)
            continue;
        memcpy(face->node, cavity->constrained[k].node, sizeof face->node);
        face->side[0] = face->side[1] = TM_NONE;
    }
}

/* Joins the node to the faces of its cavity. */
static void fill(tm_tet_mesh *mesh, tm_delaunay *d)
{
    const tm_delaunay_cavity *cavity = &d->cavity;
    renew_constrained(mesh, cavity);
    for (size_t k = 0; k < cavity->faces; k++) {
        const tm_delaunay_face *face = &cavity->face[k];
        uint32_t t = d->created[k];
        memcpy(mesh->tet[t], face->node, sizeof face->node);
        mesh->tet[t][3] = cavity->node;
        tm_tet_replace_half(mesh, 4 * t + 3, face->half, face->beyond);
        for (uint32_t i = 0; i < 3; i++) {
            uint32_t partner = face->partner[i], half = 4 * t + i;
            if (!(partner & TM_FACE_BIT)) {
                mesh->neighbour[t][i] = 4 * d->created[partner / 4] + partner % 4;
                continue;
            }
            uint32_t f = cavity->constrained[partner & ~TM_FACE_BIT].face;
            tm_constrained_face *constrained = &mesh->face[f];
            constrained->side[constrained->side[0] != TM_NONE] = half;
            mesh->neighbour[t][i] = f | TM_FACE_BIT;
        }
    }
}

tm_status tm_delaunay_foresee(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                              tm_delaunay *d, bool *is_whole, tm_error *error)
{
    *is_whole = false;
    tm_status status = tm_tet_mesh_reserve(mesh, 1, 0, 0, 0, error);
    if (status != TM_OK)
        return status;
    memcpy(mesh->xyz[mesh->nodes], p, sizeof mesh->xyz[0]); /* no node yet */
    if (!tm_delaunay_cavity_foresee(&d->cavity, mesh, (uint32_t)mesh->nodes, star))
        return tm_fail_memory(error);
    *is_whole =
        !d->cavity.is_cut_back && tm_delaunay_cavity_is_delaunay(&d->cavity, mesh);
    d->cavity.report.refused += !*is_whole;
    return TM_OK;
}

/* The node that tm_star_insert() put in the place of b in the star's first tetrahedron.
 */
static uint32_t inserted_node(const tm_tet_mesh *mesh, const tm_star *star,
                              const uint32_t *created)
{
    const uint32_t *n = mesh->tet[created[0]];
    return n[0] ^ n[1] ^ n[2] ^ n[3] ^ star->a ^ star->ring[0] ^ star->ring[1];
}

tm_status tm_delaunay_insert(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                             tm_delaunay *d, tm_error *error)
{
    size_t ball = 2 * star->size;
    if (!reserve(d, mesh, ball))
        return tm_fail_memory(error);
    tm_status status = tm_star_insert(mesh, star, p, true, d->created, error);
    d->made = status == TM_OK ? ball : 0;
    if (status != TM_OK)
        return status;
    const tm_delaunay_cavity *cavity = &d->cavity;
    uint32_t node = inserted_node(mesh, star, d->created);
    if (!tm_delaunay_cavity_find(&d->cavity, mesh, node, d->created, ball))
        return tm_fail_memory(error);
    tm_delaunay_cavity_count(&d->cavity, mesh);
    if (cavity->size == ball)
        return TM_OK;
    size_t more = cavity->faces > cavity->size ? cavity->faces - cavity->size : 0;
    if (!reserve(d, mesh, cavity->faces))
        return tm_fail_memory(error);
    status = tm_tet_mesh_reserve(mesh, 0, more, 0, 0, error);
    if (status != TM_OK)
        return status;
    forget_edges(mesh, cavity);
    take_slots(mesh, d);
    fill(mesh, d);
    return TM_OK;
}
