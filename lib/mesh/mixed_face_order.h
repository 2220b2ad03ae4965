/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faces of mixed elements in an order in which equal ones follow each other: by the
 * smallest node (bucket sort), then by the others. */
#ifndef TM_MESH_MIXED_FACE_ORDER_H
#define TM_MESH_MIXED_FACE_ORDER_H

#include "../examine/mixed_examine.h"

#include <stdbool.h>

/* What is known of an element: 1 upright, -1 turned, 0 without a side, or this. */
enum { TM_MIXED_NODE_TWICE = 2 };

/* A face without its smallest node v. Faces of equal key and shape are the same; those of
 * which only the lowest two bits of the shape differ have the same nodes in another
 * order. */
typedef struct tm_mixed_face {
    uint64_t key;   /* second node << 32 | third node, in ascending order */
    uint64_t shape; /* largest node << 2 | which one is opposite to v: 1 the second, 2 the
                       third, 3 the largest; TM_NONE << 2 of a triangle */
    uint32_t half;  /* 8e + i: face i of element e; or TM_MIXED_ROW | row of .face;
                       TM_MIXED_ROW | faces + row of .facet */
    bool turned;    /* of its two nodes beside v, the smaller one does not follow v */
} tm_mixed_face;

#define TM_MIXED_ROW ((uint32_t)1 << 31)

typedef struct tm_mixed_face_order {
    const tm_mixed_arrays *mesh;
    size_t *start; /* [nodes + 2]: the faces whose smallest node is v: start[v] … */
    uint32_t *half;
    size_t node; /* the next one */
    tm_mixed_face *entry;
    size_t entries; /* those of the node before; sorted by key, shape, half */
    size_t room;
} tm_mixed_face_order;

/* Orders the faces of all elements but those of sign TM_MIXED_NODE_TWICE, and the rows of
 * .face and .facet of three or four nodes, none twice. The mesh has to stay while the
 * order is used. O(elements + nodes). */
tm_status tm_mixed_face_order_init(tm_mixed_face_order *order,
                                   const tm_mixed_arrays *mesh, const int8_t *sign,
                                   tm_error *error);
void tm_mixed_face_order_free(tm_mixed_face_order *order);

/* Fills entry[0 … entries) with the faces of the next node (order->node - 1 is it then)
 * that has any. False after the last. O(k log k) for k of them. *status is set where
 * memory is out. */
bool tm_mixed_face_order_next(tm_mixed_face_order *order, tm_status *status,
                              tm_error *error);

/* Whether a row is that of a face: three or four nodes, none twice. */
bool tm_mixed_row_is_face(const uint32_t *node, size_t count);

/* The nodes of face i of an element, outward where it is upright; how many. */
size_t tm_mixed_face_of(const tm_mixed_arrays *mesh, uint32_t half, uint32_t node[4]);

#endif
