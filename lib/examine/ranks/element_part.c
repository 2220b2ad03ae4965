/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Letters: of an element its number, sign and how many nodes, then these; of rows of
 * .face and .edge the number and nodes; of .facet the number, the sides, how many nodes
 * and these. They come from the ranks in order, and so in the order of their numbers. */
#include "parts.h"

#include "../../base/array.h"
#include "../../ranks/post.h"

#include <stdlib.h>
#include <string.h>

enum { ELEMENTS, FACES, EDGES, FACETS, SORTS };
enum { SIGN_BITS = 8, FACE_NODES = 3, EDGE_NODES = 2, FACET_HEAD = 4 };

static uint32_t least_of(const uint32_t *node, size_t count)
{
    uint32_t least = node[0];
    for (size_t i = 1; i < count; i++)
        least = node[i] < least ? node[i] : least;
    return least;
}

/* To who has a node that is the smallest of one of its faces or edges: any but the
 * largest. */
static void send_element(tm_post *post, const tm_rows *nodes, uint32_t number,
                         int8_t sign, const uint32_t *n, size_t k)
{
    uint32_t letter[2 + TM_ELEMENT_NODES] = {number,
                                             (uint32_t)k << SIGN_BITS | (uint8_t)sign};
    unsigned to[TM_ELEMENT_NODES];
    size_t count = 0, largest = 0;
    memcpy(letter + 2, n, k * sizeof *n);
    for (size_t i = 1; i < k; i++)
        largest = n[i] > n[largest] ? i : largest;
    for (size_t i = 0; i < k; i++) {
        size_t r = 0;
        to[count] = tm_rows_owner(nodes, n[i]);
        while (to[r] != to[count])
            r++;
        if (i != largest && r == count)
            tm_post_put(post, to[count++], letter, 2 + k);
    }
}

static void send_elements(tm_post *post, const tm_rows *nodes,
                          const tm_element_slices *mesh, const int8_t *sign)
{
    const tm_rows rows = tm_rows_of(mesh->elements);
    for (size_t e = 0; e < rows.count; e++) {
        size_t k;
        const uint32_t *n = tm_mesh_view_nodes(&mesh->own, e, &k);
        if (sign[e] != TM_NODE_TWICE)
            send_element(post, nodes, (uint32_t)(rows.first + e), sign[e], n, k);
    }
}

/* Rows of .face or .edge. */
static void send_rows(tm_post *post, const tm_rows *nodes, size_t total,
                      const uint32_t *item, size_t k)
{
    const tm_rows rows = tm_rows_of(total);
    for (size_t r = 0; r < rows.count; r++) {
        uint32_t letter[1 + FACE_NODES] = {(uint32_t)(rows.first + r)};
        memcpy(letter + 1, item + k * r, k * sizeof *item);
        tm_post_put(post, tm_rows_owner(nodes, least_of(item + k * r, k)), letter, 1 + k);
    }
}

static void send_facets(tm_post *post, const tm_rows *nodes,
                        const tm_element_slices *mesh)
{
    const tm_rows rows = tm_rows_of(mesh->facets);
    for (size_t f = 0; f < rows.count; f++) {
        const size_t start = mesh->own.facet_start[f];
        const size_t k = mesh->own.facet_start[f + 1] - start;
        const uint32_t *n = mesh->own.facet_node + start, *side = mesh->own.side[f];
        const uint32_t head[FACET_HEAD] = {(uint32_t)(rows.first + f), side[0], side[1],
                                           (uint32_t)k};
        const unsigned to = k > 0 ? tm_rows_owner(nodes, least_of(n, k)) : 0;
        tm_post_put(post, to, head, FACET_HEAD);
        tm_post_put(post, to, n, k);
    }
}

/* How long the head of a letter is, and how many nodes follow. */
static size_t head_of(int sort, const uint32_t *letter, size_t *k)
{
    switch (sort) {
    case ELEMENTS:
        *k = letter[1] >> SIGN_BITS;
        return 2;
    case FACETS:
        *k = letter[FACET_HEAD - 1];
        return FACET_HEAD;
    default:
        *k = sort == FACES ? FACE_NODES : EDGE_NODES;
        return 1;
    }
}

/* What has come of a sort. */
typedef struct letters {
    uint32_t *word;
    size_t words, count, nodes;
} letters;

static void count_letters(letters *l, int sort)
{
    for (size_t at = 0, k; at < l->words; l->count++) {
        at += head_of(sort, l->word + at, &k) + k;
        l->nodes += k;
    }
}

/* Takes letters apart: numbers to row[], nodes to node[]. */
static void take_letters(tm_element_part *part, const letters *l, int sort, bool mixed,
                         uint32_t *node)
{
    size_t *start = sort == ELEMENTS && mixed ? part->start[0]
                    : sort == FACETS          ? part->start[1]
                                              : NULL;
    size_t row = 0, nodes = 0;
    for (size_t at = 0, k; at < l->words; row++) {
        const uint32_t *letter = l->word + at;
        const size_t head = head_of(sort, letter, &k);
        part->row[sort][row] = letter[0];
        if (sort == ELEMENTS)
            part->sign[row] = (int8_t)(letter[1] & UINT8_MAX);
        if (sort == FACETS)
            memcpy(part->side[row], letter + 1, sizeof *part->side);
        memcpy(node + nodes, letter + head, k * sizeof *node);
        nodes += k;
        at += head + k;
        if (start)
            start[row + 1] = nodes;
    }
}

/* Which of the elements here the sides of facets are. */
static void find_sides(tm_element_part *part)
{
    const uint32_t *element = part->row[ELEMENTS];
    for (size_t f = 0; f < 2 * part->view.facets; f++) {
        uint32_t *side = &part->side[f / 2][f % 2];
        const size_t e = tm_first_not_below(element, part->view.elements, *side);
        if (*side != TM_NONE)
            *side = e < part->view.elements && element[e] == *side ? (uint32_t)e
                                                                   : TM_NONE - 1;
    }
}

static bool allocate(tm_element_part *part, const letters l[SORTS], bool mixed)
{
    size_t nodes = 0;
    bool enough = true;
    for (int s = 0; s < SORTS; s++) {
        nodes += l[s].nodes;
        part->row[s] = tm_new(l[s].count, sizeof *part->row[s]);
        enough = enough && part->row[s];
    }
    part->node = tm_new(nodes, sizeof *part->node);
    part->sign = tm_new(l[ELEMENTS].count, sizeof *part->sign);
    part->side = tm_new(l[FACETS].count, sizeof *part->side);
    part->start[0] = calloc(mixed ? l[ELEMENTS].count + 1 : 1, sizeof(size_t));
    part->start[1] = calloc(l[FACETS].count + 1, sizeof(size_t));
    return enough && part->node && part->sign && part->side && part->start[0] &&
           part->start[1];
}

static tm_status deliver(letters l[SORTS], const tm_rows *nodes,
                         const tm_element_slices *mesh, const int8_t *sign,
                         tm_error *error)
{
    tm_status status = TM_OK;
    for (int s = 0; s < SORTS && status == TM_OK; s++) {
        tm_post post = {0};
        if (s == ELEMENTS)
            send_elements(&post, nodes, mesh, sign);
        else if (s == FACES)
            send_rows(&post, nodes, mesh->faces, (const uint32_t *)mesh->own.face,
                      FACE_NODES);
        else if (s == EDGES)
            send_rows(&post, nodes, mesh->edges, (const uint32_t *)mesh->own.edge,
                      EDGE_NODES);
        else
            send_facets(&post, nodes, mesh);
        status = tm_post_deliver(&post, &l[s].word, &l[s].words, error);
        count_letters(&l[s], s);
    }
    return status;
}

/* Where the arrays of the view are. */
static void fill_view(tm_element_part *part, const letters l[SORTS], bool mixed)
{
    const uint32_t *face = part->node + l[ELEMENTS].nodes;
    const uint32_t *edge = face + l[FACES].nodes;
    part->view = (tm_mesh_view){.nodes = part->nodes.set.count,
                                .elements = l[ELEMENTS].count,
                                .start = mixed ? part->start[0] : NULL,
                                .item = part->node,
                                .faces = l[FACES].count,
                                .face = (const uint32_t(*)[3])face,
                                .edges = l[EDGES].count,
                                .edge = (const uint32_t(*)[2])edge,
                                .facets = l[FACETS].count,
                                .side = (const uint32_t(*)[2])part->side,
                                .facet_start = part->start[1],
                                .facet_node = edge + l[EDGES].nodes};
}

tm_status tm_element_part_make(tm_element_part *part, const tm_element_slices *mesh,
                               const int8_t *sign, tm_error *error)
{
    const tm_rows nodes = tm_rows_of(mesh->nodes);
    const bool mixed = mesh->own.start;
    letters l[SORTS] = {{0}};
    *part = (tm_element_part){0};
    tm_status status = deliver(l, &nodes, mesh, sign, error);
    if (status == TM_OK)
        status = tm_ranks_enough(allocate(part, l, mixed), error);
    size_t count = 0;
    for (int s = 0; s < SORTS; s++) {
        if (status == TM_OK)
            take_letters(part, &l[s], s, mixed, part->node + count);
        count += l[s].nodes;
        free(l[s].word);
    }
    if (status == TM_OK)
        status = tm_part_nodes_make(&part->nodes, part->node, count, NULL, NULL, error);
    if (status == TM_OK) {
        fill_view(part, l, mixed);
        find_sides(part);
    }
    return status;
}

void tm_element_part_free(tm_element_part *part)
{
    for (int s = 0; s < SORTS; s++)
        free(part->row[s]);
    free(part->node);
    free(part->sign);
    free(part->side);
    free(part->start[0]);
    free(part->start[1]);
    tm_part_nodes_free(&part->nodes);
}
