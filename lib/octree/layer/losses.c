/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../geom/vector.h"
#include "../../ranks/ranks.h"
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
    unsigned level; /* smaller leaves are taken for leaves of this one */
    const tm_mesh_own *own;
    double farthest;     /* that any own face may be from a point of the surface */
    tm_surface boundary; /* the own faces, when they are needed: two triangles for each */
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

static tm_status make_boundary(finder *f, tm_error *error)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const tm_assembly *a = &f->mesh->assembly;
    const size_t first = f->own->first_face, faces = f->own->past_face - first;
    uint32_t(*triangle)[3] = tm_new(2 * faces, sizeof *triangle);
    if (!triangle)
        return tm_fail_memory(error);
    for (size_t i = 0; i < 2 * faces; i++)
        half_of(boundary, first + i / 2, (int)(i % 2), triangle[i]);
    for (size_t i = 0; i < faces; i++)
        f->farthest = fmax(f->farthest, reach_of(f, first + i));
    const tm_status status = tm_surface_of_triangles(
        &f->boundary, (const double(*)[3])a->mesh.xyz + a->outer, boundary->nodes,
        (const uint32_t(*)[3])triangle, NULL, 2 * faces, error);
    free(triangle);
    return status;
}

/* How far a point of the surface is from the own faces, which are infinitely far where
 * there is none; *guess becomes the triangle there. */
static tm_status distance_from(finder *f, const double point[3], uint32_t *guess,
                               double *distance, tm_error *error)
{
    *distance = INFINITY;
    if (f->own->first_face == f->own->past_face)
        return TM_OK;
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

/* Whether a point is no farther from a face than it may be. */
static bool is_in_reach(const finder *f, size_t face, const double point[3])
{
    const double reach = reach_of(f, face);
    for (int k = 0; k < 2; k++) {
        uint32_t corner[3];
        double xyz[3][3];
        half_of(&f->mesh->boundary, face, k, corner);
        for (int c = 0; c < 3; c++)
            memcpy(xyz[c], place_of(f, corner[c]), sizeof xyz[c]);
        if (tm_corners_distance2((const double(*)[3])xyz, point) <= reach * reach)
            return true;
    }
    return false;
}

/* Whether node v of the surface is in reach of an own face around its boundary node. */
static bool is_near_hint(const finder *f, uint32_t v)
{
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const uint32_t s = f->hint[v];
    if (s == TM_NONE)
        return false;
    for (size_t i = boundary->around_start[s]; i < boundary->around_start[s + 1]; i++) {
        const uint32_t face = boundary->around[i];
        if (face >= f->own->first_face && face < f->own->past_face &&
            is_in_reach(f, face, f->surface->xyz[v]))
            return true;
    }
    return false;
}

/* Whether a point is in reach of any own face, by the boxes of these. */
static bool is_near(const finder *f, const double point[3])
{
    const tm_surface_tree *tree = f->boundary.tree;
    uint32_t stack[TM_TREE_DEPTH], depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const tm_tree_node *box = &tree->node[stack[--depth]];
        if (tm_tree_box_distance2(box, point) > f->farthest * f->farthest)
            continue;
        for (uint32_t t = 0; t < box->count; t++)
            if (is_in_reach(f, f->own->first_face + tree->triangle[box->first + t].id / 2,
                            point))
                return true;
        if (box->count == 0) {
            stack[depth++] = box->first;
            stack[depth++] = box->first + 1;
        }
    }
    return false;
}

/* The distance of those nodes of the surface that no own face is in reach of; 0 of the
 * others. */
static tm_status measure_far(finder *f, tm_error *error)
{
    uint32_t guess = TM_NONE;
    tm_status status = TM_OK;
    for (uint32_t v = 0; status == TM_OK && v < f->surface->nodes; v++) {
        const double *point = f->surface->xyz[v];
        if (f->distance[v] == 0)
            continue;
        status = distance_from(f, point, &guess, &f->distance[v], error);
        if (status == TM_OK && f->distance[v] <= f->farthest && is_near(f, point))
            f->distance[v] = 0;
    }
    return status;
}

/* Measures from each node of the surface: a tip has one at its end. It is missed where
 * no face is in reach: most are near one that is easily found. */
static tm_status measure_nodes(finder *f, tm_error *error)
{
    spread_hints(f);
    for (uint32_t v = 0; v < f->surface->nodes; v++)
        f->distance[v] = is_near_hint(f, v) ? 0 : INFINITY;
    tm_ranks_least(f->distance, f->surface->nodes);
    const tm_status status = tm_ranks_agree(measure_far(f, error), error);
    tm_ranks_least(f->distance, f->surface->nodes);
    return status;
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

/* How far the surface at the centre of each leaf is from the mesh. */
static tm_status measure_leaves(finder *f, const tm_leaf *lost, size_t count,
                                double (*place)[3], double *distance, tm_error *error)
{
    uint32_t guess = TM_NONE;
    tm_surface_point at = {.triangle = TM_NONE};
    tm_status status = TM_OK;
    for (size_t l = 0; status == TM_OK && l < count; l++) {
        double centre[3];
        tm_leaf_centre(f->octree, &lost[l], centre);
        tm_surface_closest(f->surface, centre, TM_NONE, &at);
        memcpy(place[l], at.xyz, sizeof place[l]);
        status = distance_from(f, at.xyz, &guess, &distance[l], error);
    }
    status = tm_ranks_agree(status, error);
    tm_ranks_least(distance, count);
    return status;
}

/* Of these leaves, without boundary close by, those whose surface is missed. */
static tm_status count_leaves(finder *f, const tm_leaf *lost, size_t count,
                              tm_error *error)
{
    tm_octree_mesh_report *r = &f->mesh->report;
    const tm_leaf *last = NULL;
    double(*place)[3] = tm_new(count, sizeof *place);
    double *distance = tm_new(count, sizeof *distance);
    tm_status status = tm_ranks_enough(place && distance, error);
    if (status == TM_OK)
        status = measure_leaves(f, lost, count, place, distance, error);
    for (size_t l = 0; status == TM_OK && l < count; l++) {
        if (distance[l] <= missed * side_of(f, lost[l].level) ||
            (last && is_same(f, last, &lost[l])))
            continue;
        if (r->lost++ == 0)
            memcpy(r->lost_at, place[l], sizeof r->lost_at);
        last = &lost[l];
    }
    free(place);
    free(distance);
    return status;
}

/* The own leaves with surface but no boundary close by; NULL where memory is out. */
static tm_leaf *list_lost(const finder *f, size_t *count)
{
    const tm_octree *octree = f->octree;
    const tm_interior *interior = f->mesh->part;
    uint8_t *lost = tm_new(octree->leaves, sizeof *lost);
    tm_leaf *list =
        lost ? tm_new(tm_interior_find_lost(interior, octree, f->surface, lost),
                      sizeof *list)
             : NULL;
    *count = 0;
    for (size_t l = f->own->first_leaf; list && l < f->own->past_leaf; l++)
        if (lost[l])
            list[(*count)++] = octree->leaf[l];
    free(lost);
    return list;
}

static tm_status find_lost(finder *f, tm_error *error)
{
    size_t count;
    void *all = NULL;
    tm_leaf *lost = list_lost(f, &count);
    tm_status status = tm_ranks_enough(lost, error);
    if (status == TM_OK)
        status = tm_ranks_share(lost, count, sizeof *lost, &all, &count, error);
    if (status == TM_OK)
        status = count_leaves(f, all, count, error);
    free(lost);
    free(all);
    return status;
}

/* Counts the shells that no boundary node is closest to. */
static tm_status find_dropped(finder *f, tm_error *error)
{
    const tm_surface *s = f->surface;
    tm_octree_mesh_report *r = &f->mesh->report;
    size_t *there = calloc(s->components + 1, sizeof *there);
    const tm_status status = tm_ranks_enough(there, error);
    for (size_t i = 0; status == TM_OK && i < f->mesh->boundary.nodes; i++)
        there[s->shell[f->mesh->at[i].triangle]] = 1;
    if (status == TM_OK)
        tm_ranks_sum(there, s->components);
    for (size_t t = 0; status == TM_OK && t < s->triangles; t++) {
        if (there[s->shell[t]])
            continue;
        there[s->shell[t]] = 1;
        if (r->dropped++ == 0)
            memcpy(r->dropped_at, s->xyz[s->triangle[t][0]], sizeof r->dropped_at);
    }
    free(there);
    return status;
}

tm_status tm_octree_mesh_find_losses(tm_octree_mesh *mesh, const tm_octree *octree,
                                     const tm_surface *surface, unsigned level,
                                     const tm_mesh_own *own, tm_error *error)
{
    finder f = {.mesh = mesh,
                .octree = octree,
                .surface = surface,
                .level = level,
                .own = own,
                .hint = tm_new(surface->nodes, sizeof *f.hint),
                .distance = calloc(surface->nodes + 1, sizeof *f.distance)};
    tm_status status = tm_ranks_enough(f.hint && f.distance, error);
    if (status == TM_OK)
        status = find_dropped(&f, error);
    if (status == TM_OK && !surface->by_winding) {
        status = measure_nodes(&f, error);
        if (status == TM_OK)
            status = tm_ranks_agree(count_rounded(&f, error), error);
        if (status == TM_OK)
            status = find_lost(&f, error);
    }
    tm_surface_free(&f.boundary);
    free(f.hint);
    free(f.distance);
    return status;
}
