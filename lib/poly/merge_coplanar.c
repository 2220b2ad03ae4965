/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polygons of triangles in one plane, grown triangle by triangle: one is added if it has
 * one edge of the polygon and its third node is not in it, or two edges of it; then the
 * node between these goes inside. So the polygon stays a disc. */
#include "facets.h"

#include "../base/array.h"
#include "../examine/poly/poly_statistics.h"
#include "../geom/vector.h"

#include <stdlib.h>
#include <string.h>

enum { CORNERS = 3, LEAST_FACETS = 4, MEASURES = 3 };

typedef struct {
    const tm_tet_mesh *mesh;
    const tm_coplanar *plane;
    const tm_block *facet; /* triangles */
    size_t cells;
    unsigned char *facets_of; /* [cells]: polygons so far, LEAST_FACETS at most */
    bool *stays;              /* [cells]: merged, it would have too few of them */
    tm_edge_map edges;        /* 4 facet + corner, of the facets of one pair of cells */
    uint32_t (*beyond)[CORNERS]; /* the facet at edge i, i+1 of each, or TM_NONE */
    uint32_t *polygon;           /* of each facet, or TM_NONE */
    uint32_t *node_polygon;      /* [nodes]: the last one that has it */
    uint32_t *queue;             /* facets */
    size_t queue_room;
    /* of the polygon that is grown */
    uint32_t id;
    const double *on_plane;
    double normal[3];
} merger;

static const uint32_t *nodes_of(const merger *m, uint32_t f)
{
    return m->facet->item + CORNERS * (size_t)f;
}

/* Whether two facets have the same cells and marker. */
static bool is_alike(const tm_block *facet, uint32_t f, uint32_t g)
{
    return memcmp(facet->integer + 2 * (size_t)f, facet->integer + 2 * (size_t)g,
                  2 * sizeof *facet->integer) == 0 &&
           (!facet->markers || facet->marker[f] == facet->marker[g]);
}

static bool is_of_staying(const merger *m, uint32_t f)
{
    const uint32_t *side = m->facet->integer + 2 * (size_t)f;
    return m->stays[side[0]] || (side[1] != TM_NONE && m->stays[side[1]]);
}

static bool has_marked_edge(const merger *m, uint32_t a, uint32_t b)
{
    const tm_marked_edge *edge = tm_tet_mesh_edge(m->mesh, a, b);
    return edge && edge->marker != 0;
}

/* Finds the facets beyond the edges of those from..to, which have one first cell. An edge
 * is met by two alike facets, by others too: each pair of cells has its own slot. */
static bool find_neighbours(merger *m, uint32_t from, uint32_t to)
{
    for (uint32_t f = from; f < to; f++)
        for (int i = 0; i < CORNERS; i++)
            m->beyond[f][i] = TM_NONE;
    tm_edge_map_free(&m->edges);
    if (!tm_edge_map_reserve(&m->edges, CORNERS * (size_t)(to - from)))
        return false;
    for (uint32_t f = from; f < to; f++)
        for (uint32_t i = 0; i < CORNERS; i++) {
            const uint32_t *n = nodes_of(m, f);
            uint32_t a = n[i], b = n[(i + 1) % CORNERS];
            uint32_t *other = tm_edge_map_get(&m->edges, a, b);
            if (!other) {
                tm_edge_map_put(&m->edges, a, b, 4 * f + i);
            } else if (is_alike(m->facet, f, *other / 4) && !has_marked_edge(m, a, b) &&
                       !is_of_staying(m, f)) {
                m->beyond[f][i] = *other / 4;
                m->beyond[*other / 4][*other % 4] = f;
            }
        }
    return true;
}

static bool set_plane(merger *m, uint32_t f)
{
    const uint32_t *n = nodes_of(m, f);
    const double(*xyz)[3] = (const double(*)[3])m->mesh->xyz;
    m->on_plane = xyz[n[0]];
    tm_triangle_normal(m->normal, xyz[n[0]], xyz[n[1]], xyz[n[2]]);
    double length = tm_norm(m->normal);
    for (int x = 0; x < 3; x++)
        m->normal[x] /= length;
    return length > 0;
}

/* Whether facet f is in the plane. */
static bool is_in_plane(const merger *m, uint32_t f)
{
    const uint32_t *n = nodes_of(m, f);
    const double(*xyz)[3] = (const double(*)[3])m->mesh->xyz;
    const double half_turn = 180, pi = acos(-1);
    double normal[3], to[3];
    tm_triangle_normal(normal, xyz[n[0]], xyz[n[1]], xyz[n[2]]);
    double along = tm_dot(normal, m->normal), length = tm_norm(normal);
    if (m->plane->degrees > 0)
        return along >= cos(m->plane->degrees * pi / half_turn) * length && length > 0;
    for (int i = 0; i < CORNERS; i++) {
        tm_subtract(to, xyz[n[i]], m->on_plane);
        if (!(fabs(tm_dot(to, m->normal)) <= m->plane->flatness))
            return false;
    }
    return along > 0;
}

/* Whether the polygon stays a disc with facet f. */
static bool meets_in_path(const merger *m, uint32_t f)
{
    int shared = 0, last = 0;
    for (int i = 0; i < CORNERS; i++) {
        uint32_t g = m->beyond[f][i];
        if (g == TM_NONE || m->polygon[g] != m->id)
            continue;
        shared++;
        last = i;
    }
    uint32_t third = nodes_of(m, f)[(last + 2) % CORNERS];
    return shared == 2 || (shared == 1 && m->node_polygon[third] != m->id);
}

static bool grow_polygon(merger *m, uint32_t first)
{
    size_t queued = 0;
    bool has_plane = set_plane(m, first);
    for (uint32_t f = first, next = 0;; f = m->queue[next++]) {
        if (f == first ||
            (m->polygon[f] == TM_NONE && is_in_plane(m, f) && meets_in_path(m, f))) {
            uint32_t *queue =
                tm_grow(m->queue, &m->queue_room, queued + CORNERS, sizeof *queue);
            if (!queue)
                return false;
            m->queue = queue;
            m->polygon[f] = m->id;
            for (int i = 0; i < CORNERS; i++) {
                m->node_polygon[nodes_of(m, f)[i]] = m->id;
                if (m->beyond[f][i] != TM_NONE && has_plane)
                    queue[queued++] = m->beyond[f][i];
            }
        }
        if (next == queued)
            return true;
    }
}

/* The border of a polygon from facet f, whose edge i is on it: walks around each node to
 * the next edge on the border. Returns how many nodes, which are written. */
static size_t write_border(const merger *m, uint32_t f, int i, uint32_t *node)
{
    uint32_t first = f;
    int first_edge = i;
    size_t count = 0;
    do {
        node[count++] = nodes_of(m, f)[i];
        i = (i + 1) % CORNERS;
        for (;;) { /* inside: go on in the next facet around the node */
            uint32_t g = m->beyond[f][i], at = nodes_of(m, f)[i];
            if (g == TM_NONE || m->polygon[g] != m->polygon[f])
                break;
            f = g;
            i = 0;
            while (nodes_of(m, f)[i] != at)
                i++;
        }
    } while (f != first || i != first_edge);
    return count;
}

/* The first edge of facet f that is on the border of its polygon; CORNERS: none is. */
static int border_edge(const merger *m, uint32_t f)
{
    int i = 0;
    while (i < CORNERS && m->beyond[f][i] != TM_NONE &&
           m->polygon[m->beyond[f][i]] == m->polygon[f])
        i++;
    return i;
}

/* Writes the polygons; first[p] is a facet of polygon p that is on its border. */
static void write_polygons(const merger *m, const uint32_t *first, tm_block *to)
{
    for (size_t p = 0; p < to->count; p++) {
        uint32_t f = first[p];
        size_t start = to->start[p];
        to->start[p + 1] =
            start + write_border(m, f, border_edge(m, f), to->item + start);
        memcpy(to->integer + 2 * p, m->facet->integer + 2 * (size_t)f,
               2 * sizeof *to->integer);
        if (to->markers)
            to->marker[p] = m->facet->marker[f];
    }
}

/* Finds the polygons; *polygons is how many. */
static bool find_polygons(merger *m, size_t *polygons)
{
    const uint32_t *cells = m->facet->integer;
    *polygons = 0;
    for (size_t v = 0; v < m->mesh->nodes; v++)
        m->node_polygon[v] = TM_NONE;
    for (size_t f = 0; f < m->facet->count; f++)
        m->polygon[f] = TM_NONE;
    for (uint32_t from = 0, to = 0; from < m->facet->count; from = to) {
        while (to < m->facet->count && cells[2 * to] == cells[2 * from])
            to++;
        if (!find_neighbours(m, from, to))
            return false;
        for (uint32_t f = from; f < to; f++) {
            if (m->polygon[f] != TM_NONE)
                continue;
            m->id = (uint32_t)(*polygons)++;
            if (!grow_polygon(m, f))
                return false;
        }
    }
    return true;
}

static void count_facet(merger *m, uint32_t cell)
{
    if (cell != TM_NONE && m->facets_of[cell] < LEAST_FACETS)
        m->facets_of[cell]++;
}

/* Whether a cell keeps too few polygons; it is to stay as it is. */
static bool find_flat_cells(merger *m, size_t polygons)
{
    bool found = false;
    size_t seen = 0;
    memset(m->facets_of, 0, m->cells);
    for (size_t f = 0; f < m->facet->count && seen < polygons; f++) {
        if (m->polygon[f] < seen)
            continue; /* polygons are numbered as their first facets come */
        seen++;
        count_facet(m, m->facet->integer[2 * f]);
        count_facet(m, m->facet->integer[2 * f + 1]);
    }
    for (size_t c = 0; c < m->cells; c++) {
        found |= m->facets_of[c] < LEAST_FACETS && !m->stays[c];
        m->stays[c] |= m->facets_of[c] < LEAST_FACETS;
    }
    return found;
}

/* A facet on the border of each polygon. */
static uint32_t *find_borders(const merger *m, size_t polygons)
{
    uint32_t *first = tm_new(polygons, sizeof *first);
    for (size_t p = 0; p < polygons && first; p++)
        first[p] = TM_NONE;
    for (uint32_t f = 0; f < m->facet->count && first; f++)
        if (first[m->polygon[f]] == TM_NONE && border_edge(m, f) < CORNERS)
            first[m->polygon[f]] = f;
    return first;
}

/* The polygons as a block, and the cells of these. */
static tm_status write(const merger *m, size_t polygons, tm_block *merged, tm_block *cell,
                       tm_error *error)
{
    uint32_t *first = find_borders(m, polygons);
    tm_status status = first ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_block_allocate(merged, polygons, CORNERS * m->facet->count, error);
    if (status == TM_OK) {
        write_polygons(m, first, merged);
        status = tm_cells_from_facets(merged, cell, m->cells, error);
    }
    free(first);
    return status;
}

/* Measures the cells of some facets: their volumes, then their kernels' radii, then, if
 * that is asked for, whether their centroids see all. */
static tm_status measure(const merger *m, const tm_block *facet, const tm_block *cell,
                         double *measured, tm_error *error)
{
    const unsigned threads = 1;
    const tm_poly_arrays mesh = {.nodes = m->mesh->nodes,
                                 .xyz = (const double(*)[3])m->mesh->xyz,
                                 .facets = facet->count,
                                 .side = (const uint32_t(*)[2])facet->integer,
                                 .facet_start = facet->start,
                                 .facet_node = facet->item,
                                 .cells = cell->count,
                                 .cell_start = cell->start,
                                 .cell_facet = cell->item};
    tm_status status =
        tm_poly_measure_each(measured, measured + m->cells, &mesh, threads, error);
    if (status != TM_OK || !m->plane->centroid)
        return status;
    bool *unseen = tm_new(m->cells, sizeof *unseen);
    status = unseen ? tm_poly_find_unseen(unseen, &mesh, error) : tm_fail_memory(error);
    for (size_t c = 0; c < m->cells && status == TM_OK; c++)
        measured[2 * m->cells + c] = unseen[c] ? 0 : 1;
    free(unseen);
    return status;
}

/* Whether a cell has lost its volume or its star by facets that are not plane; it is to
 * stay as it is. */
static bool find_bent_cells(merger *m, const double *before, const double *now)
{
    bool found = false;
    for (size_t c = 0; c < m->cells; c++) {
        bool lost = false;
        for (size_t k = c; k < MEASURES * m->cells; k += m->cells) {
            const double least = k / m->cells == 1 ? m->plane->radius : 0;
            lost |= before[k] > least && !(now[k] > least);
        }
        found |= lost && !m->stays[c];
        m->stays[c] |= lost;
    }
    return found;
}

/* An empty block of the kind, without attributes. */
static tm_block empty_like(const tm_block *b)
{
    tm_block empty = {.kind = b->kind, .markers = b->markers};
    memcpy(empty.name, b->name, sizeof empty.name);
    return empty;
}

/* Merges until all cells that are not to stay as they are have kept what they were. */
static tm_status merge(merger *m, const tm_block *was, tm_block *merged, tm_block *cell,
                       tm_error *error)
{
    const bool bends = m->plane->degrees > 0;
    double *measured = calloc(2 * MEASURES * m->cells + 1, sizeof *measured);
    double *before = measured, *now = measured ? measured + MEASURES * m->cells : NULL;
    tm_status status = measured ? TM_OK : tm_fail_memory(error);
    bool again = status == TM_OK;
    if (again && bends)
        status = measure(m, m->facet, was, before, error);
    while (again && status == TM_OK) {
        size_t polygons;
        if (!find_polygons(m, &polygons)) {
            status = tm_fail_memory(error);
            break;
        }
        again = find_flat_cells(m, polygons);
        if (again)
            continue;
        status = write(m, polygons, merged, cell, error);
        if (status == TM_OK && bends) {
            status = measure(m, merged, cell, now, error);
            again = status == TM_OK && find_bent_cells(m, before, now);
        }
    }
    free(measured);
    return status;
}

static bool allocate(merger *m)
{
    size_t facets = m->facet->count;
    m->beyond = tm_new(facets, sizeof *m->beyond);
    m->polygon = tm_new(facets, sizeof *m->polygon);
    m->node_polygon = tm_new(m->mesh->nodes, sizeof *m->node_polygon);
    m->facets_of = tm_new(m->cells, 1);
    m->stays = calloc(m->cells + 1, sizeof *m->stays);
    return m->beyond && m->polygon && m->node_polygon && m->facets_of && m->stays;
}

tm_status tm_merge_coplanar(const tm_tet_mesh *mesh, const tm_coplanar *plane,
                            tm_block *facet, tm_block *cell, size_t *joined,
                            tm_error *error)
{
    merger m = {.mesh = mesh, .plane = plane, .facet = facet, .cells = cell->count};
    tm_block merged = empty_like(facet), cells = empty_like(cell);
    tm_status status =
        allocate(&m) ? merge(&m, cell, &merged, &cells, error) : tm_fail_memory(error);
    tm_edge_map_free(&m.edges);
    free(m.beyond);
    free(m.polygon);
    free(m.node_polygon);
    free(m.facets_of);
    free(m.stays);
    free(m.queue);
    *joined = facet->count - merged.count;
    /* The new ones take the place of the old ones; the cells keep their attributes. */
    cells.attributes = cell->attributes;
    cells.attribute = cell->attribute;
    cell->attribute = NULL;
    tm_block_clear(facet);
    tm_block_clear(cell);
    *facet = merged;
    *cell = cells;
    return status;
}
