/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A triangle against a quadrilateral, by a hash table of the triangles of the boundary.
 */
#include "mixed_examine_faces.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

/* Open addressing with linear probing, at most half full. */
typedef struct triangle_table {
    const tm_mixed_boundary *boundary;
    size_t mask;
    uint32_t *face; /* [mask + 1]; TM_NONE: empty */
} triangle_table;

static void sort3(uint32_t n[3])
{
    static const size_t step[3] = {0, 1, 0};
    for (size_t i = 0; i < 3; i++) {
        uint32_t *p = n + step[i];
        if (p[0] > p[1]) {
            const uint32_t larger = p[0];
            p[0] = p[1];
            p[1] = larger;
        }
    }
}

static uint64_t hash(const uint32_t n[3])
{
    const uint64_t golden = 0x9E3779B97F4A7C15u; /* 2^64 / golden ratio */
    enum { HALF = 32 };
    uint64_t h = 0;
    for (size_t i = 0; i < 3; i++) {
        h = (h ^ n[i]) * golden;
        h ^= h >> HALF;
    }
    return h;
}

/* The slot of the triangle with these nodes, in ascending order, or the empty one where
 * it belongs. */
static size_t slot_of(const triangle_table *table, const uint32_t n[3])
{
    size_t slot = (size_t)hash(n) & table->mask;
    for (; table->face[slot] != TM_NONE; slot = (slot + 1) & table->mask) {
        uint32_t other[3];
        memcpy(other, table->boundary->node[table->face[slot]], sizeof other);
        sort3(other);
        if (memcmp(other, n, sizeof other) == 0)
            break;
    }
    return slot;
}

static void look_up(tm_examination *found, const triangle_table *table,
                    const uint32_t quadrilateral[4])
{
    for (size_t left_out = 0; left_out < 4; left_out++) {
        uint32_t n[3];
        for (size_t i = 0; i < 3; i++)
            n[i] = quadrilateral[i < left_out ? i : i + 1];
        sort3(n);
        if (table->face[slot_of(table, n)] != TM_NONE)
            tm_defect_add(
                &found->defect[TM_UNMATCHED_FACE],
                (uint32_t[TM_DEFECT_NUMBERS]){n[0], n[1], n[2], TM_FACE_HALVED});
    }
}

tm_status tm_mixed_examine_nonconforming(tm_examination *found,
                                         const tm_mixed_boundary *boundary,
                                         tm_error *error)
{
    size_t triangles = 0, room = 2;
    for (size_t f = 0; f < boundary->count; f++)
        triangles += boundary->node[f][3] == TM_NONE;
    if (triangles == 0 || triangles == boundary->count)
        return TM_OK;
    while (room < 2 * triangles)
        room *= 2;
    triangle_table table = {boundary, room - 1, tm_new(room, sizeof *table.face)};
    if (!table.face)
        return tm_fail_memory(error);
    memset(table.face, UINT8_MAX, room * sizeof *table.face);
    for (size_t f = 0; f < boundary->count; f++)
        if (boundary->node[f][3] == TM_NONE) {
            uint32_t n[3];
            memcpy(n, boundary->node[f], sizeof n);
            sort3(n);
            table.face[slot_of(&table, n)] = (uint32_t)f;
        }
    for (size_t f = 0; f < boundary->count; f++)
        if (boundary->node[f][3] != TM_NONE)
            look_up(found, &table, boundary->node[f]);
    free(table.face);
    return TM_OK;
}
