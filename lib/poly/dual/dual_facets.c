/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets: around each edge those between the cells of its nodes, on walls those
 * between cells of one node. */
#include "dual_steps.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* A facet in the making, around the normal from side[0] to side[1]. */
typedef struct {
    uint32_t side[2];
    int32_t marker;
    uint32_t *node;
    size_t nodes, room;
} polygon;

static bool add_node(polygon *p, uint32_t point)
{
    return point == TM_NONE || tm_append(&p->node, &p->nodes, &p->room, point);
}

/* Appends a polygon, so that its first cell is the smaller one. */
static bool write_polygon(tm_dual *d, const polygon *p)
{
    tm_block *facet = &d->facet;
    const size_t f = d->facets, room = d->facet_room;
    if (f + 2 > room) {
        size_t pairs = room, starts = room, markers = room;
        uint32_t *side = tm_grow(facet->integer, &pairs, f + 2, 2 * sizeof *side);
        facet->integer = side ? side : facet->integer;
        size_t *start = tm_grow(facet->start, &starts, f + 2, sizeof *start);
        facet->start = start ? start : facet->start;
        int32_t *marker = tm_grow(facet->marker, &markers, f + 2, sizeof *marker);
        facet->marker = marker ? marker : facet->marker;
        if (!side || !start || !marker)
            return false;
        d->facet_room = pairs;
    }
    uint32_t *item =
        tm_grow(facet->item, &d->item_room, d->items + p->nodes, sizeof *item);
    if (!item)
        return false;
    facet->item = item;
    const bool turn = p->side[0] > p->side[1];
    for (size_t i = 0; i < p->nodes; i++)
        item[d->items + i] = p->node[turn ? p->nodes - 1 - i : i];
    facet->integer[2 * f] = p->side[turn];
    facet->integer[2 * f + 1] = p->side[!turn];
    facet->marker[f] = p->marker;
    d->items += p->nodes;
    facet->start[f] = d->items - p->nodes;
    facet->start[++d->facets] = d->items;
    return true;
}

/* Around edges --------------------------------------------------------------------- */

/* An edge, its star, and the cells of its nodes in each tetrahedron there. */
typedef struct {
    tm_star star;
    uint32_t (*cell)[2];
    size_t room;
    polygon polygon;
    uint8_t *seen; /* [tetrahedra]: their edges, a bit each */
} ring;

static uint32_t face_before(const tm_dual *d, const tm_star *star, size_t i)
{
    const uint32_t t = star->tet[i];
    return d->face_point[4 * t + tm_tet_corner(d->mesh, t, star->ring[i + 1])];
}

static uint32_t face_behind(const tm_dual *d, const tm_star *star, size_t i)
{
    const uint32_t t = star->tet[i];
    return d->face_point[4 * t + tm_tet_corner(d->mesh, t, star->ring[i])];
}

/* Whether the cells of tetrahedron i are not those of the one before. */
static bool is_start(const ring *r, size_t i)
{
    return memcmp(r->cell[i], r->cell[i == 0 ? r->star.size - 1 : i - 1],
                  sizeof *r->cell) != 0;
}

/* The facet of `count` tetrahedra from place `from` on. */
static bool write_sector(tm_dual *d, ring *r, size_t from, size_t count, bool whole)
{
    const tm_star *star = &r->star;
    polygon *p = &r->polygon;
    p->nodes = 0;
    p->marker = 0;
    p->side[0] = r->cell[from][0];
    p->side[1] = r->cell[from][1];
    bool done = true;
    if (!whole) {
        const uint32_t *edge = tm_edge_map_get(&d->edge_of, star->a, star->b);
        done = edge && add_node(p, d->edge[*edge].point);
    }
    for (size_t k = 0; k < count && done; k++) {
        const size_t i = (from + k) % star->size;
        done = add_node(p, face_before(d, star, i)) && add_node(p, star->tet[i]);
    }
    if (!whole && done)
        done = add_node(p, face_behind(d, star, (from + count - 1) % star->size));
    return done && write_polygon(d, p);
}

static bool find_cells(const tm_dual *d, ring *r)
{
    const tm_star *star = &r->star;
    uint32_t(*cell)[2] = tm_grow(r->cell, &r->room, star->size, sizeof *cell);
    if (!cell)
        return false;
    r->cell = cell;
    for (size_t i = 0; i < star->size; i++) {
        const uint32_t t = star->tet[i];
        const uint8_t *corner = tm_edge_corner[star->edge[i]];
        const bool turned = d->mesh->tet[t][corner[0]] != star->a;
        cell[i][0] = d->cell[4 * t + corner[turned]];
        cell[i][1] = d->cell[4 * t + corner[!turned]];
        r->seen[t] |= (uint8_t)(1u << star->edge[i]);
    }
    return true;
}

static bool write_ring(tm_dual *d, ring *r)
{
    const size_t size = r->star.size;
    size_t first = 0;
    if (!find_cells(d, r))
        return false;
    if (r->star.closed) {
        while (first < size && !is_start(r, first))
            first++;
        if (first == size)
            return write_sector(d, r, 0, size, true);
    }
    for (size_t i = 0, count; i < size; i += count) {
        count = 1;
        while (i + count < size && !is_start(r, (first + i + count) % size))
            count++;
        if (!write_sector(d, r, (first + i) % size, count, false))
            return false;
    }
    return true;
}

static bool write_rings(tm_dual *d)
{
    enum { EDGES = 6 };
    const tm_tet_mesh *mesh = d->mesh;
    ring r = {.seen = calloc(mesh->slots + 1, 1)};
    bool done = r.seen;
    for (uint32_t t = 0; t < mesh->slots && done; t++)
        for (unsigned e = 0; e < EDGES && done; e++)
            if (!(r.seen[t] >> e & 1))
                done = tm_star_around(mesh, t, e, &r.star) && write_ring(d, &r);
    tm_star_free(&r.star);
    free(r.cell);
    free(r.polygon.node);
    free(r.seen);
    return done;
}

/* On walls ------------------------------------------------------------------------- */

/* The facet of the quads from q on. */
static bool write_row(tm_dual *d, polygon *p, uint32_t q)
{
    uint32_t node[3], cell[2];
    const uint32_t begin = q;
    const tm_dual_wall *wall = &d->wall[q / 3];
    tm_dual_half_nodes(d->mesh, wall->half, node);
    tm_dual_wall_cells(d, wall, (int)(q % 3), cell);
    const bool turned = cell[0] > cell[1];
    p->nodes = 0;
    p->marker = wall->marker;
    p->side[0] = cell[turned];
    p->side[1] = cell[!turned];
    bool done = !d->begins[q] || add_node(p, d->node_point[node[q % 3]]);
    if (done)
        done = add_node(p, d->edge[tm_dual_quad_edge(d, q, false)].point);
    for (uint32_t next; done; q = next) {
        next = d->following[q];
        d->following[q] = TM_NONE; /* written */
        done = add_node(p, d->face_point[d->wall[q / 3].half]);
        if (next == begin || !done)
            break;
        done = add_node(p, d->edge[tm_dual_quad_edge(d, q, true)].point);
        if (next == TM_NONE)
            break;
    }
    return done && write_polygon(d, p);
}

static bool write_walls(tm_dual *d)
{
    polygon p = {0};
    bool done = true;
    for (int rings = 0; rings < 2 && done; rings++)
        for (uint32_t q = 0; q < 3 * d->walls && done; q++)
            if (d->wall[q / 3].quad[q % 3] &&
                (rings ? d->following[q] != TM_NONE : d->begins[q]))
                done = write_row(d, &p, q);
    free(p.node);
    return done;
}

tm_status tm_dual_make_facets(tm_dual *d, tm_error *error)
{
    d->facets = d->items = 0;
    if (!write_rings(d) || !write_walls(d))
        return tm_fail_memory(error);
    d->facet.count = d->facets;
    return TM_OK;
}
