/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../geom/vector.h"
#include "../../surface/measure/surface_distance.h"
#include "../../surface/surface_tree.h"

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
    tm_surface boundary; /* of the mesh, when it is needed: two triangles for each face */
    uint32_t *hint;      /* [nodes of the surface]: a boundary node close by */
    double *distance; /* [nodes of the surface]: to the mesh, of those that are missed */
} finder;

/* Where boundary node s is. */
static const double *place_of(const finder *f, uint32_t s)
{
    return f->mesh->assembly.mesh.xyz[f->mesh->assembly.outer + s];
}

/* The corners of half k of a face; both of a triangle are all of it. */
static void half_of(const tm_interior_boundary *boundary, size_t face, int k,
                    uint32_t corner[3])
{
    const unsigned cut =
        boundary->cut[face] == TM_UNCUT ? TM_CUT_02 : boundary->cut[face];
    const int half = tm_boundary_face_corners(boundary, face) == 4 ? k : 0;
    for (int i = 0; i < 3; i++)
        corner[i] = boundary->face[face][tm_cut_triangles[cut][half][i]];
}

static tm_status make_boundary(finder *f, tm_error *error)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const tm_assembly *a = &f->mesh->assembly;
    uint32_t(*triangle)[3] = tm_new(2 * boundary->faces, sizeof *triangle);
    if (!triangle)
        return tm_fail_memory(error);
    for (size_t i = 0; i < 2 * boundary->faces; i++)
        half_of(boundary, i / 2, (int)(i % 2), triangle[i]);
    const tm_status status = tm_surface_of_triangles(
        &f->boundary, (const double(*)[3])a->mesh.xyz + a->outer, boundary->nodes,
        (const uint32_t(*)[3])triangle, NULL, 2 * boundary->faces, error);
    free(triangle);
    return status;
}

/* The side of a leaf, or of the one of f->level that it is in. */
static double side_of(const finder *f, unsigned level)
{
    return ldexp(f->octree->side, -(int)(level < f->level ? level : f->level));
}

/* How far a point of the surface may be from a face. */
static double reach_of(const finder *f, size_t face)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    return missed * fmax(boundary->size[boundary->face[face][0]], side_of(f, f->level));
}

/* How far a point of the surface is from the mesh; *guess becomes the triangle there. */
static tm_status distance_from(finder *f, const double point[3], uint32_t *guess,
                               double *distance, tm_error *error)
{
    if (!f->boundary.tree) {
        const tm_status status = make_boundary(f, error);
        if (status != TM_OK)
            return status;
    }
    tm_surface_point at = {.triangle = *guess};
    tm_surface_closest(&f->boundary, point, TM_NONE, &at);
    *guess = at.triangle;
    *distance = sqrt(at.distance2);
    return TM_OK;
}

/* Gives node v of the surface boundary node s, if that is closer than what it has. */
static bool offer(finder *f, uint32_t v, uint32_t s)
{
    const double *xyz = f->surface->xyz[v];
    if (s == f->hint[v] || s == TM_NONE ||
        (f->hint[v] != TM_NONE &&
         tm_distance2(xyz, place_of(f, s)) >= tm_distance2(xyz, place_of(f, f->hint[v]))))
        return false;
    f->hint[v] = s;
    return true;
}

/* Boundary nodes know the triangle that they are on; from there they go from node to node
 * of the surface, which mostly is cheaper than to search. */
static void spread_hints(finder *f)
{
    const tm_surface *s = f->surface;
    const int sweeps = 32;
    for (size_t v = 0; v < s->nodes; v++)
        f->hint[v] = TM_NONE;
    for (uint32_t n = 0; n < f->mesh->boundary.nodes; n++)
        for (int i = 0; i < 3; i++)
            offer(f, s->triangle[f->mesh->at[n].triangle][i], n);
    bool more = true;
    for (int sweep = 0; sweep < sweeps && more; sweep++) {
        more = false;
        for (size_t k = 0; k < s->triangles; k++) {
            const size_t t = sweep % 2 ? s->triangles - 1 - k : k;
            const uint32_t *v = s->triangle[t];
            for (int i = 0; i < 3; i++) {
                more |= offer(f, v[i], f->hint[v[(i + 1) % 3]]);
                more |= offer(f, v[i], f->hint[v[(i + 2) % 3]]);
            }
        }
    }
}

/* Whether a face around its boundary node is close enough to node v of the surface. */
static bool is_near(const finder *f, uint32_t v)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const uint32_t s = f->hint[v];
    if (s == TM_NONE)
        return false;
    for (size_t i = boundary->around_start[s]; i < boundary->around_start[s + 1]; i++) {
        const double reach = reach_of(f, boundary->around[i]);
        for (int k = 0; k < 2; k++) {
            uint32_t corner[3];
            double xyz[3][3];
            half_of(boundary, boundary->around[i], k, corner);
            for (int c = 0; c < 3; c++)
                memcpy(xyz[c], place_of(f, corner[c]), sizeof xyz[c]);
            if (tm_corners_distance2((const double(*)[3])xyz, f->surface->xyz[v]) <=
                reach * reach)
                return true;
        }
    }
    return false;
}

/* Measures from each node of the surface: a tip has one at its end. */
static tm_status measure_nodes(finder *f, tm_error *error)
{
    uint32_t guess = TM_NONE;
    spread_hints(f);
    for (uint32_t v = 0; v < f->surface->nodes; v++) {
        double d;
        if (is_near(f, v))
            continue;
        const tm_status status = distance_from(f, f->surface->xyz[v], &guess, &d, error);
        if (status != TM_OK)
            return status;
        if (d > reach_of(f, guess / 2))
            f->distance[v] = d;
    }
    return TM_OK;
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

/* Of these leaves, without boundary close by, those whose surface is missed. */
static tm_status count_leaves(finder *f, const tm_leaf *lost, size_t count,
                              tm_error *error)
{
    tm_octree_mesh_report *r = &f->mesh->report;
    const tm_leaf *last = NULL;
    uint32_t guess = TM_NONE;
    tm_surface_point at = {.triangle = TM_NONE};
    for (size_t l = 0; l < count; l++) {
        const tm_leaf *leaf = &lost[l];
        if (last && is_same(f, last, leaf))
            continue;
        double centre[3], distance;
        tm_leaf_centre(f->octree, leaf, centre);
        tm_surface_closest(f->surface, centre, TM_NONE, &at);
        const tm_status status = distance_from(f, at.xyz, &guess, &distance, error);
        if (status != TM_OK)
            return status;
        if (distance <= missed * side_of(f, leaf->level))
            continue;
        if (r->lost++ == 0)
            memcpy(r->lost_at, at.xyz, sizeof at.xyz);
        last = leaf;
    }
    return TM_OK;
}

tm_leaf *tm_octree_mesh_lost_leaves(const tm_interior *interior, const tm_octree *octree,
                                    const tm_surface *surface, size_t first, size_t past,
                                    size_t *count)
{
    uint8_t *lost = tm_new(octree->leaves, sizeof *lost);
    tm_leaf *list = lost ? tm_new(tm_interior_find_lost(interior, octree, surface, lost),
                                  sizeof *list)
                         : NULL;
    *count = 0;
    for (size_t l = first; list && l < past; l++)
        if (lost[l])
            list[(*count)++] = octree->leaf[l];
    free(lost);
    return list;
}

static tm_status find_lost(finder *f, tm_error *error)
{
    size_t count;
    tm_leaf *lost = tm_octree_mesh_lost_leaves(f->mesh->part, f->octree, f->surface, 0,
                                               f->octree->leaves, &count);
    const tm_status status =
        lost ? count_leaves(f, lost, count, error) : tm_fail_memory(error);
    free(lost);
    return status;
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
                                     const tm_leaf *lost, size_t losts, tm_error *error)
{
    finder f = {.mesh = mesh,
                .octree = octree,
                .surface = surface,
                .level = level,
                .hint = tm_new(surface->nodes, sizeof *f.hint),
                .distance = calloc(surface->nodes + 1, sizeof *f.distance)};
    tm_status status = f.hint && f.distance ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = find_dropped(&f, error);
    if (status == TM_OK && !surface->by_winding) {
        status = measure_nodes(&f, error);
        if (status == TM_OK)
            status = count_rounded(&f, error);
        if (status == TM_OK)
            status =
                mesh->part ? find_lost(&f, error) : count_leaves(&f, lost, losts, error);
    }
    tm_surface_free(&f.boundary);
    free(f.hint);
    free(f.distance);
    return status;
}
