/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The improver's insertions: at the best point of a cavity around an edge of a bad
 * tetrahedron, or on an edge that has to stay. */
#include "improve_engine.h"

#include "../../geom/vector.h"
#include "../operation/star_insertion.h"

#include <string.h>

enum { EDGES = 6, NOTHING = -1 };

/* The cavity of the tetrahedra around edge e of t that are reached without crossing a
 * constrained face; p is the mean of their centroids. */
static bool start_cavity(tm_improver *m, uint32_t t, unsigned e, double p[3])
{
    const tm_tet_mesh *mesh = m->mesh;
    tm_cavity *cavity = &m->cavity;
    uint32_t a = mesh->tet[t][tm_edge_corner[e][0]];
    uint32_t b = mesh->tet[t][tm_edge_corner[e][1]];
    double sum[3] = {0, 0, 0};
    if (!tm_cavity_start(cavity, mesh, &m->marks) ||
        !tm_cavity_add(cavity, mesh, &m->marks, t))
        return false;
    for (size_t k = 0; k < cavity->size; k++) {
        uint32_t u = cavity->tet[k];
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t v = mesh->tet[u][i], across = mesh->neighbour[u][i];
            for (int x = 0; x < 3; x++)
                sum[x] += mesh->xyz[v][x];
            if (v == a || v == b || across & TM_FACE_BIT ||
                tm_tet_is_marked(&m->marks, across / 4))
                continue;
            if (!tm_cavity_add(cavity, mesh, &m->marks, across / 4))
                return false;
        }
    }
    for (int x = 0; x < 3; x++)
        p[x] = sum[x] / (4 * (double)cavity->size);
    return true;
}

/* Finds the best cavity and point, from the one around edge e of t. Returns the gain if
 * that is above `needed`, else 0. */
static double plan_cavity(tm_improver *m, uint32_t t, unsigned e, double needed,
                          double p[3])
{
    enum { STEPS = 2 };
    static const tm_freedom anywhere = {3, {0, 0, 0}};
    const double beyond_target = 1.1;
    double least, enough = m->cost.target * beyond_target;
    bool done = start_cavity(m, t, e, p);
    tm_cavity_boundary boundary = tm_boundary_of_cavity(&m->cavity, m->mesh);
    if (done) {
        tm_cavity_boundary_climb(&boundary, m->cost.measure, &anywhere, enough, STEPS, p);
        done = tm_cavity_grow(&m->cavity, m->mesh, &m->marks, m->quality, &m->cost, p);
    }
    if (!done) {
        tm_improve_no_memory(m);
        return 0;
    }
    bool grown = m->cavity.faces != boundary.count;
    boundary = tm_boundary_of_cavity(&m->cavity, m->mesh);
    if (grown)
        tm_cavity_boundary_climb(&boundary, m->cost.measure, &anywhere, enough, STEPS, p);
    double old = tm_improve_old_cost(m, m->cavity.tet, m->cavity.size, &least);
    ptrdiff_t growth = (ptrdiff_t)m->cavity.faces - (ptrdiff_t)m->cavity.size;
    double most = old - tm_improve_growth_cost(m, growth) - needed;
    double cost = tm_cavity_boundary_cost(&boundary, &m->cost, p, least, most);
    return cost < most && tm_improve_may_grow(m, growth) ? most + needed - cost : 0;
}

/* Whether an edge is on the cavity's boundary. */
static bool boundary_has_edge(const tm_cavity *cavity, uint32_t a, uint32_t b)
{
    for (size_t f = 0; f < cavity->faces; f++) {
        if (tm_face_has_node(cavity->face[f], a) && tm_face_has_node(cavity->face[f], b))
            return true;
    }
    return false;
}

bool tm_improve_has_marked_edge(const tm_improver *m)
{
    const tm_cavity *cavity = &m->cavity;
    for (size_t k = 0; k < cavity->size && m->mesh->inner_marked_edges; k++)
        for (int e = 0; e < EDGES; e++) {
            const uint32_t *n = m->mesh->tet[cavity->tet[k]];
            uint32_t a = n[tm_edge_corner[e][0]], b = n[tm_edge_corner[e][1]];
            const tm_marked_edge *edge = tm_tet_mesh_edge(m->mesh, a, b);
            if (edge && edge->marker != 0 && !boundary_has_edge(cavity, a, b))
                return true;
        }
    return false;
}

/* Collects the nodes that are inside the cavity in m->swallowed; they go with it. False
 * where one has to stay, or memory is out. */
static bool find_swallowed(tm_improver *m, size_t *count)
{
    const tm_cavity *cavity = &m->cavity;
    *count = 0;
    if (!tm_tet_marks_clear(&m->seen, m->mesh->nodes))
        return tm_improve_no_memory(m);
    for (size_t f = 0; f < cavity->faces; f++)
        for (int i = 0; i < 3; i++)
            tm_tet_mark(&m->seen, cavity->face[f][i]);
    for (size_t k = 0; k < cavity->size; k++)
        for (int i = 0; i < 4; i++) {
            uint32_t v = m->mesh->tet[cavity->tet[k]][i];
            if (!tm_tet_mark(&m->seen, v))
                continue;
            if (m->features.dimension[v] != 3)
                return false;
            m->swallowed[(*count)++] = v;
        }
    return true;
}

/* Fills the cavity as it was planned. */
static bool fill(tm_improver *m, const double p[3])
{
    tm_tet_mesh *mesh = m->mesh;
    size_t faces = m->cavity.faces, swallowed, width = mesh->node_attributes;
    tm_cavity_boundary boundary = tm_boundary_of_cavity(&m->cavity, mesh);
    if (!tm_cavity_boundary_sees(&boundary, p) || tm_improve_has_marked_edge(m) ||
        !tm_improve_reserve(m, faces + m->cavity.size, 1) ||
        !find_swallowed(m, &swallowed))
        return false;
    if (!tm_replacement_table_reserve(&m->table, m->cavity.size, faces))
        return tm_improve_no_memory(m);
    uint32_t v = tm_tet_mesh_new_node(mesh, p);
    if (width > 0)
        tm_tet_interpolate(mesh, m->cavity.tet, m->cavity.size, p,
                           mesh->node_attribute + v * width);
    m->status =
        tm_cavity_fill(mesh, &m->cavity, v, &m->table, m->node, m->created, m->error);
    if (m->status != TM_OK)
        return false;
    tm_features_classify_node(&m->features, v, TM_EDGE_INSIDE, 0, 0);
    for (size_t k = 0; k < swallowed; k++)
        tm_tet_mesh_delete_node(mesh, m->swallowed[k]);
    tm_improve_note(m, m->created, faces);
    m->report->done.swallowed += swallowed;
    m->report->done.op[TM_OP_INSERTION]++;
    return true;
}

/* Plans the midpoint of edge e of t, which has to stay; p is that, or the point of the
 * surface near it. Returns the gain as above. */
static double plan_split(tm_improver *m, uint32_t t, unsigned e, double needed,
                         double p[3], double *at)
{
    const tm_star *s = &m->star;
    const double(*x)[3] = (const double(*)[3])m->mesh->xyz;
    if (!tm_star_around(m->mesh, t, e, &m->star)) {
        tm_improve_no_memory(m);
        return 0;
    }
    if (!s->constrained_face || tm_edge_map_get(&m->mesh->locked, s->a, s->b) ||
        !tm_star_is_simple(m->mesh, s) || !tm_improve_may_grow(m, (ptrdiff_t)s->size))
        return 0;
    double least, sum = m->price * (double)s->size;
    double old = tm_improve_old_cost(m, s->tet, s->size, &least);
    tm_star_midpoint(m->mesh, s, p);
    if (m->features.may_move)
        tm_improve_split_onto_surface(m, p, at);
    for (size_t i = 0; i < s->size && sum < old - needed; i++) {
        const double *r = x[s->ring[i]], *q = x[s->ring[i + 1]];
        double lower = tm_cost_quality(&m->cost, least, x[s->a], p, r, q);
        double upper = tm_cost_quality(&m->cost, least, p, x[s->b], r, q);
        if (lower < least || upper < least)
            return 0;
        sum += tm_cost_of(&m->cost, lower) + tm_cost_of(&m->cost, upper);
    }
    if (!(sum < old - needed) || !tm_star_sees(m->mesh, s, p) ||
        (m->features.may_move && !tm_improve_allows_split(m, p, *at)))
        return 0;
    return old - sum;
}

/* The node v made on edge ab is known as what it is in. */
static void note_split(tm_improver *m, uint32_t v, tm_edge_class place, uint32_t a,
                       uint32_t b, double at)
{
    tm_curve_part part;
    tm_features_classify_node(&m->features, v, place, a, b);
    if (!m->features.may_move)
        return;
    if (tm_features_part(&m->features, a, v, &part))
        tm_features_put(&m->features, v, part.curve, at);
    tm_improve_follow_surface(m);
}

/* Splits the edge as it was planned. */
static bool split(tm_improver *m, const double p[3], double at)
{
    size_t made = 2 * m->star.size, constrained[2];
    uint32_t a = m->star.a, b = m->star.b;
    tm_edge_class place =
        tm_features_classify(&m->features, m->mesh, &m->star, constrained);
    if (!tm_improve_reserve(m, made, 1))
        return false;
    uint32_t corner = tm_tet_corner(m->mesh, m->star.tet[0], b);
    m->status = tm_star_insert(m->mesh, &m->star, p, true, m->created, m->error);
    if (m->status != TM_OK)
        return false;
    note_split(m, m->mesh->tet[m->created[0]][corner], place, a, b, at);
    tm_improve_note(m, m->created, made);
    m->report->done.edge_splits++;
    m->report->done.op[TM_OP_INSERTION]++;
    return true;
}

/* Plans choice c: the cavity around an edge, or beyond these the edge's midpoint. */
static double plan(tm_improver *m, uint32_t t, int c, double needed, double p[3],
                   double *at)
{
    return c < EDGES ? plan_cavity(m, t, (unsigned)c, needed, p)
                     : plan_split(m, t, (unsigned)(c - EDGES), needed, p, at);
}

bool tm_improve_insert(tm_improver *m, uint32_t t)
{
    double best = TM_IMPROVE_GAIN, p[3], at = NAN;
    int choice = NOTHING;
    m->report->tried[TM_OP_INSERTION]++;
    for (int k = 0; k < 2 * EDGES && m->status == TM_OK; k++) {
        int c = (k + (int)m->fails) % (2 * EDGES);
        double gain = plan(m, t, c, best, p, &at);
        if (gain == 0)
            continue;
        best = gain;
        choice = c;
        if (m->fails > 0 && m->price < 0)
            break;
    }
    if (choice == NOTHING || m->status != TM_OK ||
        plan(m, t, choice, TM_IMPROVE_GAIN, p, &at) == 0)
        return false;
    return choice < EDGES ? fill(m, p) : split(m, p, at);
}
