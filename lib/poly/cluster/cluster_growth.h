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
    uint32_t *edge_first; /* the first shared facet at an edge */
    uint32_t *shared;     /* facets that a cell shares, then their trees */
    size_t shares, shared_room;
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

#endif
