/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the improver's operations do to a surface that may move within its envelope. */
#include "../operation/peel.h"
#include "improve_engine.h"

#include <string.h>

static tm_surface_change *start_change(tm_improver *m)
{
    m->change_of_surface.olds = m->change_of_surface.count = 0;
    return &m->change_of_surface;
}

/* Triangle pqr will be constrained face `face`, in the patch of the old face `from`. */
static bool add_triangle(tm_surface_change *c, uint32_t p, uint32_t q, uint32_t r,
                         uint32_t face, uint32_t from)
{
    if (c->count == TM_CHANGE_MOST)
        return false;
    memcpy(c->node[c->count], (uint32_t[3]){p, q, r}, sizeof c->node[0]);
    c->face[c->count] = face;
    c->from[c->count++] = from;
    return true;
}

static bool add_old(tm_surface_change *c, uint32_t face)
{
    if (c->olds == TM_CHANGE_MOST)
        return false;
    c->old[c->olds++] = face;
    return true;
}

/* Whether the change, with all nodes where they will be, keeps within the envelope. */
static bool is_within(tm_improver *m)
{
    return !tm_improve_bends_more(m) &&
           tm_envelope_allows(&m->features.envelope, m->mesh, &m->change_of_surface);
}

static bool is_allowed(tm_improver *m)
{
    tm_improve_look_at_bends(m);
    return is_within(m);
}

/* The same with node v, which may be one to be made, at p. */
static bool is_allowed_at(tm_improver *m, uint32_t v, const double p[3])
{
    double old[3];
    tm_improve_look_at_bends(m);
    memcpy(old, m->mesh->xyz[v], sizeof old);
    memcpy(m->mesh->xyz[v], p, sizeof old);
    bool allowed = is_within(m);
    memcpy(m->mesh->xyz[v], old, sizeof old);
    return allowed;
}

/* The constrained faces of a ball become old ones, each once. */
static bool add_old_of(tm_surface_change *c, const tm_ball *ball)
{
    for (size_t k = 0; k < ball->constrained_count; k++) {
        size_t i = 0;
        while (i < c->olds && c->old[i] != ball->constrained[k])
            i++;
        if (i == c->olds && !add_old(c, ball->constrained[k]))
            return false;
    }
    return true;
}

/* Whether nodes r and s, in a tetrahedron t with r, are neighbours. */
static bool are_neighbours(tm_improver *m, uint32_t t, uint32_t r, uint32_t s)
{
    if (!tm_ball_around(m->mesh, t, r, &m->marks, &m->other_ball))
        return !tm_improve_no_memory(m);
    for (size_t k = 0; k < m->other_ball.size; k++)
        if (tm_face_has_node(m->other_ball.face[k], s))
            return true;
    return false;
}

bool tm_improve_allows_swap(tm_improver *m, const tm_star *part, int parts)
{
    tm_face_renewal renewal[2];
    tm_surface_change *c = start_change(m);
    bool peeled = false;
    tm_edge_removal_renewals(m->mesh, &part[0], true, renewal);
    for (int i = 0; i < 2; i++) {
        const uint32_t *n = renewal[i].node;
        add_old(c, renewal[i].face);
        add_triangle(c, n[0], n[1], n[2], renewal[i].face, renewal[i].face);
    }
    for (int k = 0; k < parts; k++) {
        if (part[k].size > 1)
            continue;
        peeled = true;
        if (!tm_peel_is_possible(m->mesh, &part[k], &m->around))
            return false;
    }
    uint32_t r = part[0].ring[0], s = part[0].ring[part[0].size];
    return (peeled || !are_neighbours(m, part[0].tet[0], r, s)) && is_allowed(m);
}

/* Whether a node of the ball's faces is in the list. */
static bool is_listed(const uint32_t *list, size_t count, uint32_t v)
{
    for (size_t i = 0; i < count; i++)
        if (list[i] == v)
            return true;
    return false;
}

enum { RING_MOST = 64 };

/* The nodes of the tetrahedra at edge ab, from the ball of a; more than RING_MOST: too
 * many. */
static size_t find_ring(const tm_ball *ball, uint32_t b, uint32_t ring[RING_MOST])
{
    size_t count = 0;
    for (size_t k = 0; k < ball->size; k++)
        for (int i = 0; i < 3 && tm_face_has_node(ball->face[k], b); i++) {
            uint32_t v = ball->face[k][i];
            if (v == b || is_listed(ring, count, v))
                continue;
            if (count == RING_MOST)
                return count + 1;
            ring[count++] = v;
        }
    return count;
}

/* Whether one of the ball's faces has both nodes, and the third, or any one. */
static bool has_link(const tm_ball *ball, uint32_t v, uint32_t w, uint32_t third)
{
    for (size_t k = 0; k < ball->size; k++)
        if (tm_face_has_node(ball->face[k], v) && tm_face_has_node(ball->face[k], w) &&
            (third == TM_NONE || tm_face_has_node(ball->face[k], third)))
            return true;
    return false;
}

/* What a and b are both joined to is joined to their edge: nodes, and edges (the link
 * condition: T. K. Dey, H. Edelsbrunner, S. Guha, D. Nekhayev, Topology preserving edge
 * contraction, 1999). Of triangles orientations say it. */
static bool links_are_common(tm_improver *m, uint32_t b)
{
    const tm_ball *of_a = &m->ball, *of_b = &m->other_ball;
    uint32_t ring[RING_MOST], a = of_a->node;
    size_t count = find_ring(of_a, b, ring);
    if (count > RING_MOST)
        return false;
    if (!tm_tet_marks_clear(&m->linked, m->mesh->nodes))
        return tm_improve_no_memory(m);
    for (size_t k = 0; k < of_a->size; k++)
        for (int i = 0; i < 3; i++)
            tm_tet_mark(&m->linked, of_a->face[k][i]);
    for (size_t k = 0; k < of_b->size; k++)
        for (int i = 0; i < 3; i++) {
            uint32_t v = of_b->face[k][i];
            if (v != a && tm_tet_is_marked(&m->linked, v) && !is_listed(ring, count, v))
                return false;
        }
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++)
            if (has_link(of_a, ring[i], ring[j], TM_NONE) &&
                has_link(of_b, ring[i], ring[j], TM_NONE) &&
                !has_link(of_a, ring[i], ring[j], b))
                return false;
    return true;
}

/* Whether a constrained face of a ball has the nodes v and w beside the ball's. */
static bool has_face(const tm_improver *m, const tm_ball *ball, uint32_t v, uint32_t w)
{
    for (size_t k = 0; k < ball->constrained_count; k++) {
        const uint32_t *n = m->mesh->face[ball->constrained[k]].node;
        if (tm_face_has_node(n, v) && tm_face_has_node(n, w))
            return true;
    }
    return false;
}

/* The same of the surface alone. */
static bool surface_links_are_common(const tm_improver *m, uint32_t b)
{
    const tm_ball *of_a = &m->ball, *of_b = &m->other_ball;
    uint32_t a = of_a->node;
    for (size_t k = 0; k < of_a->constrained_count; k++) {
        const uint32_t *n = m->mesh->face[of_a->constrained[k]].node;
        if (tm_face_has_node(n, b))
            continue;
        const int at = n[0] == a ? 0 : n[1] == a ? 1 : 2;
        const uint32_t link[2] = {n[(at + 1) % 3], n[(at + 2) % 3]};
        if (has_face(m, of_b, link[0], link[1]))
            return false;
        for (int i = 0; i < 2; i++)
            if (has_face(m, of_b, link[i], link[i]) && !has_face(m, of_a, link[i], b))
                return false;
    }
    return true;
}

/* Whether the curve that a is on may go from b on to the node beyond a. */
static bool allows_join(const tm_improver *m, uint32_t a, uint32_t b)
{
    const tm_features *features = &m->features;
    uint32_t beyond = tm_features_beyond(features, a, b);
    tm_curve_part to_b, from_a;
    if (!tm_features_part(features, a, b, &to_b) ||
        !tm_features_part(features, a, beyond, &from_a) ||
        tm_edge_map_get(&features->envelope.curve, b, beyond))
        return false;
    const tm_curve_part *first = to_b.node[1] == a ? &to_b : &from_a;
    const tm_curve_part *second = first == &to_b ? &from_a : &to_b;
    double end = first->place[1] + (second->place[1] - second->place[0]);
    const double(*x)[3] = (const double(*)[3])m->mesh->xyz;
    return tm_envelope_allows_edge(&features->envelope, to_b.curve, first->place[0], end,
                                   x[first->node[0]], x[second->node[1]]);
}

static bool plan_contraction(tm_improver *m, uint32_t b)
{
    const tm_ball *ball = &m->ball;
    uint32_t a = ball->node;
    tm_surface_change *c = start_change(m);
    if (!add_old_of(c, ball))
        return false;
    for (size_t i = 0; i < c->olds; i++) {
        const uint32_t *n = m->mesh->face[c->old[i]].node;
        if (!tm_face_has_node(n, b) &&
            !add_triangle(c, n[0] == a ? b : n[0], n[1] == a ? b : n[1],
                          n[2] == a ? b : n[2], c->old[i], c->old[i]))
            return false;
    }
    return true;
}

bool tm_improve_allows_contraction(tm_improver *m, uint32_t b)
{
    uint32_t a = m->ball.node, t = m->ball.tet[0];
    if (m->features.dimension[a] == 1 && !allows_join(m, a, b))
        return false;
    for (size_t k = 0; k < m->ball.size; k++)
        if (tm_face_has_node(m->ball.face[k], b))
            t = m->ball.tet[k];
    if (!plan_contraction(m, b))
        return false;
    if (!tm_ball_around(m->mesh, t, b, &m->marks, &m->other_ball))
        return tm_improve_no_memory(m);
    return surface_links_are_common(m, b) && links_are_common(m, b) && is_allowed(m);
}

/* What is of a curve between the neighbours on it of node v. */
static bool find_span(const tm_features *features, uint32_t v, tm_curve_part *span)
{
    const uint32_t *line = features->line[v];
    tm_curve_part after;
    if (!tm_features_part(features, line[0], v, span) ||
        !tm_features_part(features, v, line[1], &after))
        return false;
    span->place[1] += after.place[1] - after.place[0];
    span->node[1] = line[1];
    return true;
}

/* Whether a node between the ends of a part of a curve may be at p, which is that place
 * of the curve. */
static bool allows_on_curve(const tm_improver *m, const tm_curve_part *part,
                            const double p[3], double place)
{
    const tm_envelope *e = &m->features.envelope;
    const double(*x)[3] = (const double(*)[3])m->mesh->xyz;
    const double from = part->place[0], to = part->place[1];
    return from < place && place < to &&
           tm_envelope_allows_edge(e, part->curve, from, place, x[part->node[0]], p) &&
           tm_envelope_allows_edge(e, part->curve, place, to, p, x[part->node[1]]);
}

bool tm_improve_onto_surface(tm_improver *m, double p[3], double *place)
{
    const tm_features *features = &m->features;
    uint32_t v = m->ball.node;
    tm_curve_part span;
    if (features->dimension[v] == 2) {
        tm_envelope_onto_patch(&features->envelope, m->ball.constrained[0], p);
        return true;
    }
    if (!find_span(features, v, &span))
        return false;
    *place = tm_envelope_onto_curve(&features->envelope, span.curve, span.place[0],
                                    span.place[1], p);
    return true;
}

bool tm_improve_allows_move(tm_improver *m, const double p[3], double place)
{
    uint32_t v = m->ball.node;
    tm_surface_change *c = start_change(m);
    tm_curve_part span;
    if (m->features.dimension[v] == 1 &&
        (!find_span(&m->features, v, &span) || !allows_on_curve(m, &span, p, place)))
        return false;
    if (!add_old_of(c, &m->ball))
        return false;
    for (size_t i = 0; i < c->olds; i++) {
        const uint32_t *n = m->mesh->face[c->old[i]].node;
        add_triangle(c, n[0], n[1], n[2], c->old[i], c->old[i]);
    }
    return is_allowed_at(m, v, p);
}

void tm_improve_split_onto_surface(tm_improver *m, double p[3], double *place)
{
    const tm_star *star = &m->star;
    tm_curve_part part;
    if (tm_features_part(&m->features, star->a, star->b, &part)) {
        *place = tm_envelope_onto_curve(&m->features.envelope, part.curve, part.place[0],
                                        part.place[1], p);
        return;
    }
    for (size_t i = 0; i < star->size + !star->closed; i++) {
        uint32_t face = tm_star_face(m->mesh, star, i);
        if (face == TM_NONE)
            continue;
        tm_envelope_onto_patch(&m->features.envelope, face, p);
        return;
    }
}

/* The node that will be made next. */
static uint32_t next_node(const tm_tet_mesh *mesh)
{
    return mesh->removed_nodes > 0 ? mesh->last_removed : (uint32_t)mesh->nodes;
}

static bool plan_split_faces(tm_improver *m, uint32_t v)
{
    const tm_star *star = &m->star;
    tm_surface_change *c = start_change(m);
    uint32_t new_face = (uint32_t)m->mesh->faces;
    for (size_t i = 0; i < star->size + !star->closed; i++) {
        uint32_t face = tm_star_face(m->mesh, star, i), upper[3], lower[3];
        if (face == TM_NONE)
            continue;
        for (int k = 0; k < 3; k++) {
            uint32_t n = m->mesh->face[face].node[k];
            lower[k] = n == star->b ? v : n;
            upper[k] = n == star->a ? v : n;
        }
        if (!add_old(c, face) ||
            !add_triangle(c, lower[0], lower[1], lower[2], face, face) ||
            !add_triangle(c, upper[0], upper[1], upper[2], new_face++, face))
            return false;
    }
    return true;
}

bool tm_improve_allows_split(tm_improver *m, const double p[3], double place)
{
    const tm_star *star = &m->star;
    uint32_t v = next_node(m->mesh);
    tm_curve_part part;
    if (tm_features_part(&m->features, star->a, star->b, &part) &&
        !allows_on_curve(m, &part, p, place))
        return false;
    if (!tm_improve_reserve(m, 2 * star->size, 1) || !plan_split_faces(m, v))
        return false;
    return is_allowed_at(m, v, p);
}

bool tm_improve_allows_peel(tm_improver *m, uint32_t t, uint32_t i)
{
    const uint32_t *n = m->mesh->tet[t];
    tm_surface_change *c = start_change(m);
    uint32_t face = m->mesh->neighbour[t][i] & ~TM_FACE_BIT, corner[3];
    uint32_t new_face = (uint32_t)m->mesh->faces;
    add_old(c, face);
    tm_tet_face_below(m->mesh, t, i, corner);
    /* In the order in which tm_peel_face() makes them. */
    for (uint32_t k = 0; k < 4; k++) {
        if (k == i)
            continue;
        uint32_t p[3];
        for (int s = 0; s < 3; s++)
            p[s] = corner[s] == n[k] ? n[i] : corner[s];
        add_triangle(c, p[0], p[1], p[2], c->count == 0 ? face : new_face++, face);
    }
    return is_allowed(m);
}

void tm_improve_follow_surface(tm_improver *m)
{
    if (!tm_envelope_follow(&m->features.envelope, m->mesh, &m->change_of_surface))
        tm_improve_no_memory(m);
}
