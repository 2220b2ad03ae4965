/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds equal polygons: a hash table from the cycle of a polygon's nodes, wherever it
 * begins and however it turns, to the number of the first polygon that has it. Polygons
 * are flat arrays: number p is node[start[p] … start[p + 1]). Open addressing with linear
 * probing; O(k) expected for a polygon of k nodes. */
#ifndef TM_MESH_POLYGON_TABLE_H
#define TM_MESH_POLYGON_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Begins as {0}. */
typedef struct tm_polygon_table {
    uint32_t *slot; /* [slots]: id, or UINT32_MAX for free */
    size_t slots;   /* a power of two, or 0 */
    size_t polygons;
} tm_polygon_table;

/* How two polygons of k nodes are the same: +1 if they turn alike, -1 if they turn in
 * opposite senses, 0 if they are not. */
int tm_polygon_compare(const uint32_t *a, const uint32_t *b, size_t k);

/* Turns a polygon of k nodes the other way, from the same first node. */
static inline void tm_polygon_turn(uint32_t *node, size_t k)
{
    for (size_t i = 1, j = k - 1; i < j; i++, j--) {
        const uint32_t other = node[i];
        node[i] = node[j];
        node[j] = other;
    }
}

/* The number of the first polygon that is the same as number id, which is id itself where
 * there was none: it is put in. The arrays may have moved since the last call. False
 * where memory is out. */
bool tm_polygon_table_join(tm_polygon_table *table, const size_t *start,
                           const uint32_t *node, uint32_t id, uint32_t *first);

/* The number of the polygon that is the same as these k nodes, or UINT32_MAX. */
uint32_t tm_polygon_table_find(const tm_polygon_table *table, const size_t *start,
                               const uint32_t *node, const uint32_t *polygon, size_t k);

void tm_polygon_table_free(tm_polygon_table *table);

#endif
