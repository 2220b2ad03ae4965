/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes with equal coordinates, by a hash table. */
#include "../base/array.h"
#include "examination.h"

#include <stdlib.h>
#include <string.h>

/* Open addressing with linear probing, at most half full. */
typedef struct node_table {
    const double (*xyz)[3];
    size_t mask;
    uint32_t *node; /* [mask + 1]; TM_NONE: empty */
} node_table;

static uint64_t hash(const double point[3])
{
    const uint64_t golden = 0x9E3779B97F4A7C15u; /* 2^64 / golden ratio */
    enum { HALF = 32 };
    uint64_t h = 0;
    for (size_t i = 0; i < 3; i++) {
        const double coordinate = point[i] + 0.0; /* -0 becomes 0 */
        uint64_t bits;
        memcpy(&bits, &coordinate, sizeof bits);
        h = (h ^ bits) * golden;
        h ^= h >> HALF;
    }
    return h;
}

static bool equal(const double p[3], const double q[3])
{
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* The slot of a node at the same place, or the empty one where v belongs. */
static size_t slot_of(const node_table *table, uint32_t v)
{
    size_t slot = (size_t)hash(table->xyz[v]) & table->mask;
    while (table->node[slot] != TM_NONE &&
           !equal(table->xyz[table->node[slot]], table->xyz[v]))
        slot = (slot + 1) & table->mask;
    return slot;
}

tm_status tm_examine_nodes(tm_examination *found, const double (*xyz)[3], size_t nodes,
                           tm_error *error)
{
    size_t room = 2;
    while (room < 2 * nodes)
        room *= 2;
    node_table table = {xyz, room - 1, tm_new(room, sizeof *table.node)};
    if (!table.node)
        return tm_fail_memory(error);
    memset(table.node, UINT8_MAX, room * sizeof *table.node);
    for (uint32_t v = 0; v < nodes; v++) {
        const size_t slot = slot_of(&table, v);
        if (table.node[slot] == TM_NONE)
            table.node[slot] = v;
        else
            tm_defect_add(&found->defect[TM_DUPLICATE_NODE],
                          (uint32_t[TM_DEFECT_NUMBERS]){v, table.node[slot]});
    }
    free(table.node);
    return TM_OK;
}
