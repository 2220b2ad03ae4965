/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "features.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../mesh_measure.h"

#include <stdlib.h>
#include <string.h>

enum { INSIDE = 3, IN_FACET = 2, ON_EDGE = 1, FIXED = 0 };

void tm_features_free(tm_features *features)
{
    free(features->dimension);
    free(features->line);
    tm_envelope_free(&features->envelope);
    *features = (tm_features){0};
}

bool tm_features_reserve(tm_features *features, size_t nodes, size_t faces)
{
    size_t room = features->room;
    if (features->may_move && !tm_envelope_reserve(&features->envelope, faces, nodes))
        return false;
    if (nodes <= room)
        return true;
    uint8_t *dimension = tm_grow(features->dimension, &room, nodes, 1);
    features->dimension = dimension ? dimension : features->dimension;
    size_t line_room = features->room;
    uint32_t(*line)[2] = tm_grow(features->line, &line_room, room, sizeof *line);
    features->line = line ? line : features->line;
    if (!dimension || !line)
        return false;
    features->room = room;
    return true;
}

bool tm_features_copy(tm_features *to, const tm_features *from)
{
    if ((to->room < from->room && !tm_features_reserve(to, from->room, 0)) ||
        !tm_envelope_copy(&to->envelope, &from->envelope))
        return false;
    to->may_move = from->may_move;
    memcpy(to->dimension, from->dimension, from->room * sizeof *to->dimension);
    memcpy(to->line, from->line, from->room * sizeof *to->line);
    to->flatness = from->flatness;
    return true;
}

void tm_features_copy_node(tm_features *to, const tm_features *from, uint32_t node)
{
    to->dimension[node] = from->dimension[node];
    memcpy(to->line[node], from->line[node], sizeof to->line[node]);
}

/* Whether two faces at the edge ab are in one facet. */
static bool is_same_facet(const tm_tet_mesh *mesh, uint32_t f, uint32_t g, uint32_t a,
                          uint32_t b, double flatness)
{
    return tm_facet_continues(mesh, f, g, a, b,
                              tm_face_third_node(mesh->face[f].node, a, b),
                              tm_face_third_node(mesh->face[g].node, a, b), flatness);
}

/* In the map of the surface's edges: the first face at the edge, or one of these. */
#define SMOOTH  (TM_NONE - 1)
#define FEATURE (TM_NONE - 2)

static bool is_face(const tm_constrained_face *face)
{
    return face->side[0] != TM_NONE || face->side[1] != TM_NONE;
}

/* The same for patches: they are known. */
static bool map_patch_edges(const tm_features *features, const tm_tet_mesh *mesh,
                            tm_edge_map *edges)
{
    const tm_edge_map *curve = &features->envelope.curve;
    for (uint32_t f = 0; f < mesh->faces; f++) {
        const uint32_t *n = mesh->face[f].node;
        if (!is_face(&mesh->face[f]))
            continue;
        if (!tm_edge_map_reserve(edges, 3))
            return false;
        for (int i = 0; i < 3; i++) {
            uint32_t a = n[i], b = n[(i + 1) % 3];
            tm_edge_map_put(edges, a, b, tm_edge_map_get(curve, a, b) ? FEATURE : SMOOTH);
        }
    }
    return true;
}

static bool map_edges(const tm_tet_mesh *mesh, double flatness, tm_edge_map *edges)
{
    for (uint32_t f = 0; f < mesh->faces; f++) {
        const tm_constrained_face *face = &mesh->face[f];
        if (!is_face(face))
            continue;
        if (!tm_edge_map_reserve(edges, 3))
            return false;
        for (int i = 0; i < 3; i++) {
            uint32_t a = face->node[i], b = face->node[(i + 1) % 3];
            uint32_t *other = tm_edge_map_get(edges, a, b);
            if (!other)
                tm_edge_map_put(edges, a, b, f);
            else if (*other < FEATURE && is_same_facet(mesh, f, *other, a, b, flatness))
                *other = SMOOTH;
            else
                *other = FEATURE;
        }
    }
    return true;
}

/* Node v gets a feature edge to w. A third one makes it a corner. */
static void add_feature_edge(tm_features *features, uint32_t v, uint32_t w)
{
    uint32_t *line = features->line[v];
    if (features->dimension[v] == FIXED)
        return;
    if (line[0] == TM_NONE)
        line[0] = w;
    else if (line[1] == TM_NONE)
        line[1] = w;
    else
        features->dimension[v] = FIXED;
}

static int32_t edge_marker(const tm_tet_mesh *mesh, uint32_t a, uint32_t b)
{
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, a, b);
    return edge ? edge->marker : 0;
}

/* Whether node v is between its two neighbours on a straight edge of one marker. */
static bool is_straight(const tm_features *features, const tm_tet_mesh *mesh, uint32_t v)
{
    const uint32_t *line = features->line[v];
    if (line[0] == TM_NONE || line[1] == TM_NONE)
        return false;
    double u[3], w[3], across[3];
    tm_subtract(u, mesh->xyz[line[0]], mesh->xyz[v]);
    tm_subtract(w, mesh->xyz[line[1]], mesh->xyz[v]);
    tm_cross(across, u, w);
    double longer = sqrt(fmax(tm_norm2(u), tm_norm2(w)));
    return tm_dot(u, w) < 0 && tm_norm(across) <= features->flatness * longer &&
           edge_marker(mesh, v, line[0]) == edge_marker(mesh, v, line[1]);
}

static void place_surface_nodes(tm_features *features, const tm_tet_mesh *mesh,
                                const tm_edge_map *edges)
{
    for (size_t s = 0; s < edges->room; s++) {
        const tm_edge_slot *slot = &edges->slot[s];
        uint32_t a = (uint32_t)(slot->key >> 32), b = (uint32_t)slot->key;
        if (slot->key == 0)
            continue;
        for (int i = 0; i < 2; i++) {
            uint32_t v = i ? a : b;
            if (features->dimension[v] == INSIDE)
                features->dimension[v] = IN_FACET;
            if (slot->value != SMOOTH)
                add_feature_edge(features, v, i ? b : a);
        }
    }
    for (uint32_t v = 0; v < mesh->nodes; v++)
        if (features->line[v][0] != TM_NONE && features->dimension[v] == IN_FACET)
            features->dimension[v] = is_straight(features, mesh, v) ? ON_EDGE : FIXED;
}

/* Fixes the nodes of marked edges inside, of rows of .face that are no faces, and of
 * edges where the mesh only touches itself. */
static void fix_listed(tm_features *features, const tm_tet_mesh *mesh,
                       const tm_edge_map *surface)
{
    for (size_t e = 0; e < mesh->edges; e++) {
        const uint32_t *n = mesh->edge[e].node;
        if (mesh->edge[e].marker != 0 && !tm_edge_map_get(surface, n[0], n[1]))
            features->dimension[n[0]] = features->dimension[n[1]] = FIXED;
    }
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3; i++)
            if (!is_face(&mesh->face[f]))
                features->dimension[mesh->face[f].node[i]] = FIXED;
    for (size_t s = 0; s < mesh->locked.room; s++)
        if (mesh->locked.slot[s].key != 0) {
            features->dimension[mesh->locked.slot[s].key >> 32] = FIXED;
            features->dimension[(uint32_t)mesh->locked.slot[s].key] = FIXED;
        }
}

/* Fixes nodes whose marker says more than where they are. */
static void fix_marked(tm_features *features, const tm_tet_mesh *mesh,
                       const tm_edge_map *edges)
{
    const uint8_t unlike = 0x80; /* until all edges have been looked at */
    uint8_t *dimension = features->dimension;
    const int32_t *marker = mesh->node_marker;
    if (!marker)
        return;
    for (size_t s = 0; s < edges->room; s++) {
        uint64_t key = edges->slot[s].key;
        uint32_t a = (uint32_t)(key >> 32), b = (uint32_t)key;
        int place = edges->slot[s].value == SMOOTH ? IN_FACET : ON_EDGE;
        if (key != 0 && marker[a] != marker[b] && (dimension[a] & ~unlike) == place &&
            (dimension[b] & ~unlike) == place) {
            dimension[a] |= unlike;
            dimension[b] |= unlike;
        }
    }
    for (size_t v = 0; v < mesh->nodes; v++)
        if (dimension[v] & unlike || (dimension[v] == INSIDE && marker[v] != 0))
            dimension[v] = FIXED;
}

/* Fixes the surface nodes in which the mesh only touches itself: those whose tetrahedra
 * are not all reached from one of them. */
static tm_status fix_touching(tm_features *features, const tm_tet_mesh *mesh,
                              tm_tet_marks *marks, tm_error *error)
{
    uint32_t *count = calloc(mesh->nodes + 1, sizeof *count);
    tm_ball ball = {0};
    tm_status status = count ? TM_OK : tm_fail_memory(error);
    for (uint32_t t = 0; t < mesh->slots && status == TM_OK; t++)
        for (int i = 0; i < 4 && tm_tet_lives(mesh, t); i++)
            count[mesh->tet[t][i]]++;
    for (uint32_t t = 0; t < mesh->slots && status == TM_OK; t++)
        for (int i = 0; i < 4 && tm_tet_lives(mesh, t); i++) {
            uint32_t v = mesh->tet[t][i];
            if (features->dimension[v] == INSIDE || features->dimension[v] == FIXED ||
                count[v] == 0)
                continue;
            if (!tm_ball_around(mesh, t, v, marks, &ball)) {
                status = tm_fail_memory(error);
                break;
            }
            if (ball.size != count[v])
                features->dimension[v] = FIXED;
            count[v] = 0; /* done */
        }
    tm_ball_free(&ball);
    free(count);
    return status;
}

/* Nodes are in patches, on curves, or corners. */
static void place_envelope_nodes(tm_features *features)
{
    const tm_surface *reference = features->envelope.reference;
    const uint32_t *origin = reference->origin;
    for (size_t v = 0; v < reference->nodes; v++)
        features->dimension[origin[v]] = IN_FACET;
    for (uint32_t c = 0; c < reference->curves; c++) {
        size_t first = reference->curve_start[c],
               last = reference->curve_start[c + 1] - 1;
        const uint32_t *node = reference->curve_node;
        for (size_t k = first; k < last; k++) {
            uint32_t v = origin[node[k]];
            if (k == first && !features->envelope.closed[c])
                continue;
            features->dimension[v] = ON_EDGE;
            features->line[v][0] = origin[node[k == first ? last - 1 : k - 1]];
            features->line[v][1] = origin[node[k + 1]];
        }
    }
    for (size_t k = 0; k < reference->corners; k++)
        features->dimension[origin[reference->corner[k]]] = FIXED;
}

static tm_status find_places(tm_features *features, const tm_tet_mesh *mesh,
                             const tm_surface_limits *limits, tm_edge_map *edges,
                             tm_error *error)
{
    bool any_face = false, done;
    for (size_t f = 0; f < mesh->faces && !any_face; f++)
        any_face = is_face(&mesh->face[f]);
    features->may_move = any_face && limits && limits->tolerance > 0;
    if (features->may_move) {
        tm_status status =
            tm_envelope_build(&features->envelope, mesh, limits->tolerance,
                              limits->feature_angle, limits->unless_rough, error);
        if (status != TM_OK)
            return status;
        done = map_patch_edges(features, mesh, edges);
    } else {
        done = map_edges(mesh, features->flatness, edges);
    }
    if (!done)
        return tm_fail_memory(error);
    if (features->may_move)
        place_envelope_nodes(features);
    else
        place_surface_nodes(features, mesh, edges);
    fix_marked(features, mesh, edges);
    fix_listed(features, mesh, edges);
    return TM_OK;
}

static tm_status find(tm_features *features, const tm_tet_mesh *mesh,
                      const tm_surface_limits *limits, double flatness,
                      tm_tet_marks *marks, tm_error *error)
{
    tm_edge_map edges = {0};
    *features = (tm_features){.flatness = flatness};
    if (!tm_features_reserve(features, mesh->nodes + 1, 0))
        return tm_fail_memory(error);
    memset(features->dimension, INSIDE, mesh->nodes);
    for (size_t v = 0; v < mesh->nodes; v++)
        features->line[v][0] = features->line[v][1] = TM_NONE;
    tm_status status = find_places(features, mesh, limits, &edges, error);
    tm_edge_map_free(&edges);
    return status == TM_OK ? fix_touching(features, mesh, marks, error) : status;
}

tm_status tm_features_find(tm_features *features, const tm_tet_mesh *mesh,
                           const tm_surface_limits *limits, tm_tet_marks *marks,
                           tm_error *error)
{
    return find(features, mesh, limits, tm_facet_flatness(mesh), marks, error);
}

tm_status tm_features_find_in_part(tm_features *features, const tm_tet_mesh *part,
                                   double flatness, tm_tet_marks *marks, tm_error *error)
{
    return find(features, part, NULL, flatness, marks, error);
}

/* The normal of the facet that the node of a ball is in, of unit length. */
static void facet_normal(const tm_tet_mesh *mesh, const tm_ball *ball, double normal[3])
{
    memset(normal, 0, 3 * sizeof *normal);
    for (size_t k = 0; k < ball->constrained_count; k++) {
        const uint32_t *n = mesh->face[ball->constrained[k]].node;
        double of_face[3];
        tm_triangle_normal(of_face, mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]]);
        double sign = tm_dot(of_face, normal) < 0 ? -1 : 1;
        for (int x = 0; x < 3; x++)
            normal[x] += sign * of_face[x];
    }
    double length = tm_norm(normal);
    for (int x = 0; x < 3; x++)
        normal[x] /= length;
}

tm_freedom tm_features_freedom(const tm_features *features, const tm_tet_mesh *mesh,
                               const tm_ball *ball)
{
    tm_freedom freedom = {.dimension = features->dimension[ball->node]};
    double *d = freedom.direction;
    if (freedom.dimension == IN_FACET)
        facet_normal(mesh, ball, d);
    if (freedom.dimension == ON_EDGE) {
        const uint32_t *line = features->line[ball->node];
        tm_subtract(d, mesh->xyz[line[1]], mesh->xyz[line[0]]);
        double length = tm_norm(d);
        for (int x = 0; x < 3; x++)
            d[x] /= length;
    }
    if (freedom.dimension < INSIDE && !(tm_norm2(d) > 0))
        freedom.dimension = FIXED; /* no direction */
    return freedom;
}

static bool has_line_to(const tm_features *features, uint32_t a, uint32_t b)
{
    return features->dimension[a] == ON_EDGE &&
           (features->line[a][0] == b || features->line[a][1] == b);
}

tm_edge_class tm_features_classify(const tm_features *features, const tm_tet_mesh *mesh,
                                   const tm_star *star, size_t constrained[2])
{
    uint32_t a = star->a, b = star->b, face[2] = {0, 0};
    size_t count = 0;
    if (!star->constrained_face)
        return tm_star_is_free(mesh, star) ? TM_EDGE_INSIDE : TM_EDGE_OF_FEATURE;
    for (size_t i = 0; i < star->size + !star->closed; i++) {
        uint32_t f = tm_star_face(mesh, star, i);
        if (f == TM_NONE)
            continue;
        if (count == 2)
            return TM_EDGE_OF_FEATURE;
        constrained[count] = i;
        face[count++] = f;
    }
    if (count < 2 || has_line_to(features, a, b) || has_line_to(features, b, a))
        return TM_EDGE_OF_FEATURE;
    if (features->may_move)
        return tm_edge_map_get(&features->envelope.curve, a, b) ? TM_EDGE_OF_FEATURE
                                                                : TM_EDGE_IN_FACET;
    return is_same_facet(mesh, face[0], face[1], a, b, features->flatness)
               ? TM_EDGE_IN_FACET
               : TM_EDGE_OF_FEATURE;
}

static void replace_on_line(tm_features *features, uint32_t v, uint32_t old, uint32_t new)
{
    for (int i = 0; i < 2; i++)
        if (features->line[v][i] == old)
            features->line[v][i] = new;
}

void tm_features_classify_node(tm_features *features, uint32_t node, tm_edge_class place,
                               uint32_t a, uint32_t b)
{
    features->line[node][0] = features->line[node][1] = TM_NONE;
    features->dimension[node] = place == TM_EDGE_INSIDE     ? INSIDE
                                : place == TM_EDGE_IN_FACET ? IN_FACET
                                                            : ON_EDGE;
    if (features->may_move)
        tm_envelope_put_node(&features->envelope, node, NAN);
    if (place != TM_EDGE_OF_FEATURE)
        return;
    bool forward = true;
    tm_curve_part part;
    if (features->may_move && tm_features_part(features, a, b, &part)) {
        tm_envelope *e = &features->envelope;
        forward = part.node[0] == a;
        tm_envelope_put_edge(e, a, b, TM_NONE);
        tm_envelope_put_edge(e, a, node, part.curve);
        tm_envelope_put_edge(e, node, b, part.curve);
    }
    features->line[node][0] = forward ? a : b;
    features->line[node][1] = forward ? b : a;
    replace_on_line(features, a, b, node);
    replace_on_line(features, b, a, node);
}

uint32_t tm_features_beyond(const tm_features *features, uint32_t a, uint32_t b)
{
    const uint32_t *line = features->line[a];
    return line[0] == b ? line[1] : line[0];
}

void tm_features_join(tm_features *features, uint32_t a, uint32_t b)
{
    uint32_t beyond = tm_features_beyond(features, a, b);
    tm_curve_part part;
    if (features->may_move && tm_features_part(features, a, b, &part)) {
        tm_envelope *e = &features->envelope;
        tm_envelope_put_edge(e, a, b, TM_NONE);
        tm_envelope_put_edge(e, a, beyond, TM_NONE);
        tm_envelope_put_edge(e, b, beyond, part.curve);
    }
    replace_on_line(features, b, a, beyond);
    replace_on_line(features, beyond, a, b);
}

/* Whether a node is between the ends of its curve. */
static bool is_between_ends(const tm_features *features, uint32_t v)
{
    return !isnan(features->envelope.place[v]);
}

bool tm_features_part(const tm_features *features, uint32_t a, uint32_t b,
                      tm_curve_part *part)
{
    const tm_envelope *e = &features->envelope;
    const uint32_t *curve = tm_edge_map_get(&e->curve, a, b);
    if (!curve)
        return false;
    bool forward = is_between_ends(features, a)   ? features->line[a][1] == b
                   : is_between_ends(features, b) ? features->line[b][0] == a
                                                  : tm_envelope_begins(e, *curve) == a;
    uint32_t first = forward ? a : b, second = forward ? b : a;
    double segments = (double)tm_envelope_segments(e, *curve);
    *part = (tm_curve_part){*curve, {first, second}, {0, segments}};
    if (is_between_ends(features, first))
        part->place[0] = e->place[first];
    if (is_between_ends(features, second))
        part->place[1] = e->place[second];
    if (part->place[1] <= part->place[0])
        part->place[1] += segments;
    return true;
}

void tm_features_put(tm_features *features, uint32_t v, uint32_t curve, double place)
{
    double segments = (double)tm_envelope_segments(&features->envelope, curve);
    bool again = tm_envelope_is_closed(&features->envelope, curve) && place >= segments;
    tm_envelope_put_node(&features->envelope, v, again ? place - segments : place);
}
