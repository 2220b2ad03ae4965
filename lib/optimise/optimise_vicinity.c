/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The elements around some of the nodes, found by passes over all elements: where little
 * is bad, nothing is sorted but what is near it. */
#include "optimise_parts.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../mesh/node_rows.h"
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

/* Threads mark rings at the same time: a node that one of them marks is not of the ring
 * that others look for. */
typedef struct {
    const tm_mixed_mesh *mesh;
    uint8_t *ring; /* [nodes] */
    uint8_t number;
} marking;

static uint8_t ring_of(const marking *m, uint32_t v)
{
    return __atomic_load_n(&m->ring[v], __ATOMIC_RELAXED);
}

static void mark_chunk(void *context, size_t first, size_t past)
{
    const marking *m = context;
    for (size_t e = first; e < past; e++) {
        const uint32_t *node = m->mesh->item + m->mesh->start[e];
        const size_t nodes = m->mesh->start[e + 1] - m->mesh->start[e];
        bool touches = false;
        for (size_t i = 0; i < nodes; i++)
            touches |= ring_of(m, node[i]) == m->number - 1;
        for (size_t i = 0; touches && i < nodes; i++)
            if (ring_of(m, node[i]) == FAR)
                __atomic_store_n(&m->ring[node[i]], m->number, __ATOMIC_RELAXED);
    }
}

/* Nodes that are one element further away than those of ring - 1. */
static void mark_ring(uint8_t *ring, const tm_mixed_mesh *mesh, uint8_t number)
{
    marking m = {mesh, ring, number};
    tm_parallel_runs(mesh->threads, mesh->elements, TM_CHUNK, mark_chunk, &m);
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

typedef struct {
    const tm_vicinity *vicinity;
    const tm_mixed_mesh *mesh;
    size_t *next;
} filling;

static void count_element(void *context, size_t e, tm_row_range range)
{
    const filling *f = context;
    for (size_t i = f->mesh->start[e]; i < f->mesh->start[e + 1]; i++) {
        const uint32_t row = f->vicinity->row[f->mesh->item[i]];
        if (tm_row_is_in(range, row))
            f->next[row + 1]++;
    }
}

static void enter_element(void *context, size_t e, tm_row_range range)
{
    const filling *f = context;
    for (size_t i = f->mesh->start[e]; i < f->mesh->start[e + 1]; i++) {
        const uint32_t row = f->vicinity->row[f->mesh->item[i]];
        if (tm_row_is_in(range, row))
            f->vicinity->element[f->next[row]++] = (uint32_t)e;
    }
}

/* Counting sort: start[] is one row ahead while rows are filled. */
static tm_status fill_rows(tm_vicinity *vicinity, const tm_mixed_mesh *mesh,
                           tm_error *error)
{
    size_t *next = vicinity->start + 1;
    filling f = {vicinity, mesh, next};
    tm_node_rows rows;
    tm_status status =
        tm_node_rows_find(&rows, mesh, vicinity->row, vicinity->rows, error);
    if (status == TM_OK)
        tm_node_rows_visit(&rows, count_element, &f);
    for (size_t r = 0; status == TM_OK && r < vicinity->rows; r++)
        next[r + 1] += next[r];
    vicinity->element = tm_new(next[vicinity->rows], sizeof *vicinity->element);
    if (status == TM_OK && !vicinity->element)
        status = tm_fail_memory(error);
    if (status == TM_OK)
        tm_node_rows_visit(&rows, enter_element, &f);
    tm_node_rows_free(&rows);
    return status;
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
