/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_face_order.h"

#include "../base/array.h"
#include "../element/shape.h"

#include <stdlib.h>
#include <string.h>

enum { HALVES = 8, TRIANGLE = 3, QUADRILATERAL = 4 };

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint32_t greater(uint32_t a, uint32_t b)
{
    return a < b ? b : a;
}

static uint32_t smallest(const uint32_t *node, size_t count)
{
    uint32_t least = node[0];
    for (size_t i = 1; i < count; i++)
        least = lesser(least, node[i]);
    return least;
}

bool tm_mixed_row_is_face(const uint32_t *n, size_t count)
{
    if (count != TRIANGLE && count != QUADRILATERAL)
        return false;
    for (size_t i = 1; i < count; i++)
        for (size_t j = 0; j < i; j++)
            if (n[i] == n[j])
                return false;
    return true;
}

size_t tm_mixed_face_of(const tm_mixed_arrays *mesh, uint32_t half, uint32_t node[4])
{
    const size_t e = half / HALVES, begin = mesh->start[e];
    const uint8_t *face =
        tm_element_shapes[mesh->start[e + 1] - begin].face[half % HALVES];
    for (size_t i = 0; i < QUADRILATERAL; i++)
        node[i] = mesh->item[begin + face[i]];
    return tm_mixed_face_nodes(face);
}

/* The nodes of a row, counted through .face and .facet; how many. */
static size_t row_of(const tm_mixed_arrays *mesh, size_t row, const uint32_t **node)
{
    if (row < mesh->faces) {
        *node = mesh->face[row];
        return TRIANGLE;
    }
    const size_t f = row - mesh->faces;
    *node = mesh->facet_node + mesh->facet_start[f];
    return mesh->facet_start[f + 1] - mesh->facet_start[f];
}

/* start[v + 2] counts; the number of all. */
static size_t count_faces(tm_mixed_face_order *order, const int8_t *sign)
{
    const tm_mixed_arrays *mesh = order->mesh;
    size_t *count = order->start + 2, all = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        if (sign[e] == TM_MIXED_NODE_TWICE)
            continue;
        const tm_element_shape *shape =
            &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
        uint32_t least[TM_ELEMENT_FACES];
        tm_mixed_least(shape, mesh->item + mesh->start[e], least);
        for (size_t i = 0; i < shape->faces; i++)
            count[least[i]]++;
        all += shape->faces;
    }
    for (size_t row = 0; row < mesh->faces + mesh->facets; row++) {
        const uint32_t *n;
        const size_t k = row_of(mesh, row, &n);
        if (tm_mixed_row_is_face(n, k)) {
            count[smallest(n, k)]++;
            all++;
        }
    }
    return all;
}

/* start[v + 1] is where the next face of v goes. */
static void fill(tm_mixed_face_order *order, const int8_t *sign)
{
    const tm_mixed_arrays *mesh = order->mesh;
    size_t *next = order->start + 1;
    for (size_t e = 0; e < mesh->elements; e++) {
        if (sign[e] == TM_MIXED_NODE_TWICE)
            continue;
        const tm_element_shape *shape =
            &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
        uint32_t least[TM_ELEMENT_FACES];
        tm_mixed_least(shape, mesh->item + mesh->start[e], least);
        for (size_t i = 0; i < shape->faces; i++)
            order->half[next[least[i]]++] = (uint32_t)(HALVES * e + i);
    }
    for (size_t row = 0; row < mesh->faces + mesh->facets; row++) {
        const uint32_t *n;
        const size_t k = row_of(mesh, row, &n);
        if (tm_mixed_row_is_face(n, k))
            order->half[next[smallest(n, k)]++] = (uint32_t)row | TM_MIXED_ROW;
    }
}

tm_status tm_mixed_face_order_init(tm_mixed_face_order *order,
                                   const tm_mixed_arrays *mesh, const int8_t *sign,
                                   tm_error *error)
{
    *order = (tm_mixed_face_order){.mesh = mesh};
    order->start = calloc(mesh->nodes + 2, sizeof *order->start);
    if (!order->start)
        return tm_fail_memory(error);
    order->half = tm_new(count_faces(order, sign), sizeof *order->half);
    if (!order->half) {
        tm_mixed_face_order_free(order);
        return tm_fail_memory(error);
    }
    for (size_t v = 0; v < mesh->nodes; v++)
        order->start[v + 2] += order->start[v + 1];
    fill(order, sign);
    return TM_OK;
}

void tm_mixed_face_order_free(tm_mixed_face_order *order)
{
    free(order->start);
    free(order->half);
    free(order->entry);
    *order = (tm_mixed_face_order){0};
}

static bool comes_before(const tm_mixed_face *a, const tm_mixed_face *b)
{
    if (a->key != b->key)
        return a->key < b->key;
    return a->shape != b->shape ? a->shape < b->shape : a->half < b->half;
}

static int compare(const void *a, const void *b)
{
    return comes_before(a, b) ? -1 : comes_before(b, a);
}

/* Insertion sort is the fastest for the few faces that a node has. */
static void sort(tm_mixed_face *entry, size_t count)
{
    enum { FEW = 48 };
    if (count > FEW) {
        qsort(entry, count, sizeof *entry, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const tm_mixed_face e = entry[i];
        size_t j = i;
        for (; j > 0 && comes_before(&e, &entry[j - 1]); j--)
            entry[j] = entry[j - 1];
        entry[j] = e;
    }
}

/* The face of nodes n that has half's name and the smallest node v. */
static tm_mixed_face face_of(const uint32_t *n, size_t k, uint32_t v, uint32_t half)
{
    const size_t i = n[0] == v ? 0 : n[1] == v ? 1 : n[2] == v ? 2 : 3;
    const uint32_t next = n[i + 1 < k ? i + 1 : 0], before = n[i > 0 ? i - 1 : k - 1];
    const uint32_t p = lesser(next, before), q = greater(next, before);
    tm_mixed_face face = {.half = half, .turned = next != p};
    if (k == TRIANGLE) {
        face.key = (uint64_t)p << 32 | q;
        face.shape = (uint64_t)TM_NONE << 2;
        return face;
    }
    const uint32_t o = n[(i + 2) % QUADRILATERAL];
    const uint32_t second = lesser(o, p), third = lesser(greater(o, p), q);
    face.key = (uint64_t)second << 32 | third;
    face.shape = (uint64_t)greater(o, q) << 2 | (o < p ? 1 : o < q ? 2 : 3);
    return face;
}

bool tm_mixed_face_order_next(tm_mixed_face_order *order, tm_status *status,
                              tm_error *error)
{
    const tm_mixed_arrays *mesh = order->mesh;
    while (order->node < mesh->nodes &&
           order->start[order->node] == order->start[order->node + 1])
        order->node++;
    if (order->node == mesh->nodes)
        return false;
    const uint32_t v = (uint32_t)order->node;
    const size_t from = order->start[v], count = order->start[v + 1] - from;
    tm_mixed_face *entry = tm_grow(order->entry, &order->room, count, sizeof *entry);
    if (!entry) {
        *status = tm_fail_memory(error);
        return false;
    }
    order->node++;
    order->entry = entry;
    order->entries = count;
    for (size_t i = 0; i < count; i++) {
        const uint32_t half = order->half[from + i], *n;
        uint32_t corner[QUADRILATERAL];
        size_t k;
        if (half & TM_MIXED_ROW) {
            k = row_of(mesh, half & ~TM_MIXED_ROW, &n);
        } else {
            k = tm_mixed_face_of(mesh, half, corner);
            n = corner;
        }
        entry[i] = face_of(n, k, v, half);
    }
    sort(entry, count);
    return true;
}
