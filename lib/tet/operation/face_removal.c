/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "face_removal.h"

#include "../../geom/predicates.h"
#include "ball.h"

#include <string.h>

typedef struct {
    const tm_tet_mesh *mesh;
    const double *quality;
    const tm_cost *cost;
    double least;
    uint32_t d, e;
    tm_face_removal *plan;
} search;

static void add_new(search *s, uint32_t x, uint32_t y)
{
    tm_face_removal *plan = s->plan;
    memcpy(plan->node[plan->count++], (uint32_t[4]){x, y, s->e, s->d},
           sizeof plan->node[0]);
}

static void add_old(search *s, uint32_t t, uint32_t u)
{
    s->plan->old[s->plan->old_count++] = t;
    s->plan->old[s->plan->old_count++] = u;
}

/* The cost of the new tetrahedron at edge xy; HUGE_VAL where it is not allowed. */
static double new_cost(const search *s, uint32_t x, uint32_t y)
{
    const double(*p)[3] = (const double(*)[3])s->mesh->xyz;
    double quality = tm_cost_quality(s->cost, s->least, p[x], p[y], p[s->e], p[s->d]);
    if (quality < s->least || tm_orient3d(p[x], p[y], p[s->e], p[s->d]) <= 0)
        return HUGE_VAL;
    return tm_cost_of(s->cost, quality);
}

/* The tetrahedron across face i of t; TM_NONE where that face is constrained. */
static uint32_t across(const tm_tet_mesh *mesh, uint32_t t, uint32_t i)
{
    uint32_t g = mesh->neighbour[t][i];
    return g & TM_FACE_BIT ? TM_NONE : g / 4;
}

/* The node of t that is none of x, y, d. */
static uint32_t fourth(const uint32_t n[4], uint32_t x, uint32_t y, uint32_t d)
{
    for (int i = 0; i < 3; i++)
        if (n[i] != x && n[i] != y && n[i] != d)
            return n[i];
    return n[3];
}

static bool is_listed(const tm_face_removal *plan, uint32_t t)
{
    for (size_t i = 0; i < plan->old_count; i++)
        if (plan->old[i] == t)
            return true;
    return false;
}

/* Whether edge xy, which is inside, has to stay. */
static bool is_marked(const tm_tet_mesh *mesh, uint32_t x, uint32_t y)
{
    const tm_marked_edge *edge =
        mesh->inner_marked_edges ? tm_tet_mesh_edge(mesh, x, y) : NULL;
    return edge && edge->marker != 0;
}

/* Closes the cavity at edge xy of a face xyz between t (with d) and u (with e): by a new
 * tetrahedron, or beyond the next face, whichever costs less. Appends to the plan and
 * returns the cost of what is new less that of what goes. */
static double close_edge(search *s, uint32_t x, uint32_t y, uint32_t z, uint32_t t,
                         uint32_t u, int depth)
{
    const tm_tet_mesh *mesh = s->mesh;
    tm_face_removal *plan = s->plan;
    double simple = new_cost(s, x, y);
    size_t count = plan->count, old_count = plan->old_count;
    uint32_t above = across(mesh, t, tm_tet_corner(mesh, t, z));
    uint32_t below = across(mesh, u, tm_tet_corner(mesh, u, z));
    if (depth > 0 && simple > 0 && above != TM_NONE && below != TM_NONE &&
        !is_marked(mesh, x, y)) {
        uint32_t w = fourth(mesh->tet[above], x, y, s->d);
        uint32_t corner = tm_tet_corner(mesh, above, s->d);
        if (w == fourth(mesh->tet[below], x, y, s->e) &&
            across(mesh, above, corner) == below && !is_listed(plan, above) &&
            !is_listed(plan, below)) {
            add_old(s, above, below);
            double beyond = -tm_cost_of(s->cost, s->quality[above]) -
                            tm_cost_of(s->cost, s->quality[below]);
            beyond += close_edge(s, x, w, y, above, below, depth - 1);
            if (beyond < HUGE_VAL)
                beyond += close_edge(s, w, y, x, above, below, depth - 1);
            if (beyond < simple)
                return beyond;
            plan->count = count;
            plan->old_count = old_count;
        }
    }
    if (simple < HUGE_VAL)
        add_new(s, x, y);
    return simple;
}

bool tm_face_removal_plan(const tm_tet_mesh *mesh, const double *quality, uint32_t t,
                          uint32_t i, const tm_cost *cost, double least,
                          tm_face_removal *plan)
{
    uint32_t n[3], h = mesh->neighbour[t][i];
    if (h & TM_FACE_BIT)
        return false;
    uint32_t u = h / 4;
    search s = {mesh, quality, cost, least, mesh->tet[t][i], mesh->tet[u][h % 4], plan};
    plan->count = plan->old_count = 0;
    add_old(&s, t, u);
    double sum = 0;
    tm_tet_face_below(mesh, t, i, n);
    for (int k = 0; k < 3 && sum < HUGE_VAL; k++)
        sum += close_edge(&s, n[k], n[(k + 1) % 3], n[(k + 2) % 3], t, u,
                          TM_FACE_REMOVAL_DEPTH);
    if (!(sum < HUGE_VAL))
        return false;
    plan->gain = tm_cost_of(cost, quality[t]) + tm_cost_of(cost, quality[u]) - sum;
    return true;
}
