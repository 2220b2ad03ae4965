/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_stream.h"

#include "../../base/array.h"
#include "../forest/octree_stream.h"
#include "mesh_share.h"

#include <stdlib.h>
#include <string.h>

/* The part of a mesh that goes to a stream, and its numbers there. */
typedef struct {
    tm_octree_mesh *mesh;
    const tm_octree *octree;
    size_t leaf, leaf_past, element, element_past, face, face_past;
    size_t element_number;  /* of the first element */
    const uint32_t *number; /* [nodes]; NULL: the same */
} extent;

static extent all_of(tm_octree_mesh *m, const tm_octree *octree)
{
    return (extent){.mesh = m,
                    .octree = octree,
                    .leaf_past = octree->leaves,
                    .element_past = m->assembly.mesh.elements,
                    .face_past = m->boundary.faces};
}

static extent own_of(tm_octree_mesh *m, const tm_octree_share *share)
{
    const tm_mesh_share *s = m->share;
    return (extent){.mesh = m,
                    .octree = &share->octree,
                    .leaf = share->own_first,
                    .leaf_past = share->own_past,
                    .element = s->elements.first,
                    .element_past = s->elements.past,
                    .face = s->faces.first,
                    .face_past = s->faces.past,
                    .element_number = s->elements.number,
                    .number = s->number};
}

static uint32_t number_of(const extent *x, uint32_t node)
{
    return x->number ? x->number[node] : node;
}

double *tm_octree_mesh_classes(const tm_octree_mesh *m)
{
    const tm_assembly *a = &m->assembly;
    double *of = calloc(a->mesh.nodes + 1, sizeof *of);
    for (size_t s = 0; of && s < m->boundary.nodes; s++) {
        const double class = TM_NODE_ON_PATCH + m->feature.kind[s];
        of[a->outer + s] = m->off_surface[s] ? -class : class;
    }
    return of;
}

static tm_status nodes_to_stream(tm_octree_mesh *m, tm_stream *stream, tm_error *error)
{
    tm_block *node = tm_stream_find(stream, ".node");
    const tm_assembly *a = &m->assembly;
    node->attribute = tm_octree_mesh_classes(m);
    if (!node->attribute)
        return tm_fail_memory(error);
    node->count = a->mesh.nodes;
    node->attributes = 1;
    node->real = (double *)m->assembly.mesh.xyz;
    m->assembly.mesh.xyz = NULL;
    return TM_OK;
}

/* The region of its leaf, where there are some, then the level. */
static tm_status attributes_to_stream(const extent *x, const tm_surface *surface,
                                      bool levels, tm_block *mix, tm_error *error)
{
    const tm_octree_mesh *m = x->mesh;
    const size_t k = (m->region ? 1u : 0u) + (levels ? 1u : 0u);
    mix->attribute = tm_new(k * mix->count, sizeof *mix->attribute);
    if (!mix->attribute)
        return tm_fail_memory(error);
    mix->attributes = k;
    for (size_t l = x->leaf; l < x->leaf_past; l++)
        for (size_t e = m->assembly.first[l]; e < m->assembly.first[l + 1]; e++) {
            double *row = mix->attribute + k * (e - x->element);
            if (levels)
                row[k - 1] = x->octree->leaf[l].level;
            if (m->region)
                *row = surface->region ? surface->region[m->region[l] - 1] : m->region[l];
        }
    return TM_OK;
}

/* Of a part, the elements in its arrays are moved to their front, with the numbers that
 * nodes have in the whole. */
static void number_elements(const extent *x)
{
    tm_mixed_mesh *mesh = &x->mesh->assembly.mesh;
    const size_t begin = mesh->start[x->element];
    const size_t items = mesh->start[x->element_past] - begin;
    for (size_t e = 0; e <= x->element_past - x->element; e++)
        mesh->start[e] = mesh->start[x->element + e] - begin;
    for (size_t i = 0; i < items; i++)
        mesh->item[i] = number_of(x, mesh->item[begin + i]);
}

static tm_status elements_to_stream(const extent *x, const tm_surface *surface,
                                    bool levels, tm_stream *stream, tm_error *error)
{
    tm_octree_mesh *m = x->mesh;
    tm_block *mix = tm_stream_add(stream, ".mix");
    if (!mix)
        return tm_fail_memory(error);
    tm_mixed_mesh *mesh = &m->assembly.mesh;
    mix->count = x->element_past - x->element;
    if (levels || m->region) {
        const tm_status status = attributes_to_stream(x, surface, levels, mix, error);
        if (status != TM_OK)
            return status;
    }
    if (x->number)
        number_elements(x);
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

static void add_facet(facet_writer *w, const extent *x, const tm_surface *surface,
                      size_t f, uint32_t element, unsigned k, const uint32_t *corner)
{
    const tm_octree_mesh *m = x->mesh;
    const uint32_t *across = m->assembly.layer_across;
    w->block->integer[2 * w->facets] =
        (uint32_t)(x->element_number + element - x->element);
    w->block->integer[2 * w->facets + 1] =
        across ? beyond(m, across[f], k, corner) : TM_NONE;
    w->block->marker[w->facets] = marker_of(m, surface, k, corner);
    w->block->start[w->facets++] = w->items;
    for (unsigned i = 0; i < k; i++)
        w->block->item[w->items++] = number_of(x, m->assembly.outer + corner[i]);
}

/* The faces of the boundary, and between regions, as rows of .facet: a quadrilateral, a
 * triangle, or two triangles. */
static tm_status facets_to_stream(const extent *x, const tm_surface *surface,
                                  tm_stream *stream, tm_error *error)
{
    const tm_octree_mesh *m = x->mesh;
    const tm_interior_boundary *boundary = &m->boundary;
    size_t facets = 0, items = 0;
    for (size_t f = x->face; f < x->face_past; f++) {
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
    for (size_t f = x->face; f < x->face_past; f++) {
        const uint32_t *face = boundary->face[f];
        const uint32_t element = m->assembly.layer[f];
        if (boundary->cut[f] == TM_UNCUT) {
            add_facet(&w, x, surface, f, element, tm_boundary_face_corners(boundary, f),
                      face);
            continue;
        }
        for (uint32_t t = 0; t < 2; t++) {
            const uint8_t *corner = tm_cut_triangles[boundary->cut[f]][t];
            add_facet(&w, x, surface, f, element + t, 3,
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

/* Octants with the elements that they have. */
static tm_status octants_to_stream(const extent *x, unsigned finest, tm_stream *stream,
                                   tm_error *error)
{
    const size_t count = x->leaf_past - x->leaf;
    tm_octree part = *x->octree;
    uint32_t *first = tm_new(count + 1, sizeof *first);
    if (!first)
        return tm_fail_memory(error);
    for (size_t i = 0; i <= count; i++)
        first[i] = (uint32_t)(x->element_number + x->mesh->assembly.first[x->leaf + i] -
                              x->element);
    part.leaf += x->leaf;
    part.leaves = count;
    const tm_status status = tm_octree_to_stream(&part, finest, first, stream, error);
    free(first);
    return status;
}

/* All but the nodes. Nodes come first, but facets look at them before they are given
 * away. */
static tm_status rows_to_stream(const extent *x, unsigned finest, tm_surface *surface,
                                bool levels, tm_stream *stream, tm_error *error)
{
    tm_status status = tm_stream_add(stream, ".node") ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK && surface->marker)
        status = facets_to_stream(x, surface, stream, error);
    if (status == TM_OK)
        status = elements_to_stream(x, surface, levels, stream, error);
    if (status == TM_OK)
        status = octants_to_stream(x, finest, stream, error);
    if (status == TM_OK)
        status = surface_to_stream(surface, stream, error);
    return status;
}

tm_status tm_octree_mesh_to_stream(tm_octree_mesh *mesh, const tm_octree *octree,
                                   tm_surface *surface, bool levels, tm_stream *stream,
                                   tm_error *error)
{
    const extent x = all_of(mesh, octree);
    const tm_status status =
        rows_to_stream(&x, tm_octree_deepest(octree), surface, levels, stream, error);
    return status == TM_OK ? nodes_to_stream(mesh, stream, error) : status;
}

tm_status tm_octree_mesh_rows(tm_octree_mesh *mesh, const tm_octree_share *share,
                              unsigned finest, tm_surface *surface, bool levels,
                              tm_stream *stream, tm_error *error)
{
    const extent x = own_of(mesh, share);
    return rows_to_stream(&x, finest, surface, levels, stream, error);
}
