/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A triangle against a quadrilateral, by a hash table of the triangles of the boundary.
 */
#include "element_examine_faces.h"

#include "../base/hash.h"

#include <string.h>

typedef struct triangles {
    const tm_boundary_faces *boundary;
    uint32_t first, past; /* nodes, one of which is the smallest one of what counts */
    tm_hash_table table;  /* of the boundary's triangles */
} triangles;

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

/* The slot of the triangle with these nodes, in ascending order, or the free one where it
 * belongs. */
static uint32_t *slot_of(const triangles *all, const uint32_t n[3])
{
    uint64_t h = 0;
    for (size_t i = 0; i < 3; i++)
        h = tm_hash(h, n[i]);
    uint32_t *slot = tm_hash_slot(&all->table, h);
    for (; *slot != TM_HASH_FREE; slot = tm_hash_next(&all->table, slot)) {
        uint32_t other[3];
        memcpy(other, all->boundary->node[*slot], sizeof other);
        sort3(other);
        if (memcmp(other, n, sizeof other) == 0)
            break;
    }
    return slot;
}

static void look_up(tm_examination *found, const triangles *all,
                    const uint32_t quadrilateral[4])
{
    for (size_t left_out = 0; left_out < 4; left_out++) {
        uint32_t n[3];
        for (size_t i = 0; i < 3; i++)
            n[i] = quadrilateral[i < left_out ? i : i + 1];
        sort3(n);
        if (n[0] >= all->first && n[0] < all->past && *slot_of(all, n) != TM_HASH_FREE)
            tm_defect_add(
                &found->defect[TM_UNMATCHED_FACE],
                (uint32_t[TM_DEFECT_NUMBERS]){n[0], n[1], n[2], TM_FACE_HALVED});
    }
}

tm_status tm_element_examine_nonconforming(tm_examination *found,
                                           const tm_boundary_faces *boundary,
                                           uint32_t first, uint32_t past, tm_error *error)
{
    size_t count = 0;
    for (size_t f = 0; f < boundary->count; f++)
        count += boundary->node[f][3] == TM_NONE;
    if (count == 0 || count == boundary->count)
        return TM_OK;
    triangles all = {.boundary = boundary, .first = first, .past = past};
    if (!tm_hash_make(&all.table, count))
        return tm_fail_memory(error);
    for (size_t f = 0; f < boundary->count; f++)
        if (boundary->node[f][3] == TM_NONE) {
            uint32_t n[3];
            memcpy(n, boundary->node[f], sizeof n);
            sort3(n);
            *slot_of(&all, n) = (uint32_t)f;
        }
    for (size_t f = 0; f < boundary->count; f++)
        if (boundary->node[f][3] != TM_NONE)
            look_up(found, &all, boundary->node[f]);
    tm_hash_free(&all.table);
    return TM_OK;
}
