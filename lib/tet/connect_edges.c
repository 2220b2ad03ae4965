/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which edges more than two faces of the boundary share, and which are inside. */
#include "connect.h"

#include "../base/array.h"

#include <stdlib.h>

/* The edges of the boundary, in a bucket for each smaller node. */

typedef struct {
    uint32_t larger; /* node */
    uint32_t faces;  /* of the boundary, at the edge */
} edge;

typedef struct {
    uint32_t *start; /* [nodes + 1] */
    uint32_t *past;  /* [nodes]: the edges of bucket v are start[v] … past[v] */
    edge *edge;
} buckets;

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint32_t greater(uint32_t a, uint32_t b)
{
    return a < b ? b : a;
}

static bool is_on_boundary(const tm_constrained_face *face)
{
    return (face->side[0] == TM_NONE) != (face->side[1] == TM_NONE);
}

static edge *find(const buckets *b, uint32_t v, uint32_t w)
{
    uint32_t low = lesser(v, w), high = greater(v, w);
    edge *past = b->edge + b->past[low];
    for (edge *e = b->edge + b->start[low]; e < past; e++)
        if (e->larger == high)
            return e;
    return NULL;
}

/* Room for three edges of each boundary face; false where memory is out. */
static bool start(buckets *b, const tm_tet_mesh *mesh)
{
    b->start = tm_new(mesh->nodes + 1, sizeof *b->start);
    b->past = calloc(mesh->nodes + 1, sizeof *b->past);
    if (!b->start || !b->past)
        return false;
    uint32_t sum = 0;
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3 && is_on_boundary(&mesh->face[f]); i++)
            b->past[lesser(mesh->face[f].node[i], mesh->face[f].node[(i + 1) % 3])]++;
    for (size_t v = 0; v < mesh->nodes; v++) {
        b->start[v] = sum;
        sum += b->past[v];
        b->past[v] = b->start[v];
    }
    b->edge = tm_new(sum, sizeof *b->edge);
    return b->edge != NULL;
}

static void count_faces(buckets *b, const tm_tet_mesh *mesh)
{
    for (size_t f = 0; f < mesh->faces; f++)
        for (int i = 0; i < 3 && is_on_boundary(&mesh->face[f]); i++) {
            uint32_t v = mesh->face[f].node[i], w = mesh->face[f].node[(i + 1) % 3];
            edge *e = find(b, v, w);
            if (e)
                e->faces++;
            else
                b->edge[b->past[lesser(v, w)]++] = (edge){greater(v, w), 1};
        }
}

/* Locks the edges with more than two boundary faces. */
static bool lock_edges(const buckets *b, tm_tet_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->nodes; v++)
        for (const edge *e = b->edge + b->start[v]; e < b->edge + b->past[v]; e++) {
            if (e->faces <= 2)
                continue;
            if (!tm_edge_map_reserve(&mesh->locked, 1))
                return false;
            tm_edge_map_put(&mesh->locked, v, e->larger, 0);
        }
    return true;
}

static void look_for_inner_edges(const buckets *b, tm_tet_mesh *mesh)
{
    for (size_t e = 0; e < mesh->edges; e++) {
        if (find(b, mesh->edge[e].node[0], mesh->edge[e].node[1]))
            continue;
        mesh->inner_edges = true;
        mesh->inner_marked_edges |= mesh->edge[e].marker != 0;
    }
}

tm_status tm_tet_mesh_find_edges(tm_tet_mesh *mesh, tm_error *error)
{
    buckets b = {0};
    bool done = start(&b, mesh);
    if (done) {
        count_faces(&b, mesh);
        done = lock_edges(&b, mesh);
        look_for_inner_edges(&b, mesh);
    }
    free(b.start);
    free(b.past);
    free(b.edge);
    return done ? TM_OK : tm_fail_memory(error);
}
