/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Edges by the smaller one of their nodes; a part of tm_element_examine_faces(). */
#ifndef TM_EXAMINE_ELEMENT_EDGES_H
#define TM_EXAMINE_ELEMENT_EDGES_H

#include "../mesh/mesh_view.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What begins at the nodes: of v it is item[start[v]] … item[start[v + 1] - 1]. */
typedef struct tm_at_nodes {
    size_t *start;
    uint32_t *item;
} tm_at_nodes;

void tm_at_nodes_free(tm_at_nodes *list);

/* The larger nodes of far edges: those of whose element's two faces at them none has
 * their smaller node as its smallest. sign[elements]: see element_examine_faces.h. False
 * where memory is out. Up to 8 of threads >= 1 look at all elements each. O(nodes +
 * elements). */
bool tm_list_far_edges(tm_at_nodes *far_of, const tm_mesh_view *mesh, const int8_t *sign,
                       unsigned threads);

/* The rows of .edge; no arrays where there are none. False where memory is out.
 * O(nodes + rows). */
bool tm_list_edge_rows(tm_at_nodes *listed, const tm_mesh_view *mesh);

#endif
