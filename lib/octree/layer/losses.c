/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../surface/surface_distance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is farther from the mesh than this, in sides of leaves, is missed. */
static const double missed = 0.5;

typedef struct {
    tm_octree_mesh *mesh;
    const tm_octree *octree;
    const tm_surface *surface;
    unsigned level;      /* smaller leaves are taken for leaves of this one */
    tm_surface boundary; /* of the mesh, as triangles */
    uint32_t *face;      /* [triangles]: of the interior boundary */
    size_t triangles;
    uint32_t (*triangle)[3];
    double *distance; /* [nodes of the surface]: to the mesh, of those that are missed */
} finder;

static void add_triangle(finder *f, size_t face, const uint8_t corner[3])
{
    for (int i = 0; i < 3; i++)
        f->triangle[f->triangles][i] = f->mesh->boundary.face[face][corner[i]];
    f->face[f->triangles++] = (uint32_t)face;
}

static tm_status make_boundary(finder *f, tm_error *error)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    f->triangle = tm_new(2 * boundary->faces, sizeof *f->triangle);
    f->face = tm_new(2 * boundary->faces, sizeof *f->face);
    if (!f->triangle || !f->face)
        return tm_fail_memory(error);
    for (size_t i = 0; i < boundary->faces; i++) {
        const unsigned cut = boundary->cut[i] == TM_UNCUT ? TM_CUT_02 : boundary->cut[i];
        add_triangle(f, i, tm_cut_triangles[cut][0]);
        if (tm_boundary_face_corners(boundary, i) == 4)
            add_triangle(f, i, tm_cut_triangles[cut][1]);
    }
    const tm_assembly *a = &f->mesh->assembly;
    return tm_surface_of_triangles(
        &f->boundary, (const double(*)[3])a->mesh.xyz + a->outer, boundary->nodes,
        (const uint32_t(*)[3])f->triangle, NULL, f->triangles, error);
}

/* The side of a leaf, or of the one of f->level that it is in. */
static double side_of(const finder *f, unsigned level)
{
    return ldexp(f->octree->side, -(int)(level < f->level ? level : f->level));
}

/* How far a point of the surface is from the mesh. */
static double distance_from(const finder *f, const double point[3], uint32_t *guess)
{
    tm_surface_point at = {.triangle = *guess};
    tm_surface_closest(&f->boundary, point, TM_NONE, &at);
    *guess = at.triangle;
    return sqrt(at.distance2);
}

/* Measures from each node of the surface: a tip has one at its end. */
static void measure_nodes(finder *f)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const double least = side_of(f, f->level);
    uint32_t guess = TM_NONE;
    for (size_t v = 0; v < f->surface->nodes; v++) {
        const double d = distance_from(f, f->surface->xyz[v], &guess);
        const double side = boundary->size[boundary->face[f->face[guess]][0]];
        if (d > missed * fmax(side, least))
            f->distance[v] = d;
    }
}

/* Counts what hangs together of the nodes that are missed. */
static tm_status count_rounded(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    tm_octree_mesh_report *r = &f->mesh->report;
    uint32_t *parent = tm_new(s->nodes, sizeof *parent);
    if (!parent)
        return tm_fail_memory(error);
    for (uint32_t v = 0; v < s->nodes; v++)
        parent[v] = v;
    for (size_t t = 0; t < s->triangles; t++)
        for (int i = 0; i < 3; i++) {
            const uint32_t a = s->triangle[t][i], b = s->triangle[t][(i + 1) % 3];
            if (f->distance[a] > 0 && f->distance[b] > 0)
                tm_set_unite(parent, a, b);
        }
    for (uint32_t v = 0; v < s->nodes; v++) {
        r->rounded += f->distance[v] > 0 && tm_set_root(parent, v) == v;
        if (f->distance[v] > r->rounded_by) {
            r->rounded_by = f->distance[v];
            memcpy(r->rounded_at, s->xyz[v], sizeof r->rounded_at);
        }
    }
    free(parent);
    return TM_OK;
}

/* Whether two leaves are in the same one of f->level. */
static bool is_same(const finder *f, const tm_leaf *a, const tm_leaf *b)
{
    const unsigned shift = f->octree->finest - f->level;
    for (int i = 0; i < 3; i++)
        if (a->anchor[i] >> shift != b->anchor[i] >> shift)
            return false;
    return a->level > f->level && b->level > f->level;
}

/* Of the leaves without boundary close by, those whose surface is missed. */
static void count_leaves(finder *f, const uint8_t *lost)
{
    tm_octree_mesh_report *r = &f->mesh->report;
    const tm_leaf *last = NULL;
    uint32_t guess = TM_NONE;
    tm_surface_point at = {.triangle = TM_NONE};
    for (size_t l = 0; l < f->octree->leaves; l++) {
        const tm_leaf *leaf = &f->octree->leaf[l];
        if (!lost[l] || (last && is_same(f, last, leaf)))
            continue;
        double centre[3];
        tm_leaf_centre(f->octree, leaf, centre);
        tm_surface_closest(f->surface, centre, TM_NONE, &at);
        if (distance_from(f, at.xyz, &guess) <= missed * side_of(f, leaf->level))
            continue;
        if (r->lost++ == 0)
            memcpy(r->lost_at, at.xyz, sizeof at.xyz);
        last = leaf;
    }
}

static tm_status find_lost(finder *f, tm_error *error)
{
    uint8_t *lost = tm_new(f->octree->leaves, sizeof *lost);
    if (!lost)
        return tm_fail_memory(error);
    if (tm_interior_find_lost(&f->mesh->interior, f->octree, f->surface, lost) > 0)
        count_leaves(f, lost);
    free(lost);
    return TM_OK;
}

/* Counts the shells that no boundary node is closest to. */
static tm_status find_dropped(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    tm_octree_mesh_report *r = &f->mesh->report;
    bool *there = calloc(s->components + 1, sizeof *there);
    if (!there)
        return tm_fail_memory(error);
    for (size_t i = 0; i < f->mesh->boundary.nodes; i++)
        there[s->shell[f->mesh->at[i].triangle]] = true;
    for (size_t t = 0; t < s->triangles; t++) {
        if (there[s->shell[t]])
            continue;
        there[s->shell[t]] = true;
        if (r->dropped++ == 0)
            memcpy(r->dropped_at, s->xyz[s->triangle[t][0]], sizeof r->dropped_at);
    }
    free(there);
    return TM_OK;
}

tm_status tm_octree_mesh_find_losses(tm_octree_mesh *mesh, const tm_octree *octree,
                                     const tm_surface *surface, unsigned level,
                                     tm_error *error)
{
    finder f = {.mesh = mesh,
                .octree = octree,
                .surface = surface,
                .level = level,
                .distance = calloc(surface->nodes + 1, sizeof *f.distance)};
    tm_status status = f.distance ? find_dropped(&f, error) : tm_fail_memory(error);
    if (status == TM_OK && !surface->by_winding) {
        status = make_boundary(&f, error);
        if (status == TM_OK) {
            measure_nodes(&f);
            status = count_rounded(&f, error);
        }
        if (status == TM_OK)
            status = find_lost(&f, error);
    }
    tm_surface_free(&f.boundary);
    free(f.triangle);
    free(f.face);
    free(f.distance);
    return status;
}
