/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_facets.h"

#include "../../element/shape.h"
#include "repair_trial.h"

#include <string.h>

enum { QUADRILATERAL = 4 };

/* Whether a face of an element is the polygon, from wherever, in the same sense. */
static bool is_face(const tm_mixed_mesh *mesh, size_t e, size_t k, const uint32_t *node,
                    bool reversed)
{
    const uint32_t *item = mesh->item + mesh->start[e];
    const tm_element_shape *shape =
        &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
    for (size_t f = 0; f < shape->faces; f++) {
        const uint8_t *corner = shape->face[f];
        if (tm_mixed_face_nodes(corner) != k)
            continue;
        for (size_t from = 0; from < k; from++) {
            size_t same = 0;
            while (same < k &&
                   item[corner[(from + (reversed ? k - same : same)) % k]] == node[same])
                same++;
            if (same == k)
                return true;
        }
    }
    return false;
}

/* The element with that face; TM_NONE: none. */
static uint32_t find(const tm_mixed_mesh *mesh, const tm_node_elements *around, size_t k,
                     const uint32_t *node, bool reversed)
{
    for (size_t a = around->start[node[0]]; a < around->start[node[0] + 1]; a++)
        if (is_face(mesh, around->element[a], k, node, reversed))
            return around->element[a];
    return TM_NONE;
}

/* Appends a row unless it is no face; says whether it is. */
static bool add(tm_block *to, const tm_mixed_mesh *mesh, const tm_node_elements *around,
                size_t k, const uint32_t *node, const tm_block *from, size_t row)
{
    const uint32_t inside = find(mesh, around, k, node, false);
    const uint32_t outside = find(mesh, around, k, node, true);
    if (inside == TM_NONE && outside == TM_NONE)
        return false;
    const size_t first = to->start[to->count];
    memcpy(to->item + first, node, k * sizeof *node);
    to->integer[2 * to->count] = inside;
    to->integer[2 * to->count + 1] = outside;
    if (from->markers)
        to->marker[to->count] = from->marker[row];
    to->start[++to->count] = first + k;
    return true;
}

/* The two triangles of a quadrilateral, by one diagonal or the other. */
static void add_nonconforming(tm_block *to, const tm_mixed_mesh *mesh,
                              const tm_node_elements *around, const uint32_t *n,
                              const tm_block *from, size_t row)
{
    for (size_t o = 0; o < 2; o++) {
        const uint32_t a = n[o], b = n[o + 1], c = n[o + 2],
                       d = n[(o + 3) % QUADRILATERAL];
        bool any = add(to, mesh, around, 3, (uint32_t[]){a, b, c}, from, row);
        any |= add(to, mesh, around, 3, (uint32_t[]){c, d, a}, from, row);
        if (any)
            return;
    }
}

tm_status tm_repair_move_facets(tm_block *facet, const tm_mixed_mesh *mesh,
                                tm_error *error)
{
    if (!facet)
        return TM_OK;
    tm_stream other;
    tm_stream_init(&other);
    tm_node_elements around = {0};
    tm_block *to = tm_stream_add(&other, facet->name);
    tm_status status = to ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK) {
        to->markers = facet->markers;
        status = tm_block_allocate(to, 2 * facet->count, 2 * facet->start[facet->count],
                                   error);
    }
    if (status == TM_OK)
        status = tm_node_elements_find(&around, mesh, error);
    if (status == TM_OK) {
        to->count = 0;
        for (size_t f = 0; f < facet->count; f++) {
            const uint32_t *node = facet->item + facet->start[f];
            const size_t k = facet->start[f + 1] - facet->start[f];
            if (k > 0 && !add(to, mesh, &around, k, node, facet, f) && k == QUADRILATERAL)
                add_nonconforming(to, mesh, &around, node, facet, f);
        }
        const tm_block old = *facet;
        *facet = *to;
        *to = old;
    }
    tm_node_elements_free(&around);
    tm_stream_free(&other);
    return status;
}
