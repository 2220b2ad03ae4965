/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "element_edges.h"

#include "../base/array.h"
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

/* The far edges of element e, the smaller node first; how many. *bits are kept from the
 * first call to the next. */
static size_t far_edges(const tm_mesh_view *mesh, const int8_t *sign, size_t e,
                        uint16_t *bits, bool again, uint32_t far[TM_ELEMENT_EDGES][2])
{
    size_t k, count = 0;
    const uint32_t *n = tm_mesh_view_nodes(mesh, e, &k);
    if (sign[e] == TM_NODE_TWICE)
        return 0;
    if (k == TM_TET_NODES) {
        top_edge(n, far[0]);
        return 1;
    }
    const tm_element_shape *shape = &tm_element_shapes[k];
    if (!again)
        *bits = far_bits(n, shape);
    for (uint32_t left = *bits; left != 0; left &= left - 1) {
        const uint8_t *edge = shape->edge[__builtin_ctz(left)];
        const uint32_t a = n[edge[0]], b = n[edge[1]];
        far[count][0] = lesser(a, b);
        far[count][1] = a ^ b ^ far[count][0];
        count++;
    }
    return count;
}

/* start[v + 2] counts, then start[v + 1] is where the next edge of v goes. */
bool tm_list_far_edges(tm_at_nodes *far_of, const tm_mesh_view *mesh, const int8_t *sign)
{
    uint32_t far[TM_ELEMENT_EDGES][2];
    uint16_t *bits = tm_new(mesh->start ? mesh->elements : 1, sizeof *bits);
    size_t *next = calloc(mesh->nodes + 2, sizeof *next), all = 0;
    far_of->start = next++;
    for (size_t e = 0; bits && far_of->start && e < mesh->elements; e++) {
        const size_t count =
            far_edges(mesh, sign, e, &bits[mesh->start ? e : 0], false, far);
        for (size_t i = 0; i < count; i++)
            next[far[i][0] + 1]++;
        all += count;
    }
    far_of->item = tm_new(all, sizeof *far_of->item);
    const bool enough = bits && far_of->start && far_of->item;
    for (size_t v = 0; enough && v < mesh->nodes; v++)
        next[v + 1] += next[v];
    for (size_t e = 0; enough && e < mesh->elements; e++) {
        const size_t count =
            far_edges(mesh, sign, e, &bits[mesh->start ? e : 0], true, far);
        for (size_t i = 0; i < count; i++)
            far_of->item[next[far[i][0]]++] = far[i][1];
    }
    free(bits);
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
