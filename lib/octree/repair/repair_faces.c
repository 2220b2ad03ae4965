/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_faces.h"

#include "../../base/array.h"
#include "../../mesh/mixed_face_order.h"

#include <stdlib.h>

static bool are_same(const tm_mixed_face *a, const tm_mixed_face *b)
{
    return a->key == b->key && a->shape == b->shape;
}

static int compare(const void *a, const void *b)
{
    const uint32_t *f = a, *g = b;
    return (*f > *g) - (*f < *g);
}

/* Appends those of the faces that begin at one node. */
static tm_status add(const tm_mixed_face_order *order, uint32_t **face, size_t *faces,
                     size_t *room, tm_error *error)
{
    for (size_t i = 0, next; i < order->entries; i = next) {
        for (next = i + 1;
             next < order->entries && are_same(&order->entry[i], &order->entry[next]);)
            next++;
        if (next > i + 1)
            continue;
        uint32_t *grown = tm_grow(*face, room, *faces + 1, sizeof *grown);
        if (!grown)
            return tm_fail_memory(error);
        *face = grown;
        grown[(*faces)++] = order->entry[i].half;
    }
    return TM_OK;
}

tm_status tm_mixed_boundary_faces(const tm_mixed_mesh *mesh, uint32_t **face,
                                  size_t *faces, tm_error *error)
{
    *face = NULL;
    *faces = 0;
    if (mesh->elements >= (size_t)1 << (31 - TM_FACE_SHIFT))
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "%zu elements have more faces than 32 bits can number",
                       mesh->elements);
    const tm_mixed_arrays arrays = {.nodes = mesh->nodes,
                                    .xyz = (const double(*)[3])mesh->xyz,
                                    .elements = mesh->elements,
                                    .start = mesh->start,
                                    .item = mesh->item};
    int8_t *sign = calloc(mesh->elements + 1, 1);
    if (!sign)
        return tm_fail_memory(error);
    tm_mixed_face_order order;
    size_t room = 0;
    tm_status status = tm_mixed_face_order_init(&order, &arrays, sign, error);
    while (status == TM_OK && tm_mixed_face_order_next(&order, &status, error))
        status = add(&order, face, faces, &room, error);
    tm_mixed_face_order_free(&order);
    free(sign);
    if (status == TM_OK && *faces > 0)
        qsort(*face, *faces, sizeof **face, compare);
    return status;
}
