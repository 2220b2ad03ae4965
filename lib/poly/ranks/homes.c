/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../ranks/post.h"
#include "../../tet/connect.h"

#include <stdlib.h>
#include <string.h>

enum { FACE_WORDS = 5, TET_NODE = 1, FACE_NODE = 1 };

/* Who knows it: the homes of its nodes, each once. */
static void send_home(tm_post *post, const unsigned *home, size_t nodes,
                      const uint32_t *item, size_t words)
{
    for (size_t i = 0; i < nodes; i++) {
        size_t first = 0;
        while (home[first] != home[i])
            first++;
        if (first == i)
            tm_post_put(post, home[i], item, words);
    }
}

static tm_status send_tets(const tm_sorted_tets *s, tm_at_home *tet, tm_error *error)
{
    tm_post post = {0};
    uint32_t *item = malloc((1 + s->words) * sizeof *item);
    post.failed = !item;
    for (size_t t = 0; item && t < s->rows.count; t++) {
        const uint32_t *record = s->record + t * s->words;
        unsigned home[4];
        item[0] = (uint32_t)(s->rows.first + t);
        memcpy(item + 1, record, s->words * sizeof *item);
        for (size_t i = 0; i < 4; i++)
            home[i] = s->home[tm_number_set_below(&s->nodes.set, record[i])];
        send_home(&post, home, 4, item, 1 + s->words);
    }
    free(item);
    tet->words = 1 + s->words;
    const tm_status status = tm_post_deliver(&post, &tet->item, &tet->items, error);
    tet->items /= tet->words;
    return status;
}

static bool names_node_twice(const uint32_t n[3])
{
    return n[0] == n[1] || n[1] == n[2] || n[2] == n[0];
}

static tm_status send_faces(const tm_sorted_tets *s, const tm_tet_slices *slices,
                            tm_at_home *face, bool *odd, tm_error *error)
{
    const tm_block *block = slices->face;
    const tm_rows rows = tm_rows_of(slices->faces);
    uint32_t *list = tm_new(rows.count, 3 * sizeof *list);
    tm_part_nodes nodes = {0};
    tm_post post = {0};
    tm_status status = tm_ranks_enough(list, error);
    if (status == TM_OK && list && rows.count > 0)
        memcpy(list, block->integer, 3 * rows.count * sizeof *list);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, list, 3 * rows.count, &slices->nodes,
                                    (const double(*)[3])slices->node->real, error);
    for (size_t f = 0; status == TM_OK && f < rows.count; f++) {
        const uint32_t *n = block->integer + 3 * f;
        const uint32_t item[FACE_WORDS] = {(uint32_t)(rows.first + f), n[0], n[1], n[2],
                                           block->marker ? (uint32_t)block->marker[f]
                                                         : 0};
        unsigned home[3];
        for (size_t i = 0; i < 3; i++)
            home[i] = tm_sorted_home(s, nodes.xyz[list[3 * f + i]]);
        *odd |= names_node_twice(n);
        send_home(&post, home, 3, item, FACE_WORDS);
    }
    tm_part_nodes_free(&nodes);
    free(list);
    face->words = FACE_WORDS;
    if (status == TM_OK)
        status = tm_post_deliver(&post, &face->item, &face->items, error);
    face->items /= FACE_WORDS;
    return status;
}

/* Lists at each node what is at it: `count` nodes of an item, behind its number. */
static bool list_at_nodes(tm_at_home *at, const tm_number_set *node, size_t count)
{
    at->start = calloc(node->count + 2, sizeof *at->start);
    at->list = tm_new(at->items, count * sizeof *at->list);
    if (!at->start || !at->list)
        return false;
    uint32_t *next = at->start + 1;
    for (size_t i = 0; i < at->items; i++)
        for (size_t k = 1; k <= count; k++)
            next[tm_number_set_below(node, at->item[i * at->words + k]) + 1]++;
    for (size_t v = 0; v < node->count; v++)
        next[v + 1] += next[v];
    for (size_t i = 0; i < at->items; i++)
        for (size_t k = 1; k <= count; k++)
            at->list[next[tm_number_set_below(node, at->item[i * at->words + k])]++] =
                (uint32_t)i;
    return true;
}

/* All nodes of what is here. */
static bool list_nodes(tm_homes *h)
{
    const size_t count = 4 * h->tet.items + 3 * h->face.items;
    uint32_t *list = tm_new(count, sizeof *list), *to = list;
    for (size_t i = 0; list && i < h->tet.items; i++, to += 4)
        memcpy(to, h->tet.item + i * h->tet.words + 1, 4 * sizeof *to);
    for (size_t i = 0; list && i < h->face.items; i++, to += 3)
        memcpy(to, h->face.item + i * h->face.words + 1, 3 * sizeof *to);
    const bool enough = list && tm_number_set_of(&h->node, list, count, TM_NONE);
    free(list);
    return enough;
}

tm_status tm_homes_make(tm_homes *homes, const tm_sorted_tets *sorted,
                        const tm_tet_slices *slices, bool *odd, tm_error *error)
{
    *homes = (tm_homes){0};
    tm_status status = send_tets(sorted, &homes->tet, error);
    if (status == TM_OK)
        status = send_faces(sorted, slices, &homes->face, odd, error);
    if (status == TM_OK)
        status = tm_ranks_enough(list_nodes(homes) &&
                                     list_at_nodes(&homes->tet, &homes->node, 4) &&
                                     list_at_nodes(&homes->face, &homes->node, 3),
                                 error);
    *odd = tm_ranks_any(*odd);
    return status;
}

void tm_homes_free(tm_homes *homes)
{
    tm_number_set_free(&homes->node);
    free(homes->tet.item);
    free(homes->tet.start);
    free(homes->tet.list);
    free(homes->face.item);
    free(homes->face.start);
    free(homes->face.list);
}

/* Shares --------------------------------------------------------------------------- */

/* The places of letters, of a rank and a node, rank by rank. */
static uint32_t *by_rank(const uint32_t *asked, size_t count)
{
    size_t *next = calloc(tm_ranks_count() + 1, sizeof *next);
    uint32_t *order = next ? tm_new(count, sizeof *order) : NULL;
    for (size_t a = 0; order && a < count; a++)
        next[asked[2 * a] + 1]++;
    for (unsigned r = 0; order && r < tm_ranks_count(); r++)
        next[r + 1] += next[r];
    for (size_t a = 0; order && a < count; a++)
        order[next[asked[2 * a]]++] = (uint32_t)a;
    free(next);
    return order;
}

/* Answers who asks for what is at nodes, letters of rank and node, each item once. */
static tm_status answer(const tm_homes *h, const tm_at_home *at, const uint32_t *asked,
                        size_t count, uint32_t **got, size_t *items, tm_error *error)
{
    tm_post post = {0};
    uint32_t *last = tm_new(at->items, sizeof *last), *order = by_rank(asked, count);
    post.failed = !last || !order;
    for (size_t i = 0; last && i < at->items; i++)
        last[i] = TM_NONE;
    for (size_t a = 0; !post.failed && a < count; a++) {
        const uint32_t rank = asked[2 * order[a]], node = asked[2 * order[a] + 1];
        const uint32_t v = tm_number_set_below(&h->node, node);
        if (!tm_number_set_has(&h->node, node))
            continue;
        for (size_t k = at->start[v]; k < at->start[v + 1]; k++) {
            const uint32_t item = at->list[k];
            if (last[item] != rank)
                tm_post_put(&post, rank, at->item + item * at->words, at->words);
            last[item] = rank;
        }
    }
    free(last);
    free(order);
    const tm_status status = tm_post_deliver(&post, got, items, error);
    *items /= at->words;
    return status;
}

void tm_poly_tets_ask(tm_post *asking, const tm_sorted_tets *sorted, size_t node,
                      unsigned rank)
{
    tm_post_put(asking, sorted->home[node],
                (const uint32_t[]){rank, sorted->nodes.number[node]}, 2);
}

/* Puts items that came, some of them several times, in the order of their numbers. */
static bool put_in_order(uint32_t **item, size_t items, size_t words, tm_number_set *set)
{
    uint32_t *number = tm_new(items, sizeof *number), *made = NULL;
    for (size_t i = 0; number && i < items; i++)
        number[i] = (*item)[i * words];
    if (number && tm_number_set_of(set, number, items, TM_NONE))
        made = tm_new(set->count, words * sizeof *made);
    for (size_t i = 0; made && i < items; i++)
        memcpy(made + tm_number_set_below(set, number[i]) * words, *item + i * words,
               words * sizeof *made);
    free(number);
    free(*item);
    *item = made;
    return made;
}

static tm_status fill_tets(tm_poly_tets *share, const uint32_t *item, size_t words,
                           const tm_tet_slices *slices, tm_number_set *nodes,
                           tm_error *error)
{
    tm_tet_mesh *mesh = &share->mesh;
    tm_part_nodes part;
    const size_t count = share->tet.count, width = slices->width;
    mesh->tet = tm_new(count, sizeof *mesh->tet);
    mesh->neighbour = tm_new(count, sizeof *mesh->neighbour);
    mesh->region = width > 0 ? tm_new(count, width * sizeof *mesh->region) : NULL;
    const bool enough = mesh->tet && mesh->neighbour && (mesh->region || width == 0);
    tm_status status = tm_ranks_enough(enough, error);
    for (size_t t = 0; enough && item && t < count; t++) {
        memcpy(mesh->tet[t], item + t * words + 1, sizeof *mesh->tet);
        if (width > 0)
            memcpy(mesh->region + t * width, item + t * words + 1 + 4,
                   width * sizeof *mesh->region);
    }
    mesh->slots = mesh->tets = mesh->slot_room = count;
    mesh->regions = width;
    if (status == TM_OK)
        status =
            tm_part_nodes_make(&part, (uint32_t *)mesh->tet, 4 * count, &slices->nodes,
                               (const double(*)[3])slices->node->real, error);
    if (status == TM_OK) {
        mesh->xyz = part.xyz;
        mesh->nodes = mesh->node_room = part.set.count;
        share->node = part.number;
        *nodes = part.set;
    }
    return status;
}

/* The rows of .face that name only nodes which are here. */
static bool fill_faces(tm_poly_tets *share, const uint32_t *item, size_t items,
                       const tm_number_set *nodes)
{
    tm_tet_mesh *mesh = &share->mesh;
    if (tm_tet_mesh_reserve(mesh, 0, 0, items, 0, NULL) != TM_OK)
        return false;
    for (size_t f = 0; f < items; f++, item += FACE_WORDS) {
        tm_constrained_face face = {.side = {TM_NONE, TM_NONE},
                                    .marker = (int32_t)item[FACE_WORDS - 1],
                                    .listed = true};
        bool here = true;
        for (size_t i = 0; i < 3; i++) {
            here = here && tm_number_set_has(nodes, item[1 + i]);
            face.node[i] = tm_number_set_below(nodes, item[1 + i]);
        }
        if (here)
            mesh->face[mesh->faces++] = face;
    }
    return true;
}

tm_status tm_poly_tets_make(tm_poly_tets *share, tm_post *asking, const tm_homes *homes,
                            const tm_tet_slices *slices, bool *odd,
                            const tm_poly_options *options, tm_error *error)
{
    uint32_t *asked = NULL, *tet = NULL, *face = NULL;
    size_t words = 0, tets = 0, faces = 0;
    tm_number_set here = {0}, rows = {0};
    *share = (tm_poly_tets){.mesh = {.first_dead = TM_NONE}};
    tm_status status = tm_post_deliver(asking, &asked, &words, error);
    if (status == TM_OK)
        status = answer(homes, &homes->tet, asked, words / 2, &tet, &tets, error);
    if (status == TM_OK)
        status = answer(homes, &homes->face, asked, words / 2, &face, &faces, error);
    free(asked);
    if (status == TM_OK)
        status =
            tm_ranks_enough(put_in_order(&tet, tets, homes->tet.words, &share->tet) &&
                                put_in_order(&face, faces, homes->face.words, &rows),
                            error);
    if (status == TM_OK)
        status = fill_tets(share, tet, homes->tet.words, slices, &here, error);
    if (status == TM_OK)
        status = tm_ranks_enough(fill_faces(share, face, rows.count, &here), error);
    free(tet);
    free(face);
    if (status == TM_OK) {
        tm_status connected =
            tm_tet_mesh_connect(&share->mesh, 0, options->threads, error);
        *odd = tm_ranks_any(connected == TM_ERROR_INPUT);
        status = tm_ranks_agree(connected == TM_ERROR_INPUT ? TM_OK : connected, error);
    }
    tm_number_set_free(&here);
    tm_number_set_free(&rows);
    return status;
}

void tm_poly_tets_free(tm_poly_tets *share)
{
    tm_tet_mesh_free(&share->mesh);
    tm_number_set_free(&share->tet);
    free(share->node);
}
