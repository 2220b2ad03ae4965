/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/hash.h"

#include <stdlib.h>
#include <string.h>

typedef struct matching {
    const tm_poly_arrays *mesh;
    tm_examination *found;
    uint32_t *first;  /* [facets]: the cell that lists the facet; TM_NONE */
    uint32_t *second; /* [facets]: the next one that does */
    uint8_t *listed;  /* [facets]: how often, 3 for more */
    uint32_t *parent; /* [cells]: a tree for each component */
} matching;

static size_t corners(const tm_poly_arrays *mesh, size_t f)
{
    return mesh->facet_start[f + 1] - mesh->facet_start[f];
}

static const uint32_t *nodes_of(const tm_poly_arrays *mesh, size_t f)
{
    return mesh->facet_node + mesh->facet_start[f];
}

static void add_defect(matching *m, tm_defect d, uint32_t first, uint32_t second,
                       uint32_t third)
{
    tm_defect_add(&m->found->defect[d],
                  (uint32_t[TM_DEFECT_NUMBERS]){first, second, third});
}

static void list_facets(matching *m)
{
    const tm_poly_arrays *mesh = m->mesh;
    enum { MANY = 3 };
    for (uint32_t c = 0; c < mesh->cells; c++)
        for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
            const uint32_t f = mesh->cell_facet[i];
            uint32_t *at = m->listed[f] == 0 ? m->first : m->second;
            at[f] = c;
            m->listed[f] = m->listed[f] < MANY ? m->listed[f] + 1 : MANY;
        }
}

/* Whether exactly the cells that a facet names list it. */
static bool is_matched(const matching *m, uint32_t f)
{
    const uint32_t a = m->mesh->side[f][0], b = m->mesh->side[f][1];
    if (a == TM_NONE || a == b)
        return false;
    if (b == TM_NONE)
        return m->listed[f] == 1 && m->first[f] == a;
    return m->listed[f] == 2 && ((m->first[f] == a && m->second[f] == b) ||
                                 (m->first[f] == b && m->second[f] == a));
}

/* Matches facets with cells, and joins cells to components. */
static void match(matching *m)
{
    const tm_poly_arrays *mesh = m->mesh;
    list_facets(m);
    for (uint32_t c = 0; c < mesh->cells; c++)
        m->parent[c] = c;
    for (uint32_t f = 0; f < mesh->facets; f++) {
        if (!is_matched(m, f))
            add_defect(m, TM_UNMATCHED_FACE, f, 0, 0);
        m->found->boundary_faces += mesh->side[f][1] == TM_NONE;
        if (m->listed[f] < 2)
            continue;
        tm_set_unite(m->parent, m->first[f], m->second[f]);
    }
}

/* stamp[nodes] is TM_NONE, then the last facet that met the node. */
static void look_for_nodes_twice(matching *m, uint32_t *stamp)
{
    for (uint32_t f = 0; f < m->mesh->facets; f++) {
        const uint32_t *node = nodes_of(m->mesh, f);
        for (size_t i = 0; i < corners(m->mesh, f); i++) {
            if (stamp[node[i]] == f)
                add_defect(m, TM_DEGENERATE, f, node[i], 1);
            stamp[node[i]] = f;
        }
    }
}

/* Repeated facets ------------------------------------------------------------------- */

/* The nodes of a facet, in a form that does not depend on where it begins and which way
 * it turns: where its smallest node is, and which way its smaller neighbour. */
typedef struct ring {
    const uint32_t *node;
    size_t count;
    size_t first;
    bool back;
} ring;

static uint32_t at(const ring *r, size_t i)
{
    return r->node[(r->first + (r->back ? r->count - i : i)) % r->count];
}

static ring ring_of(const tm_poly_arrays *mesh, size_t f)
{
    ring r = {nodes_of(mesh, f), corners(mesh, f), 0, false};
    for (size_t i = 1; i < r.count; i++)
        if (r.node[i] < r.node[r.first])
            r.first = i;
    r.back = at(&r, r.count - 1) < at(&r, 1);
    return r;
}

static uint64_t hash(const ring *r)
{
    uint64_t h = r->count;
    for (size_t i = 0; i < r->count; i++)
        h = tm_hash(h, at(r, i));
    return h;
}

static bool equal(const ring *r, const ring *s)
{
    if (r->count != s->count)
        return false;
    for (size_t i = 0; i < r->count; i++)
        if (at(r, i) != at(s, i))
            return false;
    return true;
}

tm_status tm_poly_find_repeated(tm_examination *found, const tm_poly_arrays *mesh,
                                uint32_t first, uint32_t past, tm_error *error)
{
    tm_hash_table table;
    if (!tm_hash_make(&table, mesh->facets))
        return tm_fail_memory(error);
    for (uint32_t f = 0; f < mesh->facets; f++) {
        const ring r = ring_of(mesh, f);
        if (at(&r, 0) < first || at(&r, 0) >= past)
            continue;
        uint32_t *slot = tm_hash_slot(&table, hash(&r));
        for (; *slot != TM_HASH_FREE; slot = tm_hash_next(&table, slot)) {
            const ring earlier = ring_of(mesh, *slot);
            if (equal(&r, &earlier))
                break;
        }
        if (*slot == TM_HASH_FREE)
            *slot = f;
        else
            tm_defect_add(&found->defect[TM_REPEATED_FACE],
                          (uint32_t[TM_DEFECT_NUMBERS]){f, *slot});
    }
    tm_hash_free(&table);
    return TM_OK;
}

/* Edges ----------------------------------------------------------------------------- */

/* Of the edge from corner i on: its smaller node; *larger the other one. */
static uint32_t smaller(const uint32_t *node, size_t count, size_t i, uint32_t *larger)
{
    const uint32_t a = node[i], b = node[i + 1 < count ? i + 1 : 0];
    *larger = a < b ? b : a;
    return a < b ? a : b;
}

tm_status tm_poly_find_edges(uint32_t (*edge)[2], size_t *edges,
                             const tm_poly_arrays *mesh, uint32_t first, uint32_t past,
                             tm_error *error)
{
    const size_t all = mesh->facets > 0 ? mesh->facet_start[mesh->facets] : 0;
    size_t *start = calloc(mesh->nodes + 2, sizeof *start);
    uint32_t *stamp = tm_new(mesh->nodes, sizeof *stamp);
    uint32_t *end = tm_new(all, sizeof *end), larger;
    *edges = 0;
    if (start && end && stamp) {
        /* start[v + 2] counts, then start[v + 1] is where the next edge of v goes. */
        size_t *next = start + 1;
        for (size_t f = 0; f < mesh->facets; f++)
            for (size_t i = 0; i < corners(mesh, f); i++)
                next[smaller(nodes_of(mesh, f), corners(mesh, f), i, &larger) + 1]++;
        for (size_t v = 0; v < mesh->nodes; v++)
            next[v + 1] += next[v];
        for (size_t f = 0; f < mesh->facets; f++)
            for (size_t i = 0; i < corners(mesh, f); i++) {
                const uint32_t v =
                    smaller(nodes_of(mesh, f), corners(mesh, f), i, &larger);
                end[next[v]++] = larger;
            }
        memset(stamp, UINT8_MAX, mesh->nodes * sizeof *stamp);
        for (uint32_t v = first; v < past; v++)
            for (size_t i = start[v]; i < start[v + 1]; i++) {
                if (stamp[end[i]] == v)
                    continue;
                stamp[end[i]] = v;
                if (edge) {
                    edge[*edges][0] = v;
                    edge[*edges][1] = end[i];
                }
                ++*edges;
            }
    }
    const bool enough = start && end && stamp;
    free(start);
    free(end);
    free(stamp);
    return enough ? TM_OK : tm_fail_memory(error);
}

tm_status tm_poly_match_facets(tm_examination *found, const tm_poly_arrays *mesh,
                               uint32_t *parent, tm_error *error)
{
    matching m = {.mesh = mesh, .found = found, .parent = parent};
    uint32_t *stamp = tm_new(mesh->nodes, sizeof *stamp);
    m.first = tm_new(mesh->facets, sizeof *m.first);
    m.second = tm_new(mesh->facets, sizeof *m.second);
    m.listed = calloc(mesh->facets + 1, sizeof *m.listed);
    const bool enough = m.first && m.second && m.listed && stamp;
    if (enough) {
        memset(stamp, UINT8_MAX, mesh->nodes * sizeof *stamp);
        match(&m);
        look_for_nodes_twice(&m, stamp);
    }
    free(m.first);
    free(m.second);
    free(m.listed);
    free(stamp);
    return enough ? TM_OK : tm_fail_memory(error);
}
