/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Walls, the spokes where they meet, and which points are there. */
#include "dual_steps.h"

#include "../../base/array.h"
#include "../../tet/mesh_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static uint32_t new_point(tm_dual *d, tm_dual_place place, uint32_t of)
{
    tm_dual_point *point =
        tm_grow(d->point, &d->point_room, d->points + 1, sizeof *point);
    if (!point)
        return TM_NONE;
    d->point = point;
    point[d->points] = (tm_dual_point){(uint8_t)place, of};
    return (uint32_t)d->points++;
}

/* The nodes of a half face, counter-clockwise seen from outside. */
void tm_dual_half_nodes(const tm_tet_mesh *mesh, uint32_t half, uint32_t node[3])
{
    const uint8_t *corner = tm_face_corner[half % 4];
    for (int i = 0; i < 3; i++)
        node[i] = mesh->tet[half / 4][corner[i]];
}

/* The two cells at corner j of a wall, that of its half first; TM_NONE: the boundary. */
void tm_dual_wall_cells(const tm_dual *d, const tm_dual_wall *wall, int j,
                        uint32_t cell[2])
{
    const tm_tet_mesh *mesh = d->mesh;
    const uint32_t t = wall->half / 4, i = wall->half % 4, corner = tm_face_corner[i][j];
    const uint32_t across = tm_tet_across(mesh, t, i);
    cell[0] = d->cell[4 * t + corner];
    cell[1] = TM_NONE;
    if (across != TM_NONE)
        cell[1] = d->cell[across - across % 4 +
                          tm_tet_corner(mesh, across / 4, mesh->tet[t][corner])];
}

/* Adds the wall of a half face if it is one. */
static bool add_wall(tm_dual *d, uint32_t half)
{
    const tm_tet_mesh *mesh = d->mesh;
    const uint32_t n = mesh->neighbour[half / 4][half % 4];
    tm_dual_wall wall = {.half = half, .constrained = (n & TM_FACE_BIT) != 0};
    const uint32_t across = tm_tet_across(mesh, half / 4, half % 4);
    if (across != TM_NONE && across < half)
        return true;
    bool any = false;
    for (int j = 0; j < 3; j++) {
        uint32_t cell[2];
        tm_dual_wall_cells(d, &wall, j, cell);
        wall.quad[j] = cell[0] != cell[1];
        any |= wall.quad[j];
        wall.edge[j] = TM_NONE;
    }
    if (!any)
        return true;
    if (wall.constrained)
        wall.marker = mesh->face[n & ~TM_FACE_BIT].marker;
    tm_dual_wall *list = tm_grow(d->wall, &d->wall_room, d->walls + 1, sizeof *list);
    if (!list)
        return false;
    d->wall = list;
    list[d->walls++] = wall;
    const uint32_t point = new_point(d, TM_DUAL_IN_FACE, (uint32_t)d->walls - 1);
    list[d->walls - 1].point = point;
    d->face_point[half] = point;
    if (across != TM_NONE)
        d->face_point[across] = point;
    return point != TM_NONE;
}

static bool find_walls(tm_dual *d)
{
    const tm_tet_mesh *mesh = d->mesh;
    memset(d->face_point, UINT8_MAX, 4 * mesh->slots * sizeof *d->face_point);
    for (uint32_t h = 0; h < 4 * mesh->slots; h++)
        if ((d->has_cuts || mesh->neighbour[h / 4][h % 4] & TM_FACE_BIT) &&
            !add_wall(d, h))
            return false;
    return true;
}

/* The edge between two nodes, made if it is new; TM_NONE where memory is out. */
static uint32_t edge_between(tm_dual *d, uint32_t a, uint32_t b)
{
    const uint32_t *known = tm_edge_map_get(&d->edge_of, a, b);
    if (known)
        return *known;
    tm_dual_edge *edge = tm_grow(d->edge, &d->edge_room, d->edges + 1, sizeof *edge);
    if (!edge || !tm_edge_map_reserve(&d->edge_of, 1))
        return TM_NONE;
    const tm_marked_edge *marked = tm_tet_mesh_edge(d->mesh, a, b);
    d->edge = edge;
    edge[d->edges] = (tm_dual_edge){.node = {a, b}, .point = TM_NONE};
    if (marked) {
        /* TetGen gives 1 to all edges between its facets. */
        edge[d->edges].listed = true;
        edge[d->edges].marker = marked->marker;
        edge[d->edges].marked = marked->marker != 0 &&
                                (marked->marker != 1 || d->options->feature_angle == 0);
    }
    tm_edge_map_put(&d->edge_of, a, b, (uint32_t)d->edges);
    return (uint32_t)d->edges++;
}

static bool find_edges(tm_dual *d)
{
    for (size_t w = 0; w < d->walls; w++) {
        uint32_t node[3];
        tm_dual_wall *wall = &d->wall[w];
        tm_dual_half_nodes(d->mesh, wall->half, node);
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3;
            if (!wall->quad[a] && !wall->quad[b])
                continue;
            const uint32_t e = edge_between(d, node[a], node[b]);
            if (e == TM_NONE)
                return false;
            wall->edge[j] = e;
            d->edge[e].half = wall->half;
            d->edge[e].faces++;
            d->edge[e].constrained |= wall->constrained;
            if (wall->constrained && !d->edge[e].listed)
                d->edge[e].marker = wall->marker;
        }
    }
    return true;
}

/* Spokes --------------------------------------------------------------------------- */

/* One end of a quad: the spoke that it begins or ends with, seen from outside of its
 * first cell. */
typedef struct {
    uint32_t edge, quad;
    bool ends;
} quad_end;

/* What the cells of a quad are, and whether it turns as its wall's half does. */
typedef struct {
    uint32_t cell[2];
    bool turned;
} quad_sides;

static quad_sides sides_of(const tm_dual *d, uint32_t q)
{
    quad_sides sides;
    tm_dual_wall_cells(d, &d->wall[q / 3], (int)(q % 3), sides.cell);
    sides.turned = sides.cell[0] > sides.cell[1];
    if (sides.turned) {
        const uint32_t cell = sides.cell[0];
        sides.cell[0] = sides.cell[1];
        sides.cell[1] = cell;
    }
    return sides;
}

uint32_t tm_dual_quad_edge(const tm_dual *d, uint32_t q, bool last)
{
    const bool other = last != sides_of(d, q).turned;
    return d->wall[q / 3].edge[(q % 3 + (other ? 1 : 2)) % 3];
}

static bool is_bent(const tm_dual *d, uint32_t q, uint32_t r, const tm_dual_edge *edge)
{
    const double(*xyz)[3] = (const double(*)[3])d->mesh->xyz;
    const uint32_t quad[2] = {q, r};
    double normal[2][3];
    const double *apex[2];
    for (int i = 0; i < 2; i++) {
        uint32_t node[3];
        const bool turned = sides_of(d, quad[i]).turned;
        tm_dual_half_nodes(d->mesh, d->wall[quad[i] / 3].half, node);
        tm_triangle_normal(normal[i], xyz[node[0]], xyz[node[turned ? 2 : 1]],
                           xyz[node[turned ? 1 : 2]]);
        apex[i] = xyz[tm_face_third_node(node, edge->node[0], edge->node[1])];
    }
    const double along = tm_dot(normal[0], normal[1]);
    const double lengths = tm_norm(normal[0]) * tm_norm(normal[1]);
    if (d->options->feature_angle > 0)
        return !(along >= d->cosine * lengths);
    double to[3];
    tm_subtract(to, apex[1], xyz[edge->node[0]]);
    return !(along > 0 &&
             fabs(tm_dot(normal[0], to)) <= d->flatness * tm_norm(normal[0]));
}

/* A node whose cells may be concave at some quads is to be cut. */
static void note_corner(tm_dual *d, uint32_t v, const quad_end *end, size_t count)
{
    if (d->options->feature_angle == 0 || d->level[v] != TM_DUAL_WHOLE)
        return;
    if (count < 2 ||
        (count == 2 && !is_bent(d, end[0].quad, end[1].quad, &d->edge[end[0].edge])))
        return;
    d->level[v] = TM_DUAL_TO_CUT;
    d->again = true;
}

/* Whether two quads, which are the only ones at a spoke, are parts of one facet. */
static bool continues(const tm_dual *d, const quad_end *p, const quad_end *r)
{
    const tm_dual_wall *w = &d->wall[p->quad / 3], *x = &d->wall[r->quad / 3];
    const quad_sides a = sides_of(d, p->quad), b = sides_of(d, r->quad);
    const tm_dual_edge *edge = &d->edge[p->edge];
    if (p->ends == r->ends || memcmp(a.cell, b.cell, sizeof a.cell) != 0 ||
        w->constrained != x->constrained || w->marker != x->marker || edge->marked)
        return false;
    if (!w->constrained)
        return d->level[d->cell_node[a.cell[0]]] != TM_DUAL_PIECES;
    return !is_bent(d, p->quad, r->quad, edge);
}

static int compare_ends(const void *a, const void *b)
{
    const quad_end *p = a, *q = b;
    if (p->edge != q->edge)
        return p->edge < q->edge ? -1 : 1;
    return (p->quad > q->quad) - (p->quad < q->quad);
}

static void make_real(tm_dual *d, uint32_t e, uint32_t v)
{
    tm_dual_edge *edge = &d->edge[e];
    edge->real[edge->node[1] == v] = true;
}

/* Joins the quads at a node where they continue each other. */
static void join_quads(tm_dual *d, uint32_t v, quad_end *end)
{
    const uint32_t from = d->quad_start[v], to = d->quad_start[v + 1];
    size_t ends = 0;
    for (uint32_t i = from; i < to; i++) {
        const uint32_t q = d->quad_of[i];
        end[ends++] = (quad_end){tm_dual_quad_edge(d, q, false), q, false};
        end[ends++] = (quad_end){tm_dual_quad_edge(d, q, true), q, true};
        d->begins[q] = true;
        d->following[q] = TM_NONE;
    }
    qsort(end, ends, sizeof *end, compare_ends);
    for (size_t i = 0, next; i < ends; i = next) {
        next = i + 1;
        while (next < ends && end[next].edge == end[i].edge)
            next++;
        if (next - i != 2 || !continues(d, &end[i], &end[i + 1])) {
            make_real(d, end[i].edge, v);
            note_corner(d, v, &end[i], next - i);
            continue;
        }
        const quad_end *first = &end[i + !end[i].ends], *second = &end[i + end[i].ends];
        d->following[first->quad] = second->quad;
        d->begins[second->quad] = false;
    }
}

/* A row of quads that begins and ends with the same spoke is cut in the middle, too. */
static void part_rings(tm_dual *d, uint32_t v)
{
    for (uint32_t i = d->quad_start[v]; i < d->quad_start[v + 1]; i++) {
        const uint32_t first = d->quad_of[i];
        if (!d->begins[first])
            continue;
        uint32_t last = first, middle = first, count = 1;
        for (; d->following[last] != TM_NONE; last = d->following[last], count++)
            if (count % 2 == 0)
                middle = d->following[middle];
        const uint32_t e = tm_dual_quad_edge(d, last, true);
        if (count < 2 || e != tm_dual_quad_edge(d, first, false))
            continue;
        make_real(d, tm_dual_quad_edge(d, middle, true), v);
        d->begins[d->following[middle]] = true;
        d->following[middle] = TM_NONE;
    }
}

static tm_status list_quads(tm_dual *d, size_t *most, tm_error *error)
{
    const tm_tet_mesh *mesh = d->mesh;
    const size_t quads = 3 * d->walls;
    free(d->quad_of);
    free(d->following);
    free(d->begins);
    d->quad_of = tm_new(quads, sizeof *d->quad_of);
    d->following = tm_new(quads, sizeof *d->following);
    d->begins = calloc(quads + 1, sizeof *d->begins);
    if (!d->quad_of || !d->following || !d->begins)
        return tm_fail_memory(error);
    uint32_t *start = d->quad_start;
    memset(start, 0, (mesh->nodes + 2) * sizeof *start);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t q = 0; q < quads; q++) {
            uint32_t node[3];
            tm_dual_half_nodes(mesh, d->wall[q / 3].half, node);
            if (!d->wall[q / 3].quad[q % 3])
                continue;
            if (pass == 0)
                start[node[q % 3] + 2]++;
            else
                d->quad_of[start[node[q % 3] + 1]++] = q;
        }
        *most = 0;
        for (size_t v = 0; v < mesh->nodes && pass == 0; v++) {
            start[v + 2] += start[v + 1];
        }
    }
    for (size_t v = 0; v < mesh->nodes; v++)
        if (start[v + 1] - start[v] > *most)
            *most = start[v + 1] - start[v];
    return TM_OK;
}

/* Points --------------------------------------------------------------------------- */

/* The middle of an edge is where more than two edges of facets meet. */
static bool find_edge_points(tm_dual *d)
{
    for (uint32_t e = 0; e < d->edges; e++) {
        tm_dual_edge *edge = &d->edge[e];
        if (edge->faces == 2 && !edge->real[0] && !edge->real[1])
            continue;
        edge->point = new_point(d, TM_DUAL_ON_EDGE, e);
        if (edge->point == TM_NONE)
            return false;
    }
    return true;
}

/* What is known of the spokes at a node. */
typedef struct {
    uint32_t spokes, edge[2];
    bool marked, constrained;
} node_spokes;

static bool is_straight(const tm_dual *d, uint32_t v, const node_spokes *s)
{
    const double(*xyz)[3] = (const double(*)[3])d->mesh->xyz;
    uint32_t end[2];
    for (int i = 0; i < 2; i++) {
        const tm_dual_edge *edge = &d->edge[s->edge[i]];
        end[i] = edge->node[edge->node[0] == v];
    }
    double to[2][3], normal[3];
    tm_subtract(to[0], xyz[v], xyz[end[0]]);
    tm_subtract(to[1], xyz[end[1]], xyz[v]);
    tm_cross(normal, to[0], to[1]);
    return tm_dot(to[0], to[1]) > 0 &&
           tm_norm(normal) <= d->flatness * fmin(tm_norm(to[0]), tm_norm(to[1]));
}

/* A node is a point where spokes end, but for two in a line. */
static tm_status find_node_points(tm_dual *d, tm_error *error)
{
    const size_t nodes = d->mesh->nodes;
    node_spokes *at = calloc(nodes + 1, sizeof *at);
    bool done = at;
    for (uint32_t e = 0; e < d->edges && done; e++)
        for (int i = 0; i < 2; i++) {
            node_spokes *s = &at[d->edge[e].node[i]];
            s->marked |= d->edge[e].marked;
            s->constrained |= d->edge[e].constrained;
            if (d->edge[e].real[i] && s->spokes++ < 2)
                s->edge[s->spokes - 1] = e;
        }
    for (uint32_t v = 0; v < nodes && done; v++) {
        d->node_point[v] = TM_NONE;
        const bool needless =
            at[v].spokes == 0 || (at[v].spokes == 2 && !at[v].marked &&
                                  (!at[v].constrained || is_straight(d, v, &at[v])));
        if (needless)
            continue;
        d->node_point[v] = new_point(d, TM_DUAL_AT_NODE, v);
        done = d->node_point[v] != TM_NONE;
    }
    free(at);
    return done ? TM_OK : tm_fail_memory(error);
}

tm_status tm_dual_find_walls(tm_dual *d, tm_error *error)
{
    const tm_tet_mesh *mesh = d->mesh;
    tm_dual_keep(d);
    d->walls = d->edges = 0;
    d->points = 0;
    d->again = false;
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (new_point(d, TM_DUAL_IN_TET, t) == TM_NONE)
            return tm_fail_memory(error);
    if (!find_walls(d) || !find_edges(d))
        return tm_fail_memory(error);
    size_t most = 0;
    tm_status status = list_quads(d, &most, error);
    if (status != TM_OK)
        return status;
    quad_end *end = tm_new(2 * most, sizeof *end);
    if (!end)
        return tm_fail_memory(error);
    for (uint32_t v = 0; v < mesh->nodes; v++)
        if (d->quad_start[v] < d->quad_start[v + 1]) {
            join_quads(d, v, end);
            part_rings(d, v);
        }
    free(end);
    if (!find_edge_points(d))
        return tm_fail_memory(error);
    return find_node_points(d, error);
}
