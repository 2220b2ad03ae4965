/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts of the fans of a node, seen in its link, where fans are discs or spheres: a
 * neighbour of the node is a vertex there, a face that has the node an edge. Where
 * tetrahedra between two faces that have to stay fill much more than half of the turn
 * around the edge to a neighbour, a path is cut: along the face nearest to half of that,
 * then near the plane of that face, to the border. Both nodes of an edge begin with the
 * same face, so that their cuts meet. */
#include "dual_link.h"
#include "dual_steps.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Links of more triangles than this are not searched for paths. */
enum { MOST_TRIANGLES = 4096 };

/* The triangles around a vertex from one side that is not passed to the next one. */
typedef struct {
    uint32_t vertex;
    double turn;
    uint32_t triangle; /* with the side `half`: the one nearest to half of the turn */
    int half;
} sector;

typedef struct {
    tm_dual *d;
    tm_dual_link link;
    double most; /* of a turn */
    sector *sector;
    size_t sectors, sector_room;
    tm_dual_way *reached; /* [vertices] */
    size_t reached_room;
    double normal[3];
} cutter;

/* Corner i of a triangle: the next triangle around its vertex, counter-clockwise, and the
 * corner there. */
static uint32_t turn_around(const tm_dual_link *link, uint32_t triangle, int *i)
{
    const tm_dual_link_triangle *here = &link->triangle[triangle];
    const uint32_t next = here->beyond[(*i + 1) % 3], vertex = here->vertex[*i];
    if (next == TM_NONE)
        return TM_NONE;
    *i = 0;
    while (link->triangle[next].vertex[*i] != vertex)
        (*i)++;
    return next;
}

/* Measures the sector that begins with corner i of a triangle. Of two sides that are as
 * near to its half that with the smaller node counts, whichever way it is walked. */
static sector measure_sector(const tm_dual_link *link, uint32_t triangle, int i)
{
    const double alike = 1e-9;
    sector s = {link->triangle[triangle].vertex[i], 0, TM_NONE, 0};
    int corner = i;
    for (uint32_t a = triangle; a != TM_NONE; a = turn_around(link, a, &corner))
        s.turn += tm_dual_link_angle(link, a, corner);
    double at = 0, nearest = HUGE_VAL;
    uint32_t smallest = TM_NONE;
    corner = i;
    for (uint32_t a = triangle; a != TM_NONE; a = turn_around(link, a, &corner)) {
        const tm_dual_link_triangle *here = &link->triangle[a];
        const int side = (corner + 1) % 3;
        const uint32_t node = link->vertex[here->vertex[(corner + 2) % 3]].node;
        at += tm_dual_link_angle(link, a, corner);
        const double off = fabs(at - s.turn / 2);
        if (here->beyond[side] == TM_NONE || off > nearest + alike ||
            (off > nearest - alike && node > smallest))
            continue;
        nearest = fmin(off, nearest);
        smallest = node;
        s.triangle = a;
        s.half = side;
    }
    return s;
}

/* Lists the sectors that turn too far. */
static bool find_sectors(cutter *c)
{
    const tm_dual_link *link = &c->link;
    c->sectors = 0;
    for (uint32_t a = 0; a < link->triangles; a++)
        for (int i = 0; i < 3; i++) {
            const tm_dual_link_triangle *here = &link->triangle[a];
            if (!link->vertex[here->vertex[i]].constrained ||
                here->beyond[(i + 2) % 3] != TM_NONE)
                continue;
            const sector s = measure_sector(link, a, i);
            if (!(s.turn > c->most) || s.triangle == TM_NONE)
                continue;
            sector *list =
                tm_grow(c->sector, &c->sector_room, c->sectors + 1, sizeof *list);
            if (!list)
                return false;
            c->sector = list;
            list[c->sectors++] = s;
        }
    return true;
}

/* Paths ---------------------------------------------------------------------------- */

/* What it costs to end at a vertex of the border, by a side: little where a sector wants
 * to be cut there, most near to where the path began. */
static double end_cost(const cutter *c, uint32_t vertex, uint32_t first)
{
    const double wanted = 0.2, unwanted = 0.4, near = 0.5;
    const tm_dual_way *last = &c->reached[vertex];
    for (size_t k = 0; k < c->sectors; k++) {
        const sector *s = &c->sector[k];
        if (s->vertex != vertex)
            continue;
        const tm_dual_link_triangle *a = &c->link.triangle[s->triangle];
        const bool same = (s->triangle == last->triangle && s->half == last->side) ||
                          a->beyond[s->half] == last->triangle;
        return same ? 0 : wanted;
    }
    const double along = tm_dot(c->link.vertex[vertex].to, c->link.vertex[first].to);
    return unwanted + near * fmax(0, along);
}

static uint32_t find_end(const cutter *c, uint32_t first)
{
    uint32_t best = TM_NONE;
    double least = HUGE_VAL;
    for (uint32_t w = 0; w < c->link.vertices; w++) {
        if (!c->link.vertex[w].border || w == first || c->reached[w].cost == HUGE_VAL)
            continue;
        const double cost = c->reached[w].cost + end_cost(c, w, first);
        if (cost >= least)
            continue;
        least = cost;
        best = w;
    }
    return best;
}

/* Cuts a path from a sector; false where there is none. */
static bool cut_sector(cutter *c, const sector *s)
{
    tm_dual_link *link = &c->link;
    const tm_dual_link_triangle *a = &link->triangle[s->triangle];
    const uint32_t first = s->vertex, second = a->vertex[(s->half + 1) % 3] == first
                                                   ? a->vertex[(s->half + 2) % 3]
                                                   : a->vertex[(s->half + 1) % 3];
    tm_cross(c->normal, link->vertex[first].to, link->vertex[second].to);
    const double length = tm_norm(c->normal);
    for (int x = 0; x < 3; x++)
        c->normal[x] /= length;
    tm_dual_ways_begin(c->reached, link);
    c->reached[first].enters = false;
    c->reached[second].cost = 0;
    tm_dual_ways_find(c->reached, link, c->normal);
    const uint32_t end = find_end(c, first);
    if (end == TM_NONE)
        return false;
    tm_dual_way_cut(c->reached, link, c->d, end);
    tm_dual_link_cut(link, c->d, s->triangle, s->half);
    return true;
}

static size_t largest_sector(const cutter *c)
{
    size_t largest = 0;
    for (size_t k = 1; k < c->sectors; k++)
        if (c->sector[k].turn > c->sector[largest].turn)
            largest = k;
    return largest;
}

/* Where there is nothing to cut, points may have been put too far. */
static void put_at_centroids(tm_dual *d, const uint32_t *piece, size_t pieces)
{
    for (size_t k = 0; k < pieces; k++)
        tm_dual_put_at_centroid(d, piece[k] / 4);
}

/* Cuts a node until no sector turns too far, and with `apart` between places on the
 * border; *done is false where that cannot be. */
static bool cut_node(cutter *c, const uint32_t *piece, size_t pieces, bool apart,
                     bool *done)
{
    *done = false;
    if (pieces > MOST_TRIANGLES)
        return true;
    if (!tm_dual_link_fill(&c->link, c->d, piece, pieces))
        return false;
    tm_dual_way *grown =
        tm_grow(c->reached, &c->reached_room, c->link.vertices, sizeof *grown);
    if (!grown)
        return false;
    c->reached = grown;
    bool any = false;
    if (!find_sectors(c))
        return false;
    while (c->sectors > 0 && cut_sector(c, &c->sector[largest_sector(c)])) {
        any = true;
        if (!find_sectors(c))
            return false;
    }
    *done = c->sectors == 0;
    if (*done && apart && !tm_dual_cut_apart(c->d, &c->link, &any))
        return false;
    if (*done && !any)
        put_at_centroids(c->d, piece, pieces);
    c->d->cut_nodes += any;
    return true;
}

static bool is_to_be_cut(const tm_dual *d, uint32_t v)
{
    return d->level[v] == TM_DUAL_TO_CUT || d->level[v] == TM_DUAL_TO_CUT_MORE;
}

tm_dual_level tm_dual_next_level(tm_dual_level level)
{
    static const tm_dual_level next[TM_DUAL_LEVELS] = {
        [TM_DUAL_WHOLE] = TM_DUAL_TO_CUT,    [TM_DUAL_TO_CUT] = TM_DUAL_TO_CUT,
        [TM_DUAL_CUT] = TM_DUAL_TO_CUT_MORE, [TM_DUAL_TO_CUT_MORE] = TM_DUAL_TO_CUT_MORE,
        [TM_DUAL_CUT_MORE] = TM_DUAL_PIECES, [TM_DUAL_PIECES] = TM_DUAL_PIECES};
    return next[level];
}

/* Lists the pieces of the nodes that are to be cut, those of node v from start[v] on. */
static uint32_t *list_pieces(const tm_dual *d, size_t *start)
{
    const tm_tet_mesh *mesh = d->mesh;
    uint32_t *piece = NULL;
    memset(start, 0, (mesh->nodes + 2) * sizeof *start);
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t p = 0; p < 4 * mesh->slots; p++) {
            const uint32_t v = mesh->tet[p / 4][p % 4];
            if (!is_to_be_cut(d, v))
                continue;
            if (pass == 0)
                start[v + 2]++;
            else
                piece[start[v + 1]++] = p;
        }
        for (size_t v = 0; v < mesh->nodes && pass == 0; v++)
            start[v + 2] += start[v + 1];
        if (pass == 0)
            piece = tm_new(start[mesh->nodes + 1], sizeof *piece);
        if (!piece)
            return NULL;
    }
    return piece;
}

tm_status tm_dual_cut(tm_dual *d, tm_error *error)
{
    const double half_turn = 180, least = 20, little = 3;
    const double beyond = fmax(least, d->options->feature_angle);
    cutter c = {.d = d};
    size_t *start = tm_new(d->mesh->nodes + 2, sizeof *start);
    uint32_t *piece = start ? list_pieces(d, start) : NULL;
    bool done = piece;
    for (size_t v = 0; v < d->mesh->nodes && done; v++) {
        bool is_cut = true;
        if (!is_to_be_cut(d, (uint32_t)v))
            continue;
        c.most = pi + (d->level[v] == TM_DUAL_TO_CUT ? beyond : little) * pi / half_turn;
        if (start[v] < start[v + 1])
            done = cut_node(&c, piece + start[v], start[v + 1] - start[v],
                            d->level[v] == TM_DUAL_TO_CUT_MORE, &is_cut);
        d->level[v] = (uint8_t)(is_cut ? d->level[v] + 1 : TM_DUAL_PIECES);
    }
    tm_dual_link_free(&c.link);
    free(c.sector);
    free(c.reached);
    free(piece);
    free(start);
    return done ? TM_OK : tm_fail_memory(error);
}
