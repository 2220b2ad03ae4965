/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_stream.h"

#include "../../base/array.h"
#include "../forest/octree_stream.h"

#include <stdlib.h>
#include <string.h>

static tm_status nodes_to_stream(tm_octree_mesh *m, tm_stream *stream, tm_error *error)
{
    tm_block *node = tm_stream_find(stream, ".node");
    const tm_assembly *a = &m->assembly;
    node->attribute = calloc(a->mesh.nodes, sizeof *node->attribute);
    if (!node->attribute)
        return tm_fail_memory(error);
    for (size_t s = 0; s < m->boundary.nodes; s++) {
        const double class = TM_NODE_ON_PATCH + m->feature.kind[s];
        node->attribute[a->outer + s] = m->off_surface[s] ? -class : class;
    }
    node->count = a->mesh.nodes;
    node->attributes = 1;
    node->real = (double *)m->assembly.mesh.xyz;
    m->assembly.mesh.xyz = NULL;
    return TM_OK;
}

/* The region of its leaf, where there are some, then the level. */
static tm_status attributes_to_stream(const tm_octree_mesh *m, const tm_octree *octree,
                                      const tm_surface *surface, bool levels,
                                      tm_block *mix, tm_error *error)
{
    const size_t k = (m->region ? 1u : 0u) + (levels ? 1u : 0u);
    mix->attribute = tm_new(k * mix->count, sizeof *mix->attribute);
    if (!mix->attribute)
        return tm_fail_memory(error);
    mix->attributes = k;
    for (size_t l = 0; l < octree->leaves; l++)
        for (size_t e = m->assembly.first[l]; e < m->assembly.first[l + 1]; e++) {
            if (levels)
                mix->attribute[k * e + k - 1] = octree->leaf[l].level;
            if (m->region)
                mix->attribute[k * e] =
                    surface->region ? surface->region[m->region[l] - 1] : m->region[l];
        }
    return TM_OK;
}

static tm_status elements_to_stream(tm_octree_mesh *m, const tm_octree *octree,
                                    const tm_surface *surface, bool levels,
                                    tm_stream *stream, tm_error *error)
{
    tm_block *mix = tm_stream_add(stream, ".mix");
    if (!mix)
        return tm_fail_memory(error);
    tm_mixed_mesh *mesh = &m->assembly.mesh;
    mix->count = mesh->elements;
    if (levels || m->region) {
        const tm_status status =
            attributes_to_stream(m, octree, surface, levels, mix, error);
        if (status != TM_OK)
            return status;
    }
    mix->start = mesh->start;
    mix->item = mesh->item;
    mesh->start = NULL;
    mesh->item = NULL;
    return TM_OK;
}

/* Where rows of .facet go. */
typedef struct {
    tm_block *block;
    size_t facets, items;
} facet_writer;

/* The marker of a polygon of the boundary: that of the triangle closest to its middle. */
static int32_t marker_of(const tm_octree_mesh *m, const tm_surface *surface, unsigned k,
                         const uint32_t *corner)
{
    const double(*xyz)[3] = (const double(*)[3])m->assembly.mesh.xyz + m->assembly.outer;
    double middle[3] = {0, 0, 0};
    for (unsigned c = 0; c < k; c++)
        for (int i = 0; i < 3; i++)
            middle[i] += xyz[corner[c]][i] / k;
    tm_surface_point at = {.triangle = m->at[corner[0]].triangle};
    tm_surface_closest(surface, middle, TM_NONE, &at);
    return surface->marker[at.triangle];
}

/* The element beyond a face of which `element` is the first of those that the enclosed
 * leaves have there: that, or the next one, which has the corners. */
static uint32_t beyond(const tm_octree_mesh *m, uint32_t element, unsigned k,
                       const uint32_t *corner)
{
    const tm_mixed_mesh *mesh = &m->assembly.mesh;
    if (element == TM_NONE)
        return TM_NONE;
    unsigned common = 0;
    for (size_t i = mesh->start[element]; i < mesh->start[element + 1]; i++)
        for (unsigned c = 0; c < k; c++)
            common += mesh->item[i] == m->assembly.outer + corner[c];
    return common == k ? element : element + 1;
}

static void add_facet(facet_writer *w, const tm_octree_mesh *m, const tm_surface *surface,
                      size_t f, uint32_t element, unsigned k, const uint32_t *corner)
{
    const uint32_t *across = m->assembly.layer_across;
    w->block->integer[2 * w->facets] = element;
    w->block->integer[2 * w->facets + 1] =
        across ? beyond(m, across[f], k, corner) : TM_NONE;
    w->block->marker[w->facets] = marker_of(m, surface, k, corner);
    w->block->start[w->facets++] = w->items;
    for (unsigned i = 0; i < k; i++)
        w->block->item[w->items++] = m->assembly.outer + corner[i];
}

/* The faces of the boundary, and between regions, as rows of .facet: a quadrilateral, a
 * triangle, or two triangles. */
static tm_status facets_to_stream(const tm_octree_mesh *m, const tm_surface *surface,
                                  tm_stream *stream, tm_error *error)
{
    const tm_interior_boundary *boundary = &m->boundary;
    size_t facets = 0, items = 0;
    for (size_t f = 0; f < boundary->faces; f++) {
        const bool cut = boundary->cut[f] != TM_UNCUT;
        facets += cut ? 2 : 1;
        items += cut ? 2 * 3 : tm_boundary_face_corners(boundary, f);
    }
    tm_block *facet = tm_stream_add(stream, ".facet");
    if (!facet)
        return tm_fail_memory(error);
    facet->markers = true;
    const tm_status status = tm_block_allocate(facet, facets, items, error);
    if (status != TM_OK)
        return status;
    facet_writer w = {.block = facet};
    for (size_t f = 0; f < boundary->faces; f++) {
        const uint32_t *face = boundary->face[f];
        const uint32_t element = m->assembly.layer[f];
        if (boundary->cut[f] == TM_UNCUT) {
            add_facet(&w, m, surface, f, element, tm_boundary_face_corners(boundary, f),
                      face);
            continue;
        }
        for (uint32_t t = 0; t < 2; t++) {
            const uint8_t *corner = tm_cut_triangles[boundary->cut[f]][t];
            add_facet(&w, m, surface, f, element + t, 3,
                      (uint32_t[]){face[corner[0]], face[corner[1]], face[corner[2]]});
        }
    }
    facet->start[w.facets] = w.items;
    return TM_OK;
}

static tm_status surface_to_stream(tm_surface *surface, tm_stream *stream,
                                   tm_error *error)
{
    tm_block *node = tm_stream_add(stream, "surface.node");
    if (!node)
        return tm_fail_memory(error);
    node->count = surface->nodes;
    node->real = (double *)surface->xyz;
    surface->xyz = NULL;
    tm_block *face = tm_stream_add(stream, "surface.face");
    if (!face)
        return tm_fail_memory(error);
    face->count = surface->triangles;
    face->integer = (uint32_t *)surface->triangle;
    surface->triangle = NULL;
    face->markers = surface->marker != NULL;
    face->marker = surface->marker;
    surface->marker = NULL;
    return tm_group_to_stream(&surface->group, stream, ".group", error);
}

tm_status tm_octree_mesh_to_stream(tm_octree_mesh *mesh, const tm_octree *octree,
                                   tm_surface *surface, bool levels, tm_stream *stream,
                                   tm_error *error)
{
    /* Nodes come first, but facets look at them before they are given away. */
    tm_status status = tm_stream_add(stream, ".node") ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK && surface->marker)
        status = facets_to_stream(mesh, surface, stream, error);
    if (status == TM_OK)
        status = nodes_to_stream(mesh, stream, error);
    if (status == TM_OK)
        status = elements_to_stream(mesh, octree, surface, levels, stream, error);
    if (status == TM_OK)
        status = tm_octree_to_stream(octree, mesh->assembly.first, stream, error);
    if (status == TM_OK)
        status = surface_to_stream(surface, stream, error);
    return status;
}
