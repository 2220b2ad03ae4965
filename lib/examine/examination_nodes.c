/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes with equal coordinates, by a hash table. */
#include "../base/hash.h"
#include "examination.h"

#include <string.h>

static uint64_t hash(const double point[3])
{
    uint64_t h = 0;
    for (size_t i = 0; i < 3; i++) {
        const double coordinate = point[i] + 0.0; /* -0 becomes 0 */
        uint64_t bits;
        memcpy(&bits, &coordinate, sizeof bits);
        h = tm_hash(h, bits);
    }
    return h;
}

static bool equal(const double p[3], const double q[3])
{
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

tm_status tm_examine_nodes(tm_examination *found, const double (*xyz)[3], size_t nodes,
                           tm_error *error)
{
    tm_hash_table table;
    if (!tm_hash_make(&table, nodes))
        return tm_fail_memory(error);
    for (uint32_t v = 0; v < nodes; v++) {
        uint32_t *slot = tm_hash_slot(&table, hash(xyz[v]));
        while (*slot != TM_HASH_FREE && !equal(xyz[*slot], xyz[v]))
            slot = tm_hash_next(&table, slot);
        if (*slot == TM_HASH_FREE)
            *slot = v;
        else
            tm_defect_add(&found->defect[TM_DUPLICATE_NODE],
                          (uint32_t[TM_DEFECT_NUMBERS]){v, *slot});
    }
    tm_hash_free(&table);
    return TM_OK;
}
