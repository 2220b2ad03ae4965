/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "evaluate.h"

#include "../base/array.h"
#include "../surface/point_table.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 4 };

typedef struct evaluation {
    const tm_tet_mesh *from;
    tm_block *node;
    const tm_block *ele;
    const bool *known;
    uint32_t *twin;  /* [node]: the node of `from` in its place, or TM_NONE */
    uint32_t *at;    /* [node]: a tetrahedron of `from` where it is; TM_NONE: not yet */
    uint32_t *tet;   /* [from->nodes]: a tetrahedron that has it */
    size_t *start;   /* [node + 1]: its tetrahedra are item[start[v] … */
    uint32_t *item;  /* of ele */
    uint32_t *queue; /* [node] */
    uint32_t *met;   /* [from->slots]: by which search */
    uint32_t *stack; /* [from->slots] */
    uint32_t search;
} evaluation;

/* Where nodes are the same -------------------------------------------------------------
 */

static bool find_twins(evaluation *e)
{
    const tm_tet_mesh *from = e->from;
    tm_point_table table = {0};
    const bool ok = tm_point_table_fill(&table, from->xyz, from->nodes);
    for (size_t v = 0; v < e->node->count && ok; v++)
        e->twin[v] = tm_point_table_find(&table, from->xyz, e->node->real + 3 * v);
    tm_point_table_free(&table);
    return ok;
}

/* The tetrahedra at each node of the new mesh. */
static void list_tets(evaluation *e)
{
    const uint32_t *corner = e->ele->integer;
    const size_t nodes = e->node->count, corners = CORNERS * e->ele->count;
    memset(e->start, 0, (nodes + 1) * sizeof *e->start);
    for (size_t i = 0; i < corners; i++)
        e->start[corner[i]]++;
    for (size_t v = 0, sum = 0; v <= nodes; v++)
        e->start[v] = sum += v < nodes ? e->start[v] : 0;
    for (size_t i = corners; i-- > 0;)
        e->item[--e->start[corner[i]]] = (uint32_t)(i / CORNERS);
}

/* In which tetrahedron -----------------------------------------------------------------
 */

/* Pushes what is across the faces of t that were not met, that which the point is the
 * farthest beyond last. Returns the new height. */
static size_t push_across(evaluation *e, uint32_t t, const double b[CORNERS],
                          size_t height)
{
    int order[CORNERS] = {0, 1, 2, 3};
    for (int i = 1; i < CORNERS; i++)
        for (int k = i; k > 0 && b[order[k]] > b[order[k - 1]]; k--) {
            const int other = order[k];
            order[k] = order[k - 1];
            order[k - 1] = other;
        }
    for (uint32_t i = 0; i < CORNERS; i++) {
        const uint32_t half = tm_tet_across(e->from, t, (uint32_t)order[i]);
        if (half == TM_NONE || e->met[half / CORNERS] == e->search)
            continue;
        e->met[half / CORNERS] = e->search;
        e->stack[height++] = half / CORNERS;
    }
    return height;
}

/* From one tetrahedron on; where none has the point, that which has it most nearly. */
static uint32_t find_tet(evaluation *e, const double p[3], uint32_t t)
{
    static const double rounding = -1e-12;
    uint32_t best = t;
    double most = -HUGE_VAL, b[CORNERS];
    size_t height = 0;
    e->search++;
    e->met[t] = e->search;
    e->stack[height++] = t;
    while (height > 0 && most < rounding) {
        t = e->stack[--height];
        const double depth = tm_tet_coordinates(e->from, t, p, b);
        if (depth > most) {
            most = depth;
            best = t;
        }
        height = push_across(e, t, b, height);
    }
    return best;
}

/* The values there ---------------------------------------------------------------------
 */

/* The tetrahedron of node v, where the search begins at that of a neighbour. */
static void place(evaluation *e, size_t v, uint32_t begin)
{
    if (e->twin[v] != TM_NONE && e->tet[e->twin[v]] != TM_NONE) {
        e->at[v] = e->tet[e->twin[v]];
        return;
    }
    e->at[v] = find_tet(e, e->node->real + 3 * v, begin);
    if (e->twin[v] == TM_NONE && !(e->known && e->known[v]))
        tm_tet_interpolate(e->from, &e->at[v], 1, e->node->real + 3 * v,
                           e->node->attribute + e->node->attributes * v);
}

/* All nodes that are joined to v over edges. */
static void spread(evaluation *e, uint32_t v)
{
    size_t head = 0, tail = 0;
    e->queue[tail++] = v;
    while (head < tail) {
        v = e->queue[head++];
        for (size_t i = e->start[v]; i < e->start[v + 1]; i++)
            for (int c = 0; c < CORNERS; c++) {
                const uint32_t w = e->ele->integer[CORNERS * e->item[i] + (size_t)c];
                if (e->at[w] != TM_NONE)
                    continue;
                place(e, w, e->at[v]);
                e->queue[tail++] = w;
            }
    }
}

static void evaluate_all(evaluation *e)
{
    const tm_tet_mesh *from = e->from;
    memset(e->tet, UINT8_MAX, from->nodes * sizeof *e->tet);
    memset(e->at, UINT8_MAX, e->node->count * sizeof *e->at);
    for (uint32_t t = 0; t < from->slots; t++)
        for (int i = 0; i < CORNERS; i++)
            e->tet[from->tet[t][i]] = t;
    /* First from nodes that are in both, then whatever is joined to none of them. */
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t v = 0; v < e->node->count; v++) {
            if (e->at[v] != TM_NONE || e->start[v] == e->start[v + 1] ||
                (pass == 0 && (e->twin[v] == TM_NONE || e->tet[e->twin[v]] == TM_NONE)))
                continue;
            place(e, v, 0);
            spread(e, v);
        }
}

tm_status tm_tet_evaluate(const tm_tet_mesh *from, tm_block *node, const tm_block *ele,
                          const bool *known, tm_error *error)
{
    if (from->tets == 0 || from->node_attributes == 0)
        return TM_OK;
    evaluation e = {.from = from, .node = node, .ele = ele, .known = known};
    e.twin = tm_new(node->count, sizeof *e.twin);
    e.at = tm_new(node->count, sizeof *e.at);
    e.tet = tm_new(from->nodes, sizeof *e.tet);
    e.start = tm_new(node->count + 1, sizeof *e.start);
    e.item = tm_new(CORNERS * ele->count, sizeof *e.item);
    e.queue = tm_new(node->count, sizeof *e.queue);
    e.met = calloc(from->slots + 1, sizeof *e.met);
    e.stack = tm_new(from->slots, sizeof *e.stack);
    const bool ok = e.twin && e.at && e.tet && e.start && e.item && e.queue && e.met &&
                    e.stack && find_twins(&e);
    if (ok) {
        list_tets(&e);
        evaluate_all(&e);
    }
    free(e.twin);
    free(e.at);
    free(e.tet);
    free(e.start);
    free(e.item);
    free(e.queue);
    free(e.met);
    free(e.stack);
    return ok ? TM_OK : tm_fail_memory(error);
}
