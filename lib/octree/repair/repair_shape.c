/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_shape.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../element/shape.h"
#include "../../examine/element_examine.h"
#include "../../geom/vector.h"
#include "../../stream/stream.h"
#include "../layer/octree_mesh_stream.h"
#include "../../mesh/mixed_boundary.h"

#include <math.h>
#include <stdlib.h>

/* How far the middle of an edge may be from the curve that it is along, by its length;
 * what of all curves, and of the volume, may be missing. */
static const double along = 0.1, curves_less = 0.01, volume_off = 1e-3;

/* The boundary: faces of elements, as numbers of mixed_boundary.h. */
typedef struct {
    const tm_repair_state *state;
    const tm_surface *surface;
    uint32_t *face;
    size_t faces;
} boundary;

static bool is_along(const boundary *b, uint32_t curve, const double middle[3],
                     double length)
{
    double point[3];
    size_t segment;
    tm_surface_closest_on_curve(b->surface, curve, middle, point, &segment);
    return tm_distance2(point, middle) <= along * along * length * length;
}

/* The length of an edge of the boundary if it is along a curve, else 0. */
static double length_along(const boundary *b, uint32_t v, uint32_t w)
{
    const tm_repair_state *s = b->state;
    const uint8_t *on = s->on;
    if (on[v] < TM_NODE_ON_CURVE || on[w] < TM_NODE_ON_CURVE || s->rule[v].off_surface ||
        s->rule[w].off_surface)
        return 0;
    double middle[3];
    for (int i = 0; i < 3; i++)
        middle[i] = (s->mesh.xyz[v][i] + s->mesh.xyz[w][i]) / 2;
    const double length = sqrt(tm_distance2(s->mesh.xyz[v], s->mesh.xyz[w]));
    if (on[v] == TM_NODE_ON_CORNER && on[w] == TM_NODE_ON_CORNER) {
        for (uint32_t c = 0; c < b->surface->curves; c++)
            if (is_along(b, c, middle, length))
                return length;
        return 0;
    }
    const uint32_t from = s->rule[on[v] == TM_NODE_ON_CURVE ? v : w].where;
    const uint32_t to = s->rule[on[w] == TM_NODE_ON_CURVE ? w : v].where;
    return from == to && from != TM_NONE && is_along(b, from, middle, length) ? length
                                                                              : 0;
}

static void measure_boundary(tm_repair_shape *shape, const boundary *b)
{
    const double(*xyz)[3] = (const double(*)[3])b->state->mesh.xyz;
    for (size_t f = 0; f < b->faces; f++) {
        uint32_t node[4];
        const size_t k = tm_mixed_face_of(&b->state->mesh, b->face[f], node);
        for (size_t i = 0; i < k; i++)
            if (node[i] < node[(i + 1) % k])
                shape->curves += length_along(b, node[i], node[(i + 1) % k]);
        for (size_t i = 2; i < k; i++) {
            double normal[3], to[3];
            tm_triangle_normal(normal, xyz[node[0]], xyz[node[i - 1]], xyz[node[i]]);
            tm_subtract(to, xyz[node[0]], b->surface->low);
            shape->volume += tm_dot(normal, to) / 6;
        }
    }
}

/* The pieces of the boundary and its Euler characteristic. */
static tm_status measure_topology(tm_repair_shape *shape, const boundary *b,
                                  tm_error *error)
{
    const size_t nodes = b->state->mesh.nodes;
    uint32_t *parent = tm_new(nodes, sizeof *parent);
    int64_t half_edges = 0, used = 0;
    if (!parent)
        return tm_fail_memory(error);
    for (size_t v = 0; v < nodes; v++)
        parent[v] = TM_NONE;
    for (size_t f = 0; f < b->faces; f++) {
        uint32_t node[4];
        const size_t k = tm_mixed_face_of(&b->state->mesh, b->face[f], node);
        for (size_t i = 0; i < k; i++) {
            used += parent[node[i]] == TM_NONE;
            if (parent[node[i]] == TM_NONE)
                parent[node[i]] = node[i];
            tm_set_unite(parent, node[0], node[i]);
        }
        half_edges += (int64_t)k;
    }
    for (size_t v = 0; v < nodes; v++)
        shape->components += parent[v] == v;
    shape->euler = used - half_edges / 2 + (int64_t)b->faces;
    free(parent);
    return TM_OK;
}

tm_status tm_repair_shape_measure(tm_repair_shape *shape, const tm_repair_state *state,
                                  const tm_surface *surface, tm_error *error)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .xyz = (const double(*)[3])mesh->xyz,
                               .elements = mesh->elements,
                               .start = mesh->start,
                               .item = mesh->item};
    boundary b = {.state = state, .surface = surface};
    tm_examination found;
    *shape = (tm_repair_shape){0};
    tm_status status = tm_element_examine(&found, &view, 1, error);
    if (status == TM_OK)
        status = tm_mixed_boundary_faces(mesh, &b.face, &b.faces, error);
    if (status == TM_OK) {
        static const tm_defect defects[] = {TM_UNMATCHED_FACE, TM_OPEN_EDGE,
                                            TM_NON_MANIFOLD_EDGE, TM_NON_MANIFOLD_VERTEX};
        for (size_t i = 0; i < sizeof defects / sizeof *defects; i++)
            shape->defects += found.defect[defects[i]].count;
        for (size_t v = 0; v < mesh->nodes; v++)
            shape->corners +=
                state->on[v] == TM_NODE_ON_CORNER && !state->rule[v].off_surface;
        measure_boundary(shape, &b);
        status = measure_topology(shape, &b, error);
    }
    free(b.face);
    return status;
}

static double volume_of(const tm_surface *s)
{
    double volume = 0;
    for (size_t t = 0; t < s->triangles; t++) {
        double normal[3], to[3];
        const uint32_t *node = s->triangle[t];
        tm_triangle_normal(normal, s->xyz[node[0]], s->xyz[node[1]], s->xyz[node[2]]);
        tm_subtract(to, s->xyz[node[0]], s->low);
        volume += tm_dot(normal, to) / 6;
    }
    return volume;
}

static size_t apart(int64_t a, int64_t b)
{
    return (size_t)(a > b ? a - b : b - a);
}

bool tm_repair_shape_keeps(const tm_repair_shape *a, const tm_repair_shape *b,
                           const tm_surface *surface)
{
    if (a->corners < b->corners || a->curves < (1 - curves_less) * b->curves ||
        a->defects > b->defects)
        return false;
    if (surface->by_winding) /* open, or it crosses itself: it has no volume */
        return a->components == b->components && a->euler == b->euler;
    const double volume = volume_of(surface);
    return apart((int64_t)a->components, (int64_t)surface->components) <=
               apart((int64_t)b->components, (int64_t)surface->components) &&
           apart(a->euler, surface->euler) <= apart(b->euler, surface->euler) &&
           fabs(a->volume - volume) <=
               fabs(b->volume - volume) + volume_off * fabs(volume);
}

/* The triangles of the boundary; quadrilaterals are two. malloc'ed. */
static uint32_t (*triangles_of(const boundary *b, size_t *count))[3]
{
    uint32_t(*triangle)[3] = tm_new(2 * b->faces, sizeof *triangle);
    *count = 0;
    for (size_t f = 0; triangle && f < b->faces; f++) {
        uint32_t node[4];
        const size_t k = tm_mixed_face_of(&b->state->mesh, b->face[f], node);
        for (size_t i = 2; i < k; i++) {
            uint32_t *t = triangle[(*count)++];
            t[0] = node[0];
            t[1] = node[i - 1];
            t[2] = node[i];
        }
    }
    return triangle;
}

tm_status tm_repair_shape_compare(tm_surface_comparison *comparison,
                                  const tm_repair_state *state,
                                  const tm_mixed_regions *regions,
                                  const tm_surface *surface, double feature_angle,
                                  tm_error *error)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    boundary b = {.state = state, .surface = surface};
    tm_surface first = {0}, second = {0};
    uint32_t(*triangle)[3] = NULL;
    size_t triangles = 0;
    tm_status status = tm_mixed_region_faces(mesh, regions, &b.face, &b.faces, error);
    if (status == TM_OK) {
        triangle = triangles_of(&b, &triangles);
        status = triangle ? TM_OK : tm_fail_memory(error);
    }
    if (status == TM_OK)
        status = tm_surface_of_triangles(&first, (const double(*)[3])mesh->xyz,
                                         mesh->nodes, (const uint32_t(*)[3])triangle,
                                         NULL, triangles, error);
    if (status == TM_OK)
        status = tm_surface_of_triangles(
            &second, (const double(*)[3])surface->xyz, surface->nodes,
            (const uint32_t(*)[3])surface->triangle, NULL, surface->triangles, error);
    if (status == TM_OK)
        status = tm_surface_compare(comparison, &first, &second, feature_angle, error);
    free(b.face);
    free(triangle);
    tm_surface_free(&first);
    tm_surface_free(&second);
    return status;
}
