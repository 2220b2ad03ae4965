/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of a share of an octree: each rank has that of its leaves and of the ghosts
 * around them. */
#include "octree_mesh_ranks.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../ranks/ranks.h"
#include "../../surface/surface_tree.h"
#include "octree_mesh_parts.h"
#include "skin.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_octree_mesh *mesh;
    const tm_octree_share *share;
    tm_surface *surface;
    tm_boundary_share boundary;
} maker;

static tm_boundary_view view_of(const maker *m)
{
    return (tm_boundary_view){.octree = &m->share->octree,
                              .boundary = &m->mesh->boundary,
                              .share = m->share,
                              .nodes = m->boundary.nodes,
                              .faces = m->boundary.faces};
}

/* The pieces of the boundary, and its Euler number. */
static tm_status measure_boundary(const maker *m, tm_boundary_pieces *pieces,
                                  tm_error *error)
{
    const tm_boundary_share *s = &m->boundary;
    tm_octree_mesh_report *r = &m->mesh->report;
    const tm_boundary_view view = view_of(m);
    size_t half_edges = 0;
    for (size_t f = s->faces.first; f < s->faces.past; f++)
        half_edges += tm_boundary_face_corners(&m->mesh->boundary, f);
    tm_ranks_sum(&half_edges, 1);
    const tm_status status = tm_boundary_pieces_find(pieces, &view, error);
    r->components = r->outer_components = pieces->count;
    r->euler = r->outer_euler =
        (int64_t)(s->nodes.all + s->faces.all) - (int64_t)(half_edges / 2);
    return status;
}

static tm_status find_boundary_once(maker *m, tm_boundary_pieces *pieces, tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    tm_interior_boundary_free(&mesh->boundary);
    tm_boundary_share_free(&m->boundary);
    tm_boundary_pieces_free(pieces);
    free(mesh->at);
    free(mesh->off_surface);
    mesh->at = NULL;
    mesh->off_surface = NULL;
    tm_status status =
        tm_interior_boundary_find(&mesh->boundary, &m->share->octree, mesh->part, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_boundary_share_find(&m->boundary, m->share, &mesh->boundary, error);
    if (status == TM_OK)
        status = measure_boundary(m, pieces, error);
    return status == TM_OK ? tm_octree_mesh_find_closest_on_ranks(mesh, m->boundary.nodes,
                                                                  m->surface, error)
                           : status;
}

/* As find_boundary() of octree_mesh.c, but for what is in hollows. */
static tm_status find_boundary(maker *m, bool *alone, tm_error *error)
{
    tm_boundary_pieces pieces = {0};
    bool changed = false;
    tm_status status = find_boundary_once(m, &pieces, error);
    if (status == TM_OK && m->mesh->report.components > m->surface->components) {
        const tm_boundary_view view = view_of(m);
        status = tm_spurious_components_remove(m->mesh->part, &view, &pieces, m->surface,
                                               m->mesh->at, &changed, error);
    }
    if (status == TM_OK && changed)
        status = find_boundary_once(m, &pieces, error);
    for (size_t i = 0; status == TM_OK && i < pieces.count; i++)
        *alone |= m->surface->regions && pieces.piece[i].volume < 0;
    tm_boundary_pieces_free(&pieces);
    return status;
}

/* The boundary node here that has that number, or TM_NONE. */
static uint32_t node_here(const maker *m, uint32_t number)
{
    const size_t nodes = m->mesh->boundary.nodes;
    const size_t s = tm_first_not_below(m->boundary.number, nodes, number);
    return s < nodes && m->boundary.number[s] == number ? (uint32_t)s : TM_NONE;
}

/* This rank's part of the features of the whole boundary, and how that is cut. */
static void take_features(const maker *m, const tm_feature *of,
                          const tm_interior_boundary *skin)
{
    tm_feature *to = &m->mesh->feature;
    tm_interior_boundary *b = &m->mesh->boundary;
    for (size_t s = 0; s < b->nodes; s++) {
        const uint32_t n = m->boundary.number[s];
        to->kind[s] = of->kind[n];
        to->of[s] = of->of[n];
        for (int i = 0; i < 2; i++)
            to->along[s][i] =
                of->along[n][i] == TM_NONE ? TM_NONE : node_here(m, of->along[n][i]);
    }
    for (size_t f = 0; f < b->faces; f++)
        b->cut[f] = skin->cut[m->boundary.face_number[f]];
    to->corners_lost = of->corners_lost;
    to->curves_lost = of->curves_lost;
    to->lost = of->lost;
}

/* They are found on all ranks alike, each of which changes the surface's patches. */
static tm_status find_features(maker *m, tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    tm_interior_boundary skin = {0}, none = {.nodes = mesh->boundary.nodes};
    tm_surface bare = {0};
    tm_feature feature = {0};
    void *at = NULL;
    tm_status status = tm_feature_find(&mesh->feature, &none, &bare, NULL, error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK || m->surface->corners + m->surface->curves == 0)
        return status;
    status = tm_skin_gather(&skin, &m->boundary, &mesh->boundary, true, error);
    if (status == TM_OK)
        status = tm_own_gather(m->boundary.nodes, mesh->at, sizeof *mesh->at, true, &at,
                               error);
    if (status == TM_OK)
        status = tm_ranks_agree(tm_feature_find(&feature, &skin, m->surface, at, error),
                                error);
    if (status == TM_OK)
        take_features(m, &feature, &skin);
    tm_feature_free(&feature);
    tm_interior_boundary_free(&skin);
    free(at);
    return status;
}

static tm_status make_elements(const maker *m, const tm_progress *progress,
                               tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    tm_progress_stage(progress, "assembling elements");
    tm_status status = tm_assemble(&mesh->assembly, &m->share->octree, mesh->part, 1,
                                   &mesh->boundary, error);
    mesh->share = calloc(1, sizeof *mesh->share);
    if (status == TM_OK && !mesh->share)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_mesh_share_find(mesh->share, m->share, &mesh->assembly,
                                    &mesh->boundary, error);
    tm_progress_stage(progress, "projecting the layer");
    if (status == TM_OK)
        status = tm_project_layer(&mesh->assembly, &mesh->boundary, &mesh->feature,
                                  m->surface, mesh->at, mesh->share, error);
    if (status == TM_OK)
        status = tm_untangle_layer(mesh, &m->share->octree, m->surface, progress, error);
    return status;
}

static tm_status make(maker *m, const tm_progress *progress, bool *alone, tm_error *error)
{
    *alone = false;
    if (m->mesh->part->count == 0)
        return tm_octree_mesh_fail_empty(error);
    tm_progress_stage(progress, "finding the interior boundary");
    tm_status status = find_boundary(m, alone, error);
    if (status != TM_OK || *alone)
        return status;
    tm_progress_stage(progress, "matching features");
    status = find_features(m, error);
    if (status == TM_OK)
        status = make_elements(m, progress, error);
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_octree_mesh_complete_report(m->mesh, &m->share->octree, m->surface, error),
            error);
    return status;
}

tm_status tm_octree_mesh_make_on_ranks(tm_octree_mesh *mesh, const tm_octree_share *share,
                                       tm_interior *interior, tm_surface *surface,
                                       const tm_progress *progress, bool *alone,
                                       tm_error *error)
{
    maker m = {.mesh = mesh, .share = share, .surface = surface};
    const size_t bytes = surface->triangles * sizeof *surface->patch;
    uint32_t *patch = tm_new(surface->triangles, sizeof *patch);
    *mesh = (tm_octree_mesh){.part = calloc(1, sizeof *mesh->part)};
    tm_status status =
        tm_ranks_agree(mesh->part && patch ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK) {
        mesh->parts = 1;
        *mesh->part = *interior;
        *interior = (tm_interior){0};
        memcpy(patch, surface->patch, bytes);
        status = make(&m, progress, alone, error);
        memcpy(surface->patch, patch, bytes);
        tm_surface_tree_refresh(surface);
    }
    free(patch);
    tm_boundary_share_free(&m.boundary);
    return status;
}
