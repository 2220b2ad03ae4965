/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference: the constrained faces of a mesh as a surface that need be no manifold.
 */
#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../../surface/measure/surface_distance.h"
#include "../../surface/surface_parts.h"
#include "../../surface/surface_tree.h"
#include "envelope_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A feature that ends freely has to be so many times longer than what the surface may
 * move anyway, or this part of the diagonal. */
static const double short_curve = 16, short_of_diagonal = 0.05;

typedef struct builder {
    tm_envelope *e;
    const tm_tet_mesh *mesh;
    tm_surface *s;
    uint32_t *number; /* by node of the mesh: in the reference */
    uint32_t *face;   /* by triangle: the face */
} builder;

/* Triangles that have an edge in common. */
typedef struct side_pair {
    uint32_t side[2]; /* 3 × triangle + corner from which the edge goes */
    uint32_t count;
} side_pair;

static bool is_face(const tm_constrained_face *face)
{
    return face->side[0] != TM_NONE || face->side[1] != TM_NONE;
}

static bool allocate(builder *b)
{
    const tm_tet_mesh *mesh = b->mesh;
    size_t triangles = 0;
    for (size_t f = 0; f < mesh->faces; f++)
        triangles += is_face(&mesh->face[f]);
    tm_surface *s = calloc(1, sizeof *s);
    if (!s)
        return false;
    b->s = b->e->reference = s;
    s->xyz = tm_new(3 * triangles, sizeof *s->xyz);
    s->origin = tm_new(3 * triangles, sizeof *s->origin);
    s->triangle = tm_new(triangles, sizeof *s->triangle);
    s->across = tm_new(triangles, sizeof *s->across);
    b->face = tm_new(triangles, sizeof *b->face);
    b->number = tm_new(mesh->nodes, sizeof *b->number);
    return s->xyz && s->origin && s->triangle && s->across && b->face && b->number;
}

static void add_triangle(builder *b, uint32_t f)
{
    tm_surface *s = b->s;
    size_t t = s->triangles++;
    b->face[t] = f;
    for (int i = 0; i < 3; i++) {
        uint32_t v = b->mesh->face[f].node[i];
        if (b->number[v] == TM_NONE) {
            b->number[v] = (uint32_t)s->nodes;
            s->origin[s->nodes] = v;
            memcpy(s->xyz[s->nodes++], b->mesh->xyz[v], sizeof *s->xyz);
        }
        s->triangle[t][i] = b->number[v];
        s->across[t][i] = TM_NONE;
    }
}

static void find_box(tm_surface *s)
{
    for (int x = 0; x < 3; x++) {
        s->low[x] = HUGE_VAL;
        s->high[x] = -HUGE_VAL;
    }
    for (size_t v = 0; v < s->nodes; v++)
        for (int x = 0; x < 3; x++) {
            s->low[x] = fmin(s->low[x], s->xyz[v][x]);
            s->high[x] = fmax(s->high[x], s->xyz[v][x]);
        }
}

/* Whether an edge has a marker that says something: TetGen gives 1 to all edges between
 * facets. */
static bool is_marked(const tm_tet_mesh *mesh, uint32_t p, uint32_t q)
{
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, p, q);
    return edge && edge->marker != 0 && edge->marker != 1;
}

/* Whether two faces at an edge of the mesh may be in one patch. */
static bool are_alike(const builder *b, uint32_t t, uint32_t u, uint32_t p, uint32_t q)
{
    const tm_tet_mesh *mesh = b->mesh;
    const tm_constrained_face *f = &mesh->face[b->face[t]], *g = &mesh->face[b->face[u]];
    bool between[2] = {f->side[0] != TM_NONE && f->side[1] != TM_NONE,
                       g->side[0] != TM_NONE && g->side[1] != TM_NONE};
    return f->marker == g->marker && f->listed == g->listed && between[0] == between[1] &&
           !is_marked(mesh, p, q) && !tm_edge_map_get(&mesh->locked, p, q);
}

static void join_pairs(builder *b, const side_pair *pair, size_t pairs)
{
    tm_surface *s = b->s;
    for (size_t k = 0; k < pairs; k++) {
        uint32_t t = pair[k].side[0] / 3, i = pair[k].side[0] % 3;
        uint32_t u = pair[k].side[1] / 3, j = pair[k].side[1] % 3;
        uint32_t p = s->origin[s->triangle[t][i]];
        uint32_t q = s->origin[s->triangle[t][(i + 1) % 3]];
        if (pair[k].count != 2 || !are_alike(b, t, u, p, q))
            continue;
        s->across[t][i] = u;
        s->across[u][j] = t;
    }
}

/* Who is across an edge: where there are two triangles that are alike. */
static bool find_across(builder *b)
{
    tm_surface *s = b->s;
    tm_edge_map map = {0};
    size_t pairs = 0;
    side_pair *pair = tm_new(3 * s->triangles, sizeof *pair);
    bool done = pair && tm_edge_map_reserve(&map, 3 * s->triangles);
    for (uint32_t k = 0; k < 3 * s->triangles && done; k++) {
        uint32_t p = s->triangle[k / 3][k % 3], q = s->triangle[k / 3][(k % 3 + 1) % 3];
        uint32_t *at = tm_edge_map_get(&map, p, q);
        if (!at) {
            tm_edge_map_put(&map, p, q, (uint32_t)pairs);
            pair[pairs++] = (side_pair){{k, TM_NONE}, 1};
        } else if (++pair[*at].count == 2) {
            pair[*at].side[1] = k;
        }
    }
    if (done)
        join_pairs(b, pair, pairs);
    tm_edge_map_free(&map);
    free(pair);
    return done;
}

/* Turns triangle t round. */
static void turn(tm_surface *s, uint32_t t)
{
    uint32_t *n = s->triangle[t], *a = s->across[t], keep = n[1];
    n[1] = n[2];
    n[2] = keep;
    keep = a[0];
    a[0] = a[2];
    a[2] = keep;
}

/* Whether two neighbours go along their common edge the same way. */
static bool same_way(const tm_surface *s, uint32_t t, unsigned i, uint32_t u)
{
    uint32_t p = s->triangle[t][i], q = s->triangle[t][(i + 1) % 3];
    for (int k = 0; k < 3; k++)
        if (s->triangle[u][k] == p && s->triangle[u][(k + 1) % 3] == q)
            return true;
    return false;
}

/* Turns triangles that are connected the same way; where a piece cannot be, as a Möbius
 * strip, it is cut. */
static bool orient(tm_surface *s)
{
    tm_tet_marks done = {0};
    uint32_t *queue = tm_new(s->triangles, sizeof *queue);
    bool there = queue && tm_tet_marks_clear(&done, s->triangles);
    for (uint32_t first = 0; first < s->triangles && there; first++) {
        size_t from = 0, to = 0;
        if (!tm_tet_mark(&done, first))
            continue;
        queue[to++] = first;
        while (from < to) {
            uint32_t t = queue[from++];
            for (unsigned i = 0; i < 3; i++) {
                uint32_t u = s->across[t][i];
                if (u == TM_NONE)
                    continue;
                bool wrong = same_way(s, t, i, u);
                if (tm_tet_mark(&done, u)) {
                    queue[to++] = u;
                    if (wrong)
                        turn(s, u);
                } else if (wrong) {
                    s->across[t][i] = TM_NONE;
                    s->across[u][tm_surface_side(s, u, t)] = TM_NONE;
                }
            }
        }
    }
    tm_tet_marks_free(&done);
    free(queue);
    return there;
}

/* The feature edges of the mesh, and where nodes are on them. */
static void place_curve(builder *b, uint32_t c, const bool *is_corner, bool *on_feature)
{
    tm_surface *s = b->s;
    tm_envelope *e = b->e;
    size_t first = s->curve_start[c], last = s->curve_start[c + 1] - 1;
    const uint32_t *node = s->curve_node;
    e->closed[c] = node[first] == node[last] && !is_corner[node[first]];
    for (size_t k = first; k <= last; k++) {
        on_feature[node[k]] = true;
        if (k == last)
            continue;
        tm_edge_map_put(&e->curve, s->origin[node[k]], s->origin[node[k + 1]], c);
        if (!is_corner[node[k]])
            e->place[s->origin[node[k]]] = (double)(k - first);
    }
}

static bool place_curves(builder *b, bool *on_feature)
{
    tm_surface *s = b->s;
    tm_envelope *e = b->e;
    bool *is_corner = calloc(s->nodes + 1, sizeof *is_corner);
    e->closed = calloc(s->curves + 1, sizeof *e->closed);
    bool done = is_corner && e->closed &&
                tm_edge_map_reserve(&e->curve, s->curve_start[s->curves] + 1);
    for (size_t k = 0; k < s->corners && done; k++)
        is_corner[s->corner[k]] = on_feature[s->corner[k]] = true;
    for (uint32_t c = 0; c < s->curves && done; c++)
        place_curve(b, c, is_corner, on_feature);
    free(is_corner);
    return done;
}

/* Each node inside a patch is kept by one of its faces. */
static void keep_nodes(builder *b, const bool *on_feature, tm_tet_marks *seen)
{
    tm_surface *s = b->s;
    tm_envelope *e = b->e;
    for (uint32_t t = 0; t < s->triangles; t++) {
        e->below[b->face[t]] = t;
        for (int i = 0; i < 3; i++) {
            uint32_t v = s->triangle[t][i];
            if (on_feature[v] || !tm_tet_mark(seen, v))
                continue;
            e->next_kept[v] = e->first_kept[b->face[t]];
            e->first_kept[b->face[t]] = v;
        }
    }
}

/* The way up the tree. */
static bool find_parents(builder *b)
{
    const tm_surface_tree *tree = b->s->tree;
    tm_envelope *e = b->e;
    e->leaf = tm_new(b->s->triangles, sizeof *e->leaf);
    e->parent = tm_new(tree->nodes, sizeof *e->parent);
    e->reach = tm_new(tree->nodes, sizeof *e->reach);
    if (!e->leaf || !e->parent || !e->reach)
        return false;
    e->parent[0] = TM_NONE;
    for (uint32_t n = 0; n < tree->nodes; n++) {
        const tm_tree_node *node = &tree->node[n];
        if (node->count == 0)
            e->parent[node->first] = e->parent[node->first + 1] = n;
        for (uint32_t i = 0; i < node->count; i++)
            e->leaf[tree->triangle[node->first + i].id] = n;
    }
    return true;
}

static bool attach(builder *b)
{
    tm_surface *s = b->s;
    tm_envelope *e = b->e;
    tm_tet_marks seen = {0};
    bool *on_feature = calloc(s->nodes + 1, sizeof *on_feature);
    e->next_kept = tm_new(s->nodes, sizeof *e->next_kept);
    e->first_link = tm_new(s->triangles, sizeof *e->first_link);
    bool done = on_feature && e->next_kept && e->first_link && find_parents(b) &&
                tm_envelope_reserve(e, b->mesh->faces, b->mesh->nodes) &&
                place_curves(b, on_feature) && tm_tet_marks_clear(&seen, s->nodes);
    if (done) {
        keep_nodes(b, on_feature, &seen);
        done = tm_envelope_link_all(e, b->mesh);
    }
    free(on_feature);
    tm_tet_marks_free(&seen);
    return done;
}

static bool collect(builder *b)
{
    if (!allocate(b))
        return false;
    memset(b->number, -1, b->mesh->nodes * sizeof *b->number);
    for (uint32_t f = 0; f < b->mesh->faces; f++)
        if (is_face(&b->mesh->face[f]))
            add_triangle(b, f);
    find_box(b->s);
    return find_across(b) && orient(b->s);
}

tm_status tm_envelope_measure(const tm_envelope *envelope, const tm_tet_mesh *mesh,
                              double *most, tm_error *error)
{
    const double no_edge = 180;
    tm_envelope now = {0};
    builder b = {.e = &now, .mesh = mesh};
    tm_surface_comparison found;
    tm_status status = collect(&b) ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_surface_tree_build(b.s, error);
    if (status == TM_OK)
        status = tm_surface_compare(&found, b.s, envelope->reference, no_edge, error);
    *most = status != TM_OK
                ? 0
                : fmax(found.surface[TM_THERE].most, found.surface[TM_BACK].most);
    free(b.number);
    free(b.face);
    tm_envelope_free(&now);
    return status;
}

tm_status tm_envelope_build(tm_envelope *envelope, const tm_tet_mesh *mesh,
                            double tolerance, double feature_angle, bool unless_rough,
                            tm_error *error)
{
    builder b = {.e = envelope, .mesh = mesh};
    *envelope = (tm_envelope){.tolerance = tolerance};
    tm_status status = collect(&b) ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_surface_tree_build(b.s, error);
    double least_length =
        fmin(short_curve * tolerance,
             short_of_diagonal * sqrt(tm_distance2(b.s->low, b.s->high)));
    if (status == TM_OK)
        status = tm_surface_find_features(b.s, feature_angle, unless_rough, least_length,
                                          error);
    if (status == TM_OK) {
        tm_surface_tree_refresh(b.s);
        if (!attach(&b))
            status = tm_fail_memory(error);
    }
    free(b.number);
    free(b.face);
    return status;
}
