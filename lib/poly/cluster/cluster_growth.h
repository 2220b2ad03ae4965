/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clusters of polyhedra that are balls, grown cell by cell: one is added if the facets
 * that it shares with the cluster are a disc, and it has no other node or edge in common
 * with it. Facets that are connected through edges and have V - E + F = 1 are a disc: on
 * a sphere, what is connected has no holes then. */
#ifndef TM_POLY_CLUSTER_GROWTH_H
#define TM_POLY_CLUSTER_GROWTH_H

#include "../../mesh/polygon_edges.h"
#include "clusters.h"

typedef struct tm_growth {
    const tm_cluster_mesh *mesh;
    const tm_poly_options *options;
    const bool *kept; /* [facets] */
    tm_polygon_edges edges;
    uint32_t *piece; /* [cells]: or TM_NONE */
    uint32_t id;     /* of the piece that is grown */
    uint32_t *member;
    size_t size, member_room;
    uint32_t *queue; /* cells at the piece */
    size_t queued, queue_room;
    /* What is in the piece, or shared by it and a cell, has the last stamp of its kind.
     */
    uint32_t *node_in, *edge_in, *node_shared, *edge_shared;
    uint32_t stamp_in, stamp_shared;
    uint32_t *refused; /* [cells]: at which version of the piece, the last time */
    uint32_t version;
    uint32_t *new_nodes, *new_edges; /* stamped since cells began to be added */
    size_t node_count, node_room, edge_count, edge_room;
    uint32_t *edge_first; /* the first shared facet at an edge */
    uint32_t *shared;     /* facets that a cell shares, then their trees */
    size_t shares, shared_room;
    double (*box)[2][3];    /* [cells]: star: each is between */
    double (*normal)[3];    /* [facets]: outward from the first cell; or 0 */
    double low[3], high[3]; /* the piece is between */
    double origin[3];       /* of what follows */
    double centre[3];       /* star: a point that is so deep inside of all facets, or */
    double depth;           /* deeper; negative: none is known */
    double (*plane)[4];
    size_t plane_room;
} tm_growth;

/* Nothing is in a piece. tm_growth_free() also after an error. */
tm_status tm_growth_start(tm_growth *g, const tm_cluster_mesh *mesh,
                          const tm_poly_options *options, const bool *kept,
                          tm_error *error);
void tm_growth_free(tm_growth *g);

/* Begins the piece `id` with some cells, which are one already. False where memory is
 * out, as below. */
bool tm_growth_begin(tm_growth *g, uint32_t id, const uint32_t *cell, size_t count);

/* Adds what can be added of the cells with label[c] == name and in no piece, until
 * nothing can. */
bool tm_growth_grow(tm_growth *g, const uint32_t *label, uint32_t name);

/* Adds all of some cells, or none; *taken tells. */
bool tm_growth_add(tm_growth *g, const uint32_t *cell, size_t count, bool *taken);

/* The cell across a facet of cell c, or TM_NONE. */
static inline uint32_t tm_growth_across(const tm_growth *g, uint32_t f, uint32_t c)
{
    const uint32_t *side = g->mesh->faces->side[f];
    return side[0] == c ? side[1] : side[0];
}

/* Whether a cell is in the piece. */
static inline bool tm_growth_has(const tm_growth *g, uint32_t c)
{
    return c != TM_NONE && g->piece[c] == g->id;
}

/* cluster_star.c: finds the boxes of all cells, the normals of all facets; false where
 * memory is out. */
bool tm_growth_find_boxes(tm_growth *g);
bool tm_growth_find_normals(tm_growth *g);

/* Takes a cell into a box. */
static inline void tm_growth_widen(const tm_growth *g, uint32_t c, double low[3],
                                   double high[3])
{
    for (int x = 0; x < 3; x++) {
        low[x] = g->box[c][0][x] < low[x] ? g->box[c][0][x] : low[x];
        high[x] = g->box[c][1][x] > high[x] ? g->box[c][1][x] : high[x];
    }
}

/* Whether the piece with cell c has a ball in its kernel, as g->options say; then the
 * centre is one of the piece with c. O(facets of c), or of the piece where the centre
 * does not do any more. */
bool tm_growth_stays_star(tm_growth *g, uint32_t c, bool *memory);

#endif
