/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The edges of polygons: which polygons have an edge in common. Polygons are flat arrays:
 * number p is node[start[p] … start[p + 1]). Corner i, an index into node, is also the
 * side of its polygon from there to the next corner. */
#ifndef TM_MESH_POLYGON_EDGES_H
#define TM_MESH_POLYGON_EDGES_H

#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tm_polygon_edges {
    size_t edges;
    size_t *edge_of;   /* [corners]: the edge that the side is */
    size_t *start;     /* [edges + 1]: edge e is in polygon[start[e] … start[e + 1]), */
    uint32_t *polygon; /* [corners]: once for each of their sides that is e, */
    bool *ascending;   /* [corners]: and whether that goes from the lesser node */
} tm_polygon_edges;

/* Finds them. All nodes are below `nodes`. Where group is not NULL, group[p] < groups,
 * and edges of polygons of different groups are different edges. *edges is to be freed,
 * after an error too. O(corners + nodes + groups). */
tm_status tm_polygon_edges_find(tm_polygon_edges *edges, size_t polygons,
                                const size_t *start, const uint32_t *node, size_t nodes,
                                const uint32_t *group, size_t groups, tm_error *error);
void tm_polygon_edges_free(tm_polygon_edges *edges);

#endif
