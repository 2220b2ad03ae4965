/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "element_edges.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "element_examine_faces.h"

#include <stdlib.h>

static uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

void tm_at_nodes_free(tm_at_nodes *list)
{
    free(list->start);
    free(list->item);
    *list = (tm_at_nodes){0};
}

/* The two largest nodes of a tetrahedron, in ascending order. */
static void top_edge(const uint32_t n[4], uint32_t top[2])
{
    const bool i = n[0] < n[1], j = n[2] < n[3];
    const uint32_t large = n[i], small = n[!i];
    const uint32_t other_large = n[2 + j], other_small = n[2 + !j];
    const bool first = large > other_large;
    const uint32_t rest = first ? small : other_small;
    const uint32_t loser = first ? other_large : large;
    top[1] = first ? large : other_large;
    top[0] = rest > loser ? rest : loser;
}

/* The far edges of a mixed element as bits. */
static uint16_t far_bits(const uint32_t *n, const tm_element_shape *shape)
{
    uint32_t least[TM_ELEMENT_FACES], far = 0;
    tm_mixed_least(shape, n, least);
    for (size_t i = 0; i < shape->edges; i++) {
        const uint32_t small = lesser(n[shape->edge[i][0]], n[shape->edge[i][1]]);
        const bool is_far = (small != least[shape->edge_face[i][0]]) &
                            (small != least[shape->edge_face[i][1]]);
        far |= (uint32_t)is_far << i;
    }
    return (uint16_t)far;
}

/* Each thread looks at all elements: more of them would only look. */
enum { MOST_PARTS = 8 };

typedef struct listing {
    const tm_mesh_view *mesh;
    const int8_t *sign;
    uint16_t *bits; /* [elements]: the far edges of mixed ones */
    size_t parts;   /* each lists at as many nodes */
    size_t *next;   /* see tm_list_far_edges() */
    uint32_t *item;
} listing;

static void find_bits(void *context, size_t first, size_t past)
{
    const listing *l = context;
    for (size_t e = first; e < past; e++) {
        size_t k;
        const uint32_t *n = tm_mesh_view_nodes(l->mesh, e, &k);
        l->bits[e] = l->sign[e] == TM_NODE_TWICE ? 0 : far_bits(n, &tm_element_shapes[k]);
    }
}

/* The far edges of element e, the smaller node first; how many. */
static size_t far_edges(const listing *l, size_t e, uint32_t far[TM_ELEMENT_EDGES][2])
{
    size_t k, count = 0;
    const uint32_t *n = tm_mesh_view_nodes(l->mesh, e, &k);
    if (!l->mesh->start) {
        top_edge(n, far[0]);
        return l->sign[e] != TM_NODE_TWICE;
    }
    const tm_element_shape *shape = &tm_element_shapes[k];
    for (uint32_t left = l->bits[e]; left != 0; left &= left - 1) {
        const uint8_t *edge = shape->edge[__builtin_ctz(left)];
        const uint32_t a = n[edge[0]], b = n[edge[1]];
        far[count][0] = lesser(a, b);
        far[count][1] = a ^ b ^ far[count][0];
        count++;
    }
    return count;
}

/* The nodes of part i: *first and how many more. */
static uint32_t nodes_of_part(const listing *l, size_t i, uint32_t *first)
{
    const size_t nodes = l->mesh->nodes;
    *first = (uint32_t)(nodes * i / l->parts);
    return (uint32_t)(nodes * (i + 1) / l->parts) - *first;
}

static void count_far(void *context, size_t i)
{
    const listing *l = context;
    uint32_t far[TM_ELEMENT_EDGES][2], first;
    const uint32_t span = nodes_of_part(l, i, &first);
    for (size_t e = 0; e < l->mesh->elements; e++)
        for (size_t f = 0, count = far_edges(l, e, far); f < count; f++)
            if (far[f][0] - first < span)
                l->next[far[f][0] + 1]++;
}

static void list_far(void *context, size_t i)
{
    const listing *l = context;
    uint32_t far[TM_ELEMENT_EDGES][2], first;
    const uint32_t span = nodes_of_part(l, i, &first);
    for (size_t e = 0; e < l->mesh->elements; e++)
        for (size_t f = 0, count = far_edges(l, e, far); f < count; f++)
            if (far[f][0] - first < span)
                l->item[l->next[far[f][0]]++] = far[f][1];
}

/* start[v + 2] counts, then start[v + 1] is where the next edge of v goes. */
bool tm_list_far_edges(tm_at_nodes *far_of, const tm_mesh_view *mesh, const int8_t *sign,
                       unsigned threads)
{
    listing l = {.mesh = mesh, .sign = sign};
    l.parts = tm_threads_for(threads, MOST_PARTS, mesh->elements);
    l.bits = tm_new(mesh->start ? mesh->elements : 0, sizeof *l.bits);
    far_of->start = calloc(mesh->nodes + 2, sizeof *far_of->start);
    bool enough = l.bits && far_of->start;
    if (enough) {
        l.next = far_of->start + 1;
        if (mesh->start)
            tm_parallel_runs(threads, mesh->elements, TM_CHUNK, find_bits, &l);
        tm_parallel(threads, l.parts, count_far, &l);
        for (size_t v = 0; v < mesh->nodes; v++)
            l.next[v + 1] += l.next[v];
        far_of->item = l.item = tm_new(l.next[mesh->nodes], sizeof *far_of->item);
        enough = l.item;
    }
    if (enough)
        tm_parallel(threads, l.parts, list_far, &l);
    free(l.bits);
    return enough;
}

bool tm_list_edge_rows(tm_at_nodes *listed, const tm_mesh_view *mesh)
{
    if (mesh->edges == 0)
        return true;
    listed->start = calloc(mesh->nodes + 2, sizeof *listed->start);
    listed->item = tm_new(mesh->edges, sizeof *listed->item);
    if (!listed->start || !listed->item)
        return false;
    size_t *next = listed->start + 1;
    for (size_t r = 0; r < mesh->edges; r++)
        next[lesser(mesh->edge[r][0], mesh->edge[r][1]) + 1]++;
    for (size_t v = 0; v < mesh->nodes; v++)
        next[v + 1] += next[v];
    for (size_t r = 0; r < mesh->edges; r++)
        listed->item[next[lesser(mesh->edge[r][0], mesh->edge[r][1])]++] = (uint32_t)r;
    return true;
}
