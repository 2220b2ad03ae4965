/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements around some of the nodes, found by passes over all elements: where little
 * is bad, nothing is sorted but what is near it. */
#include "optimise_parts.h"

#include "../base/array.h"
#include "../stream/stream.h"

#include <stdlib.h>
#include <string.h>

enum { FAR = UINT8_MAX };

static void mark_seeds(uint8_t *ring, const tm_mixed_mesh *mesh, const uint32_t *seed,
                       size_t seeds, const tm_node_rule *rule)
{
    memset(ring, FAR, mesh->nodes);
    for (size_t s = 0; s < seeds; s++)
        for (size_t i = mesh->start[seed[s]]; i < mesh->start[seed[s] + 1]; i++)
            ring[mesh->item[i]] = 0;
    for (size_t v = 0; v < mesh->nodes; v++)
        if (rule[v].off_surface)
            ring[v] = 0;
}

/* Nodes that are one element further away than those of ring - 1. */
static void mark_ring(uint8_t *ring, const tm_mixed_mesh *mesh, uint8_t number)
{
    for (size_t e = 0; e < mesh->elements; e++) {
        const uint32_t *node = mesh->item + mesh->start[e];
        const size_t nodes = mesh->start[e + 1] - mesh->start[e];
        bool touches = false;
        for (size_t i = 0; i < nodes; i++)
            touches |= ring[node[i]] == number - 1;
        for (size_t i = 0; touches && i < nodes; i++)
            if (ring[node[i]] == FAR)
                ring[node[i]] = number;
    }
}

static tm_status number_rows(tm_vicinity *vicinity, const tm_mixed_mesh *mesh,
                             const uint8_t *ring, tm_error *error)
{
    vicinity->row = tm_new(mesh->nodes, sizeof *vicinity->row);
    if (!vicinity->row)
        return tm_fail_memory(error);
    for (size_t v = 0; v < mesh->nodes; v++)
        vicinity->row[v] = ring[v] == FAR ? TM_NONE : (uint32_t)vicinity->rows++;
    vicinity->start = calloc(vicinity->rows + 2, sizeof *vicinity->start);
    return vicinity->start ? TM_OK : tm_fail_memory(error);
}

/* Counting sort: start[] is one row ahead while rows are filled. */
static tm_status fill_rows(tm_vicinity *vicinity, const tm_mixed_mesh *mesh,
                           tm_error *error)
{
    size_t *next = vicinity->start + 1;
    for (size_t i = 0; i < mesh->start[mesh->elements]; i++) {
        const uint32_t row = vicinity->row[mesh->item[i]];
        if (row != TM_NONE)
            next[row + 1]++;
    }
    for (size_t r = 0; r < vicinity->rows; r++)
        next[r + 1] += next[r];
    vicinity->element = tm_new(next[vicinity->rows], sizeof *vicinity->element);
    if (!vicinity->element)
        return tm_fail_memory(error);
    for (size_t e = 0; e < mesh->elements; e++) {
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
            const uint32_t row = vicinity->row[mesh->item[i]];
            if (row != TM_NONE)
                vicinity->element[next[row]++] = (uint32_t)e;
        }
    }
    return TM_OK;
}

tm_status tm_vicinity_find(tm_vicinity *vicinity, const tm_mixed_mesh *mesh,
                           const uint32_t *seed, size_t seeds, const tm_node_rule *rule,
                           unsigned rings, tm_error *error)
{
    *vicinity = (tm_vicinity){0};
    uint8_t *ring = tm_new(mesh->nodes, sizeof *ring);
    if (!ring)
        return tm_fail_memory(error);
    mark_seeds(ring, mesh, seed, seeds, rule);
    for (unsigned r = 1; r <= rings; r++)
        mark_ring(ring, mesh, (uint8_t)r);
    tm_status status = number_rows(vicinity, mesh, ring, error);
    free(ring);
    return status == TM_OK ? fill_rows(vicinity, mesh, error) : status;
}

void tm_vicinity_free(tm_vicinity *vicinity)
{
    free(vicinity->row);
    free(vicinity->start);
    free(vicinity->element);
    *vicinity = (tm_vicinity){0};
}
