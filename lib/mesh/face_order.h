/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faces of tetrahedra in an order in which equal ones follow each other: by the
 * smallest node (bucket sort), then by the other two. */
#ifndef TM_MESH_FACE_ORDER_H
#define TM_MESH_FACE_ORDER_H

#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A face without its smallest node. `half` is 4t + i, or, for a face that was added,
 * the number of it with TM_FACE_ORDER_ADDED. */
typedef struct tm_face_entry {
    uint64_t key; /* middle node << 32 | largest node */
    uint32_t half;
} tm_face_entry;

#define TM_FACE_ORDER_ADDED ((uint32_t)1 << 31)

typedef struct tm_face_order {
    size_t nodes;
    size_t *start; /* [nodes + 1]: the faces whose smallest node is v: start[v] … */
    uint32_t *half;
    const uint32_t (*tet)[4];
    const uint32_t (*added)[3];
    size_t node; /* the next one */
    tm_face_entry *entry;
    size_t entries; /* those of the node before; sorted by key */
    size_t room;
} tm_face_order;

/* Orders the 4·tets faces of tetrahedra and the `added` ones beside them (a face of NULL
 * nodes may not be among them); the arrays have to stay while the order is used. All
 * nodes are below `nodes`. O(tets + nodes). */
tm_status tm_face_order_init(tm_face_order *order, const uint32_t (*tet)[4], size_t tets,
                             const uint32_t (*added)[3], size_t added_count, size_t nodes,
                             tm_error *error);
void tm_face_order_free(tm_face_order *order);

/* Fills entry[0 … entries) with the faces of the next node (order->node - 1 is it then)
 * that has any. False after the last. O(k log k) for k of them. *status is set where
 * memory is out. */
bool tm_face_order_next(tm_face_order *order, tm_status *status, tm_error *error);

#endif
