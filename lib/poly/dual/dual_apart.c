/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cell of a node may have faces that stay in places that do not touch but at the node,
 * across a hollow or a ridge of the surface: then it is concave however its points are
 * put. Seen in the link, such a region has two arcs of sides that stay on its border. It
 * is cut between them: by the shortest path from the border on one side of an arc to that
 * on its other side, near to what is as far from this arc as from the others. */
#include "dual_link.h"
#include "dual_steps.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>

/* A side of a triangle on the border of a region, from one vertex to the next. */
typedef struct {
    uint32_t triangle;
    int side;
    bool stays;
} border_side;

typedef struct {
    tm_dual *d;
    tm_dual_link *link;
    border_side *side;
    size_t sides, side_room;
    bool *walked;     /* [3 triangles] */
    tm_dual_way *way; /* [vertices] */
    bool *goal;       /* [vertices] */
    double middle[3];
} apart;

static uint32_t from_of(const apart *c, const border_side *s)
{
    return c->link->triangle[s->triangle].vertex[(s->side + 1) % 3];
}

static uint32_t to_of(const apart *c, const border_side *s)
{
    return c->link->triangle[s->triangle].vertex[(s->side + 2) % 3];
}

static bool stays(const apart *c, uint32_t triangle, int side)
{
    const uint32_t piece = c->link->triangle[triangle].piece;
    const uint32_t n = c->d->mesh->neighbour[piece / 4][tm_face_corner[piece % 4][side]];
    return (n & TM_FACE_BIT) != 0;
}

/* The side of the border that follows one, counter-clockwise. */
static border_side next_side(const apart *c, const border_side *s)
{
    const uint32_t vertex = to_of(c, s);
    uint32_t a = s->triangle;
    int side = (s->side + 1) % 3;
    while (c->link->triangle[a].beyond[side] != TM_NONE) {
        a = c->link->triangle[a].beyond[side];
        int i = 0;
        while (c->link->triangle[a].vertex[i] != vertex)
            i++;
        side = (i + 2) % 3;
    }
    return (border_side){a, side, stays(c, a, side)};
}

/* Lists a border from one of its sides that stays, the first of its arc, or any. */
static bool walk(apart *c, border_side first)
{
    border_side s = first;
    c->sides = 0;
    do {
        border_side *list = tm_grow(c->side, &c->side_room, c->sides + 1, sizeof *list);
        if (!list)
            return false;
        c->side = list;
        list[c->sides++] = s;
        c->walked[3 * s.triangle + (uint32_t)s.side] = true;
        s = next_side(c, &s);
    } while (s.triangle != first.triangle || s.side != first.side);
    size_t k = 0;
    while (k < c->sides &&
           !(c->side[k].stays && !c->side[(k + c->sides - 1) % c->sides].stays))
        k++;
    for (size_t i = 0; i < k && k < c->sides; i++) { /* turned to begin there */
        s = c->side[0];
        for (size_t n = 1; n < c->sides; n++)
            c->side[n - 1] = c->side[n];
        c->side[c->sides - 1] = s;
    }
    return true;
}

static void add_direction(const apart *c, const border_side *s, double sum[3])
{
    for (int x = 0; x < 3; x++)
        sum[x] +=
            c->link->vertex[from_of(c, s)].to[x] + c->link->vertex[to_of(c, s)].to[x];
}

/* Of the border: sides [0, arc) are the first arc, [arc, other) are cut; [last, sides)
 * are cut before it. False where there is no other arc. */
static bool find_arcs(apart *c, size_t *arc, size_t *other, size_t *last)
{
    double here[3] = {0}, there[3] = {0};
    size_t k = 0;
    while (k < c->sides && c->side[k].stays)
        add_direction(c, &c->side[k++], here);
    *arc = k;
    while (k < c->sides && !c->side[k].stays)
        k++;
    *other = k;
    *last = c->sides;
    while (*last > k && !c->side[*last - 1].stays)
        --*last;
    for (; k < *last; k++)
        if (c->side[k].stays)
            add_direction(c, &c->side[k], there);
    const double lengths[2] = {tm_norm(here), tm_norm(there)};
    for (int x = 0; x < 3; x++)
        c->middle[x] = here[x] / lengths[0] - there[x] / lengths[1];
    return *arc > 0 && *other<c->sides && * other> * arc && *last < c->sides;
}

/* Cuts the region whose border is listed; whether it was. */
static bool cut_region(apart *c)
{
    size_t arc, other, last;
    if (!find_arcs(c, &arc, &other, &last))
        return false;
    tm_dual_ways_begin(c->way, c->link);
    for (size_t v = 0; v < c->link->vertices; v++)
        c->goal[v] = false;
    for (size_t k = last; k < c->sides; k++)
        c->goal[from_of(c, &c->side[k])] = c->goal[to_of(c, &c->side[k])] = true;
    for (size_t k = arc; k < other; k++)
        for (int e = 0; e < 2; e++) {
            const uint32_t v = e ? to_of(c, &c->side[k]) : from_of(c, &c->side[k]);
            if (c->goal[v])
                continue;
            c->way[v].cost = tm_dual_way_cost(c->link, c->middle, v);
            c->way[v].leaves = true;
        }
    for (size_t v = 0; v < c->link->vertices; v++)
        c->way[v].enters = !c->link->vertex[v].border || c->goal[v];
    tm_dual_ways_find(c->way, c->link, c->middle);
    uint32_t end = TM_NONE;
    for (uint32_t v = 0; v < c->link->vertices; v++)
        if (c->goal[v] && c->way[v].cost < HUGE_VAL &&
            (end == TM_NONE || c->way[v].cost < c->way[end].cost))
            end = v;
    if (end == TM_NONE)
        return false;
    tm_dual_way_cut(c->way, c->link, c->d, end);
    return true;
}

/* Cuts the first region that has two arcs; *cut tells whether there was one. */
static bool cut_one(apart *c, bool *cut)
{
    tm_dual_link *link = c->link;
    *cut = false;
    for (size_t i = 0; i < 3 * link->triangles; i++)
        c->walked[i] = false;
    for (uint32_t a = 0; a < link->triangles && !*cut; a++)
        for (int side = 0; side < 3 && !*cut; side++) {
            if (link->triangle[a].beyond[side] != TM_NONE || !stays(c, a, side) ||
                c->walked[3 * a + (uint32_t)side])
                continue;
            if (!walk(c, (border_side){a, side, true}))
                return false;
            *cut = cut_region(c);
        }
    return true;
}

bool tm_dual_cut_apart(tm_dual *d, tm_dual_link *link, bool *any)
{
    apart c = {.d = d,
               .link = link,
               .walked = tm_new(3 * link->triangles, sizeof *c.walked),
               .way = tm_new(link->vertices, sizeof *c.way),
               .goal = tm_new(link->vertices, sizeof *c.goal)};
    bool done = c.walked && c.way && c.goal, more = done;
    while (more && done) {
        done = cut_one(&c, &more);
        *any |= more;
    }
    free(c.side);
    free(c.walked);
    free(c.way);
    free(c.goal);
    return done;
}
