/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contacts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const tm_contact *p = a, *q = b;
    if (p->node != q->node)
        return p->node < q->node ? -1 : 1;
    return (p->leaf > q->leaf) - (p->leaf < q->leaf);
}

/* Chunks are looked through first for whether they have any: few do. */
typedef struct {
    const tm_octree *octree;
    const bool *bad;
    size_t *count; /* [chunks] */
} counter;

static void count_chunk(void *context, size_t first, size_t past)
{
    const counter *c = context;
    size_t count = 0;
    for (size_t l = first; l < past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t node = c->octree->node[l][p];
            count += node != TM_NONE && c->bad[node];
        }
    c->count[first / TM_CHUNK] = count;
}

static void list_chunk(tm_contacts *list, const counter *c, size_t chunk)
{
    size_t past = (chunk + 1) * TM_CHUNK;
    past = past < c->octree->leaves ? past : c->octree->leaves;
    for (size_t l = chunk * TM_CHUNK; l < past; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t node = c->octree->node[l][p];
            if (node != TM_NONE && c->bad[node])
                list->contact[list->count++] = (tm_contact){node, (uint32_t)l};
        }
}

tm_status tm_contacts_find(tm_contacts *list, const tm_octree *octree, const bool *bad,
                           tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(octree->leaves, TM_CHUNK);
    counter c = {octree, bad, tm_new(chunks, sizeof *c.count)};
    size_t count = 0;
    list->count = 0;
    if (!c.count)
        return tm_fail_memory(error);
    tm_parallel_runs(octree->threads, octree->leaves, TM_CHUNK, count_chunk, &c);
    for (size_t i = 0; i < chunks; i++)
        count += c.count[i];
    void *room = tm_grow(list->contact, &list->room, count + 1, sizeof *list->contact);
    list->contact = room ? room : list->contact;
    for (size_t i = 0; room && i < chunks; i++)
        if (c.count[i] > 0)
            list_chunk(list, &c, i);
    free(c.count);
    if (list->count > 0)
        qsort(list->contact, list->count, sizeof *list->contact, compare);
    return room ? TM_OK : tm_fail_memory(error);
}

size_t tm_contacts_next(const tm_contacts *list, size_t i)
{
    const uint32_t node = list->contact[i].node;
    while (i < list->count && list->contact[i].node == node)
        i++;
    return i;
}
