/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Facets go to who looks at them, as letters: the number, the two sides, how many nodes,
 * and these. */
#include "parts.h"

#include "../../base/array.h"
#include "../../ranks/post.h"

#include <stdlib.h>
#include <string.h>

enum { NUMBER, SIDE, CORNERS = 3, HEAD };

void tm_poly_part_free(tm_poly_part *part)
{
    free(part->number);
    free(part->side);
    free(part->start);
    free(part->node);
    free(part->list);
    tm_part_nodes_free(&part->nodes);
}

static void set_mesh(tm_poly_part *part, size_t facets)
{
    part->mesh = (tm_poly_arrays){.nodes = part->nodes.set.count,
                                  .xyz = (const double(*)[3])part->nodes.xyz,
                                  .facets = facets,
                                  .side = (const uint32_t(*)[2])part->side,
                                  .facet_start = part->start,
                                  .facet_node = part->node};
}

tm_status tm_poly_part_of_slice(tm_poly_part *part, const tm_poly_slices *mesh,
                                tm_error *error)
{
    const tm_poly_arrays *own = &mesh->own;
    const size_t corners = own->facets > 0 ? own->facet_start[own->facets] : 0;
    const tm_rows nodes = tm_rows_of(mesh->nodes);
    *part = (tm_poly_part){.side = tm_new(own->facets, sizeof *part->side),
                           .start = tm_new(own->facets + 1, sizeof *part->start),
                           .node = tm_new(corners, sizeof *part->node)};
    tm_status status = tm_ranks_enough(part->side && part->start && part->node, error);
    if (status != TM_OK)
        return status;
    part->start[0] = 0;
    if (own->facets > 0) {
        memcpy(part->side, own->side, own->facets * sizeof *part->side);
        memcpy(part->start, own->facet_start, (own->facets + 1) * sizeof *part->start);
        memcpy(part->node, own->facet_node, corners * sizeof *part->node);
    }
    status =
        tm_part_nodes_make(&part->nodes, part->node, corners, &nodes, own->xyz, error);
    set_mesh(part, own->facets);
    return status;
}

/* Letters -------------------------------------------------------------------------- */

static void send_facet(tm_post *post, unsigned to, const tm_poly_slices *mesh,
                       size_t first, size_t f)
{
    const tm_poly_arrays *own = &mesh->own;
    const size_t start = own->facet_start[f], k = own->facet_start[f + 1] - start;
    const uint32_t head[HEAD] = {(uint32_t)(first + f), own->side[f][0], own->side[f][1],
                                 (uint32_t)k};
    tm_post_put(post, to, head, HEAD);
    tm_post_put(post, to, own->facet_node + start, k);
}

/* How many letters there are, and how many nodes these name. */
static size_t count_letters(const uint32_t *word, size_t words, size_t *nodes)
{
    size_t count = 0;
    *nodes = 0;
    for (size_t at = 0; at < words; count++) {
        *nodes += word[at + CORNERS];
        at += HEAD + word[at + CORNERS];
    }
    return count;
}

/* Delivers the letters and makes arrays of those that came, in their order; with nodes'
 * places where asked. */
static tm_status take_facets(tm_poly_part *part, tm_post *post,
                             const tm_poly_slices *mesh, bool with_places,
                             tm_error *error)
{
    uint32_t *word;
    size_t words, nodes, at = 0;
    tm_status status = tm_post_deliver(post, &word, &words, error);
    if (status != TM_OK)
        return status;
    const size_t count = count_letters(word, words, &nodes);
    part->number = tm_new(count, sizeof *part->number);
    part->side = tm_new(count, sizeof *part->side);
    part->start = calloc(count + 1, sizeof *part->start);
    part->node = tm_new(nodes, sizeof *part->node);
    const bool enough = part->number && part->side && part->start && part->node;
    for (size_t f = 0; f < count && enough; f++) {
        const size_t k = word[at + CORNERS];
        part->number[f] = word[at + NUMBER];
        memcpy(part->side[f], word + at + SIDE, sizeof *part->side);
        memcpy(part->node + part->start[f], word + at + HEAD, k * sizeof *word);
        part->start[f + 1] = part->start[f] + k;
        at += HEAD + k;
    }
    free(word);
    status = tm_ranks_enough(enough, error);
    const tm_rows rows = tm_rows_of(mesh->nodes);
    if (status == TM_OK)
        status = tm_part_nodes_make(&part->nodes, part->node, nodes,
                                    with_places ? &rows : NULL, mesh->own.xyz, error);
    set_mesh(part, count);
    return status;
}

/* Of cells ------------------------------------------------------------------------- */

static size_t items_of(const tm_poly_arrays *own)
{
    return own->cells > 0 ? own->cell_start[own->cells] : 0;
}

/* Facets of this rank's slice that each rank is to get, ascending. */
typedef struct wanted {
    uint32_t *listed, *naming; /* by cells there; naming these */
    size_t *listed_count, *naming_count;
} wanted;

/* Asks those who have them for the facets that cells here list. */
static tm_status ask_for_listed(wanted *w, const tm_poly_slices *mesh, tm_error *error)
{
    const tm_rows facets = tm_rows_of(mesh->facets);
    tm_number_set set = {0};
    const bool made =
        tm_number_set_of(&set, mesh->own.cell_facet, items_of(&mesh->own), TM_NONE);
    uint32_t *number = made ? tm_new(set.count, sizeof *number) : NULL, *asked = NULL;
    tm_status status = tm_ranks_enough(number, error);
    if (status == TM_OK) {
        tm_number_set_list(&set, number);
        for (size_t i = 0; i < set.count; i++)
            w->listed_count[tm_rows_owner(&facets, number[i])]++;
        status = tm_ranks_exchange(number, w->listed_count, sizeof *number,
                                   (void **)&asked, w->listed_count, error);
    }
    w->listed = asked;
    free(number);
    tm_number_set_free(&set);
    return status;
}

/* Calls for each rank whose cells a facet names, once: counts, or sets it at next[rank].
 */
static void name_ranks(const tm_poly_slices *mesh, size_t f, size_t *next,
                       uint32_t *naming)
{
    const tm_rows cells = tm_rows_of(mesh->cells), facets = tm_rows_of(mesh->facets);
    unsigned last = tm_ranks_count();
    for (int i = 0; i < 2; i++) {
        const uint32_t cell = mesh->own.side[f][i];
        const unsigned rank = cell == TM_NONE ? last : tm_rows_owner(&cells, cell);
        if (rank == last)
            continue;
        if (naming)
            naming[next[rank]] = (uint32_t)(facets.first + f);
        next[rank]++;
        last = rank;
    }
}

static tm_status find_naming(wanted *w, const tm_poly_slices *mesh, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const size_t facets = mesh->own.facets;
    size_t *next = calloc(ranks, sizeof *next), all = 0;
    w->naming = tm_new(2 * facets, sizeof *w->naming);
    for (size_t f = 0; f < facets && next && w->naming; f++)
        name_ranks(mesh, f, w->naming_count, NULL);
    for (unsigned r = 0; r < ranks && next; r++) {
        next[r] = all;
        all += w->naming_count[r];
    }
    for (size_t f = 0; f < facets && next && w->naming; f++)
        name_ranks(mesh, f, next, w->naming);
    const bool enough = next && w->naming;
    free(next);
    return tm_ranks_enough(enough, error);
}

/* Both lists as one, without those twice. */
static void send_wanted(tm_post *post, const wanted *w, const tm_poly_slices *mesh)
{
    const size_t first = tm_rows_of(mesh->facets).first;
    const uint32_t *a = w->listed, *b = w->naming;
    for (unsigned r = 0; r < tm_ranks_count(); r++) {
        const uint32_t *const a_end = a + w->listed_count[r];
        const uint32_t *const b_end = b + w->naming_count[r];
        while (a < a_end || b < b_end) {
            const bool in_a = a < a_end && (b == b_end || *a <= *b);
            const bool in_b = b < b_end && (a == a_end || *b <= *a);
            send_facet(post, r, mesh, first, (in_a ? *a : *b) - first);
            a += in_a;
            b += in_b;
        }
    }
}

static tm_status fetch_facets(tm_poly_part *part, const tm_poly_slices *mesh,
                              tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    wanted w = {.listed_count = calloc(ranks, sizeof *w.listed_count),
                .naming_count = calloc(ranks, sizeof *w.naming_count)};
    tm_post post = {0};
    tm_status status = tm_ranks_enough(w.listed_count && w.naming_count, error);
    if (status == TM_OK)
        status = ask_for_listed(&w, mesh, error);
    if (status == TM_OK)
        status = find_naming(&w, mesh, error);
    if (status == TM_OK)
        send_wanted(&post, &w, mesh);
    free(w.listed);
    free(w.naming);
    free(w.listed_count);
    free(w.naming_count);
    return status == TM_OK ? take_facets(part, &post, mesh, true, error) : status;
}

/* Numbers as they are here, of sides and in the lists of cells. */
static bool renumber(tm_poly_part *part, const tm_poly_slices *mesh)
{
    const tm_rows cells = tm_rows_of(mesh->cells);
    const size_t items = items_of(&mesh->own);
    tm_number_set set = {0};
    part->list = tm_new(items, sizeof *part->list);
    const bool enough =
        part->list && tm_number_set_of(&set, part->number, part->mesh.facets, TM_NONE);
    for (size_t i = 0; i < items && enough; i++)
        part->list[i] = tm_number_set_below(&set, mesh->own.cell_facet[i]);
    tm_number_set_free(&set);
    for (size_t f = 0; f < part->mesh.facets; f++)
        for (int i = 0; i < 2; i++) {
            uint32_t *side = &part->side[f][i];
            if (*side != TM_NONE)
                *side = (uint32_t)(tm_rows_have(&cells, *side) ? *side - cells.first
                                                               : cells.count);
        }
    return enough;
}

tm_status tm_poly_part_of_cells(tm_poly_part *part, const tm_poly_slices *mesh,
                                tm_error *error)
{
    *part = (tm_poly_part){.mesh = {0}};
    tm_status status = fetch_facets(part, mesh, error);
    if (status == TM_OK)
        status = tm_ranks_enough(renumber(part, mesh), error);
    part->mesh.cells = mesh->own.cells;
    part->mesh.cell_start = mesh->own.cell_start;
    part->mesh.cell_facet = part->list;
    part->mesh.attributes = mesh->own.attributes;
    part->mesh.attribute = mesh->own.attribute;
    return status;
}

/* Of nodes ------------------------------------------------------------------------- */

tm_status tm_poly_part_of_nodes(tm_poly_part *part, const tm_poly_slices *mesh,
                                tm_error *error)
{
    const tm_poly_arrays *own = &mesh->own;
    const tm_rows nodes = tm_rows_of(mesh->nodes);
    const size_t first = tm_rows_of(mesh->facets).first;
    tm_post post = {0};
    uint32_t *last = tm_new(tm_ranks_count(), sizeof *last);
    *part = (tm_poly_part){.mesh = {0}};
    post.failed = !last;
    for (unsigned r = 0; r < tm_ranks_count() && last; r++)
        last[r] = TM_NONE;
    for (uint32_t f = 0; f < own->facets && last; f++)
        for (size_t i = own->facet_start[f]; i < own->facet_start[f + 1]; i++) {
            const unsigned to = tm_rows_owner(&nodes, own->facet_node[i]);
            if (last[to] != f)
                send_facet(&post, to, mesh, first, f);
            last[to] = f;
        }
    free(last);
    return take_facets(part, &post, mesh, false, error);
}
