/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_forced.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../element/jens.h"
#include "../../element/shape.h"
#include "../../geom/vector.h"
#include "../layer/octree_mesh_stream.h"
#include "../../mesh/mixed_boundary.h"

#include <math.h>
#include <stdlib.h>

static const double enough = 0.5; /* of what is possible */

/* An element with those of its faces that are on the boundary, as bits. */
typedef struct {
    const tm_repair_state *state;
    const tm_element_shape *shape;
    const uint32_t *item;
    unsigned open;
} candidate;

static bool is_sharp(const candidate *c, unsigned corner)
{
    const uint32_t v = c->item[corner];
    return c->state->on[v] >= TM_NODE_ON_CURVE && !c->state->rule[v].off_surface;
}

/* Whether two faces have an edge with both ends on sharp edges in common. */
static bool meet_sharply(const candidate *c, unsigned f, unsigned g)
{
    unsigned common = 0;
    for (size_t i = 0; i < tm_mixed_face_nodes(c->shape->face[f]); i++)
        for (size_t j = 0; j < tm_mixed_face_nodes(c->shape->face[g]); j++)
            common += c->shape->face[f][i] == c->shape->face[g][j] &&
                      is_sharp(c, c->shape->face[f][i]);
    return common == 2;
}

/* The normal of a face, outward. */
static void normal_of(const candidate *c, unsigned f, double normal[3])
{
    const double(*xyz)[3] = (const double(*)[3])c->state->mesh.xyz;
    const uint8_t *corner = c->shape->face[f];
    const size_t k = tm_mixed_face_nodes(corner);
    double a[3], b[3];
    tm_subtract(a, xyz[c->item[corner[k == 3 ? 1 : 2]]], xyz[c->item[corner[0]]]);
    tm_subtract(b, xyz[c->item[corner[k - 1]]], xyz[c->item[corner[k == 3 ? 0 : 1]]]);
    tm_cross(normal, a, b);
}

/* What J_ENS can be at most where the element has all of an angle; 1: it has none. */
static double limit_at_edges(const candidate *c)
{
    double limit = 1;
    for (unsigned f = 0; f < c->shape->faces; f++)
        for (unsigned g = f + 1; g < c->shape->faces; g++) {
            double m[3], n[3], product[3];
            if (!(c->open >> f & 1) || !(c->open >> g & 1) || !meet_sharply(c, f, g))
                continue;
            normal_of(c, f, m);
            normal_of(c, g, n);
            tm_cross(product, m, n);
            if (tm_dot(m, n) < 0) /* the angle is below 90° */
                limit = fmin(limit,
                             sqrt(2 * tm_norm2(product) / (tm_norm2(m) * tm_norm2(n))));
        }
    return limit;
}

/* Whether all faces of the element at a corner are on the boundary. */
static bool is_tip(const candidate *c, unsigned corner)
{
    for (unsigned f = 0; f < c->shape->faces; f++)
        for (size_t i = 0; i < tm_mixed_face_nodes(c->shape->face[f]); i++)
            if (c->shape->face[f][i] == corner && !(c->open >> f & 1))
                return false;
    return true;
}

/* The same where it has all of a tip. */
static double limit_at_tips(const candidate *c)
{
    const double(*xyz)[3] = (const double(*)[3])c->state->mesh.xyz;
    double limit = 1, jacobian[TM_ELEMENT_CORNERS];
    tm_scaled_jacobians(c->shape, xyz, c->item, jacobian);
    for (size_t i = 0; i < c->shape->corners; i++) {
        const uint8_t *at = c->shape->corner[i];
        const uint32_t v = c->item[at[0]];
        bool all = c->state->on[v] == TM_NODE_ON_CORNER &&
                   !c->state->rule[v].off_surface && is_tip(c, at[0]);
        for (size_t j = 1; j < 4 && all; j++)
            all = is_sharp(c, at[j]);
        if (all)
            limit = fmin(limit, tm_jens_of(jacobian[i], c->shape->k[i]));
    }
    return limit;
}

typedef struct {
    const tm_repair_state *state;
    double threshold;
    const uint32_t *face; /* of the boundary, ascending */
    size_t faces;
    bool *forced;
} finder;

static void find_chunk(void *context, size_t first, size_t past)
{
    const finder *f = context;
    const tm_mixed_mesh *mesh = &f->state->mesh;
    size_t next =
        tm_first_not_below(f->face, f->faces, (uint32_t)(first << TM_FACE_SHIFT));
    for (size_t e = first; e < past; e++) {
        candidate c = {f->state, &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]],
                       mesh->item + mesh->start[e], 0};
        for (; next < f->faces && f->face[next] >> TM_FACE_SHIFT == e; next++)
            c.open |= 1U << (f->face[next] & ((1U << TM_FACE_SHIFT) - 1));
        f->forced[e] = false;
        const double jens = c.open == 0 ? 1 : tm_mixed_jens(mesh, e);
        if (jens >= f->threshold || c.open == 0 || tm_repair_is_bad(mesh, e, jens, 0))
            continue;
        const double limit = fmin(limit_at_edges(&c), limit_at_tips(&c));
        f->forced[e] = limit < f->threshold && jens >= enough * limit;
    }
}

tm_status tm_repair_find_forced(const tm_repair_state *state, double threshold,
                                bool *forced, size_t *count, tm_error *error)
{
    const tm_mixed_mesh *mesh = &state->mesh;
    uint32_t *face;
    size_t faces;
    *count = 0;
    const tm_status status = tm_mixed_boundary_faces(mesh, &face, &faces, error);
    if (status == TM_OK) {
        finder f = {state, threshold, face, faces, forced};
        tm_parallel_runs(mesh->threads, mesh->elements, TM_CHUNK, find_chunk, &f);
        for (size_t e = 0; e < mesh->elements; e++)
            *count += forced[e];
    }
    free(face);
    return status;
}
