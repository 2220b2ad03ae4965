/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No change of a surface makes a sharp edge within a patch, or a feature edge blunt:
 * normals of triangles side by side differ by no more than the feature angle in a patch,
 * and by no less at a feature edge that is one by its angle; or than those did that go.
 */
#include "../../geom/vector.h"
#include "improve_engine.h"

/* The cosine of the angle between the normals of triangles abc and bad. */
static double cosine(const tm_improver *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const double(*x)[3] = (const double(*)[3])m->mesh->xyz;
    double of_c[3], of_d[3];
    tm_triangle_normal(of_c, x[a], x[b], x[c]);
    tm_triangle_normal(of_d, x[b], x[a], x[d]);
    /* The product of the two squares may be too large for a double. */
    double of_c2 = tm_norm2(of_c), size = of_c2 * sqrt(tm_norm2(of_d) / of_c2);
    return size > 0 ? tm_dot(of_c, of_d) / size : 1;
}

/* The face beyond edge ab of a face, where there is one more and that is alike; TM_NONE.
 */
static uint32_t face_beyond(tm_improver *m, uint32_t f, uint32_t a, uint32_t b)
{
    const tm_constrained_face *face = &m->mesh->face[f];
    uint32_t t = face->side[face->side[0] == TM_NONE] / 4, beyond = TM_NONE;
    if (!tm_star_between(m->mesh, t, a, b, &m->around)) {
        tm_improve_no_memory(m);
        return TM_NONE;
    }
    for (size_t k = 0; k < m->around.size + !m->around.closed; k++) {
        uint32_t other = tm_star_face(m->mesh, &m->around, k);
        if (other == TM_NONE || other == f)
            continue;
        if (beyond != TM_NONE || m->mesh->face[other].marker != face->marker)
            return TM_NONE;
        beyond = other;
    }
    return beyond;
}

static bool is_on_curve(const tm_improver *m, uint32_t a, uint32_t b)
{
    return tm_edge_map_get(&m->features.envelope.curve, a, b) != NULL;
}

void tm_improve_look_at_bends(tm_improver *m)
{
    const tm_surface_change *c = &m->change_of_surface;
    tm_improve_bends *bends = &m->bends;
    bends->least = bends->most = m->least_cosine;
    bends->count = 0;
    for (size_t i = 0; i < c->olds; i++) {
        const uint32_t *n = m->mesh->face[c->old[i]].node;
        for (int k = 0; k < 3; k++) {
            uint32_t a = n[k], b = n[(k + 1) % 3],
                     beyond = face_beyond(m, c->old[i], a, b);
            if (beyond == TM_NONE)
                continue;
            uint32_t d = tm_face_third_node(m->mesh->face[beyond].node, a, b);
            double old = cosine(m, a, b, n[(k + 2) % 3], d);
            if (is_on_curve(m, a, b))
                bends->most = old > bends->most ? old : bends->most;
            else
                bends->least = old < bends->least ? old : bends->least;
            if (!tm_surface_change_takes(c, beyond) && bends->count < 3 * TM_CHANGE_MOST)
                bends->edge[bends->count++] = (tm_improve_bend){{a, b}, d, c->old[i]};
        }
    }
}

/* The node beyond edge ab of triangle k of the change; TM_NONE where that is not known.
 * Whether it is in another patch, too. */
static uint32_t node_beyond(const tm_improver *m, size_t k, uint32_t a, uint32_t b,
                            bool *is_curve)
{
    const tm_surface_change *c = &m->change_of_surface;
    const tm_envelope *e = &m->features.envelope;
    const uint32_t *patch = e->reference->patch, own = patch[e->below[c->from[k]]];
    *is_curve = is_on_curve(m, a, b);
    for (size_t i = 0; i < m->bends.count; i++) {
        const tm_improve_bend *bend = &m->bends.edge[i];
        if (tm_edge_key(bend->node[0], bend->node[1]) == tm_edge_key(a, b) &&
            patch[e->below[bend->face]] == own)
            return bend->beyond;
    }
    uint32_t found = TM_NONE;
    for (size_t i = 0; i < c->count; i++) {
        if (i == k || !tm_face_has_node(c->node[i], a) ||
            !tm_face_has_node(c->node[i], b))
            continue;
        if (found != TM_NONE)
            return TM_NONE;
        found = tm_face_third_node(c->node[i], a, b);
        *is_curve = patch[e->below[c->from[i]]] != own;
        if (m->mesh->face[c->from[i]].marker != m->mesh->face[c->from[k]].marker)
            return TM_NONE;
    }
    return found;
}

bool tm_improve_bends_more(const tm_improver *m)
{
    const tm_surface_change *c = &m->change_of_surface;
    const double rounding = 1e-9;
    for (size_t k = 0; k < c->count; k++)
        for (int i = 0; i < 3; i++) {
            bool is_curve;
            const uint32_t *n = c->node[k];
            uint32_t a = n[i], b = n[(i + 1) % 3], d = node_beyond(m, k, a, b, &is_curve);
            if (d == TM_NONE)
                continue;
            double now = cosine(m, a, b, n[(i + 2) % 3], d);
            if (is_curve ? now > m->bends.most + rounding
                         : now < m->bends.least - rounding)
                return true;
        }
    return false;
}
