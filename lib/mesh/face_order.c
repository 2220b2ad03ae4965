/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "face_order.h"

#include "../base/array.h"
#include "../element/shape.h"

#include <stdlib.h>
#include <string.h>

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline void order3(uint32_t n[3])
{
    uint32_t swap;
    if (n[0] > n[1])
        swap = n[0], n[0] = n[1], n[1] = swap;
    if (n[1] > n[2])
        swap = n[1], n[1] = n[2], n[2] = swap;
    if (n[0] > n[1])
        swap = n[0], n[0] = n[1], n[1] = swap;
}

static inline void face_nodes(const tm_face_order *order, uint32_t half, uint32_t n[3])
{
    if (half & TM_FACE_ORDER_ADDED) {
        memcpy(n, order->added[half & ~TM_FACE_ORDER_ADDED], 3 * sizeof *n);
    } else {
        const uint32_t *t = order->tet[half / 4];
        const uint8_t *corner = tm_face_corner[half % 4];
        for (int i = 0; i < 3; i++)
            n[i] = t[corner[i]];
    }
    order3(n);
}

static inline uint32_t smallest(const tm_face_order *order, uint32_t half)
{
    const uint32_t *n;
    if (half & TM_FACE_ORDER_ADDED) {
        n = order->added[half & ~TM_FACE_ORDER_ADDED];
        return lesser(n[0], lesser(n[1], n[2]));
    }
    n = order->tet[half / 4];
    const uint8_t *corner = tm_face_corner[half % 4];
    return lesser(n[corner[0]], lesser(n[corner[1]], n[corner[2]]));
}

tm_status tm_face_order_init(tm_face_order *order, const uint32_t (*tet)[4], size_t tets,
                             const uint32_t (*added)[3], size_t added_count, size_t nodes,
                             tm_error *error)
{
    *order = (tm_face_order){.nodes = nodes, .tet = tet, .added = added};
    order->start = calloc(nodes + 2, sizeof *order->start);
    order->half = tm_new(4 * tets + added_count, sizeof *order->half);
    if (!order->start || !order->half) {
        tm_face_order_free(order);
        return tm_fail_memory(error);
    }
    /* start[v + 2] counts, then start[v + 1] is where the next face of v goes. */
    size_t *next = order->start + 1;
    for (size_t h = 0; h < 4 * tets; h++)
        next[smallest(order, (uint32_t)h) + 1]++;
    for (size_t f = 0; f < added_count; f++)
        next[smallest(order, (uint32_t)f | TM_FACE_ORDER_ADDED) + 1]++;
    for (size_t v = 0; v < nodes; v++)
        next[v + 1] += next[v];
    for (size_t h = 0; h < 4 * tets; h++)
        order->half[next[smallest(order, (uint32_t)h)]++] = (uint32_t)h;
    for (size_t f = 0; f < added_count; f++) {
        uint32_t half = (uint32_t)f | TM_FACE_ORDER_ADDED;
        order->half[next[smallest(order, half)]++] = half;
    }
    return TM_OK;
}

void tm_face_order_free(tm_face_order *order)
{
    free(order->start);
    free(order->half);
    free(order->entry);
    *order = (tm_face_order){0};
}

static int compare(const void *a, const void *b)
{
    const tm_face_entry *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return (p->half > q->half) - (p->half < q->half);
}

/* Insertion sort is the fastest for the two dozen faces that a node has. */
static void sort(tm_face_entry *entry, size_t count)
{
    enum { FEW = 48 };
    if (count > FEW) {
        qsort(entry, count, sizeof *entry, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        tm_face_entry e = entry[i];
        size_t j = i;
        for (; j > 0 && entry[j - 1].key > e.key; j--)
            entry[j] = entry[j - 1];
        entry[j] = e;
    }
}

bool tm_face_order_next(tm_face_order *order, tm_status *status, tm_error *error)
{
    while (order->node < order->nodes &&
           order->start[order->node] == order->start[order->node + 1])
        order->node++;
    if (order->node == order->nodes)
        return false;
    size_t from = order->start[order->node], count = order->start[++order->node] - from;
    tm_face_entry *entry = tm_grow(order->entry, &order->room, count, sizeof *entry);
    if (!entry) {
        *status = tm_fail_memory(error);
        return false;
    }
    order->entry = entry;
    order->entries = count;
    for (size_t i = 0; i < count; i++) {
        uint32_t n[3];
        entry[i].half = order->half[from + i];
        face_nodes(order, entry[i].half, n);
        entry[i].key = (uint64_t)n[1] << 32 | n[2];
    }
    sort(entry, count);
    return true;
}
