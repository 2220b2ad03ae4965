/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra with all their facets are looked at by those who have them, facets with the
 * polyhedra that list them by those who have these, and facets again, with their edges,
 * by those who have a node of them. */
#include "parts.h"

#include "../../base/array.h"
#include "../../mesh/ranks/components.h"
#include "../../ranks/post.h"
#include "../poly/poly_parts.h"

#include <stdlib.h>
#include <string.h>

typedef struct examining {
    const tm_poly_slices *mesh;
    tm_examination *found; /* by this rank */
    tm_rows nodes, facets, cells;
    tm_error *error;
} examining;

/* Letters of facets: the number, the two sides, how many nodes, and these. */
enum { HEAD = 4 };

/* Facets from other ranks, with the nodes that they name. */
typedef struct facets_here {
    tm_poly_arrays mesh;
    uint32_t *number; /* [facets]: in the whole */
    uint32_t (*side)[2];
    size_t *start;
    uint32_t *node;
    tm_part_nodes nodes;
} facets_here;

static void free_facets(facets_here *h)
{
    free(h->number);
    free(h->side);
    free(h->start);
    free(h->node);
    tm_part_nodes_free(&h->nodes);
}

static void send_facet(tm_post *post, unsigned to, const examining *x, size_t f)
{
    const tm_poly_arrays *own = &x->mesh->own;
    const size_t start = own->facet_start[f], k = own->facet_start[f + 1] - start;
    const uint32_t head[HEAD] = {(uint32_t)(x->facets.first + f), own->side[f][0],
                                 own->side[f][1], (uint32_t)k};
    tm_post_put(post, to, head, HEAD);
    tm_post_put(post, to, own->facet_node + start, k);
}

/* Makes arrays of letters, in their order; with nodes' places where asked. */
static tm_status take_facets(facets_here *h, const uint32_t *word, size_t words,
                             const examining *x, bool with_places)
{
    size_t count = 0, nodes = 0;
    for (size_t at = 0; at < words; count++) {
        nodes += word[at + HEAD - 1];
        at += HEAD + word[at + HEAD - 1];
    }
    h->number = tm_new(count, sizeof *h->number);
    h->side = tm_new(count, sizeof *h->side);
    h->start = calloc(count + 1, sizeof *h->start);
    h->node = tm_new(nodes, sizeof *h->node);
    const bool enough = h->number && h->side && h->start && h->node;
    tm_status status = tm_ranks_enough(enough, x->error);
    for (size_t f = 0, at = 0; f < count && enough; f++) {
        const size_t k = word[at + HEAD - 1];
        h->number[f] = word[at];
        memcpy(h->side[f], word + at + 1, sizeof *h->side);
        memcpy(h->node + h->start[f], word + at + HEAD, k * sizeof *word);
        h->start[f + 1] = h->start[f] + k;
        at += HEAD + k;
    }
    if (status == TM_OK)
        status =
            tm_part_nodes_make(&h->nodes, h->node, nodes, with_places ? &x->nodes : NULL,
                               x->mesh->own.xyz, x->error);
    h->mesh = (tm_poly_arrays){.nodes = h->nodes.set.count,
                               .xyz = (const double(*)[3])h->nodes.xyz,
                               .facets = count,
                               .side = (const uint32_t(*)[2])h->side,
                               .facet_start = h->start,
                               .facet_node = h->node};
    return status;
}

/* Polyhedra ------------------------------------------------------------------------ */

/* Gets the facets that are in a set, from those who have them. */
static tm_status fetch_facets(const examining *x, const tm_number_set *set,
                              facets_here *h)
{
    const unsigned ranks = tm_ranks_count();
    uint32_t *number = tm_new(set->count, sizeof *number), *asked = NULL, *got = NULL;
    size_t *counts = calloc(ranks, sizeof *counts), words = 0, at = 0;
    tm_post post = {0};
    tm_status status = tm_ranks_enough(number && counts, x->error);
    if (status == TM_OK) {
        tm_number_set_list(set, number);
        for (size_t i = 0; i < set->count; i++)
            counts[tm_rows_owner(&x->facets, number[i])]++;
        status = tm_ranks_exchange(number, counts, sizeof *number, (void **)&asked,
                                   counts, x->error);
    }
    for (unsigned r = 0; r < ranks && status == TM_OK; r++)
        for (size_t i = 0; i < counts[r]; i++)
            send_facet(&post, r, x, asked[at++] - x->facets.first);
    if (status == TM_OK)
        status = tm_post_deliver(&post, &got, &words, x->error);
    if (status == TM_OK)
        status = take_facets(h, got, words, x, true);
    free(number);
    free(asked);
    free(got);
    free(counts);
    return status;
}

/* Names of polyhedra and nodes in the places of what was found. */
static void rename_cells(examining *x, const facets_here *h)
{
    static const tm_defect of_cells[] = {TM_INVERTED, TM_DEGENERATE, TM_UNCLOSED_EDGE,
                                         TM_UNORIENTED_EDGE};
    for (size_t d = 0; d < sizeof of_cells / sizeof *of_cells; d++) {
        tm_defect_list *list = &x->found->defect[of_cells[d]];
        for (size_t i = 0; i < list->count && i < TM_DEFECTS_LISTED; i++) {
            uint32_t *place = list->place[i];
            place[0] += (uint32_t)x->cells.first;
            for (size_t n = 1; n < 3 && d >= 2; n++)
                place[n] = h->nodes.number[place[n]];
        }
    }
}

/* The polyhedra with their facets, numbered as they are here: `list` are those facets. */
static tm_status measure_cells(examining *x, facets_here *h, const uint32_t *list,
                               unsigned threads)
{
    const size_t chunks = tm_parallel_chunks(x->cells.count, TM_POLY_CHUNK);
    tm_sum *volume = tm_new(chunks, sizeof *volume);
    tm_status status = tm_ranks_enough(volume, x->error);
    for (size_t f = 0; f < 2 * h->mesh.facets; f++) {
        uint32_t *side = &h->side[f / 2][f % 2];
        if (*side != TM_NONE)
            *side = tm_rows_have(&x->cells, *side) ? *side - (uint32_t)x->cells.first
                                                   : TM_NONE - 1;
    }
    h->mesh.cells = x->cells.count;
    h->mesh.cell_start = x->mesh->own.cell_start;
    h->mesh.cell_facet = list;
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_poly_examine_cells(x->found, &h->mesh, volume, threads, x->error),
            x->error);
    if (status == TM_OK) {
        rename_cells(x, h);
        status = tm_sum_of_chunks(volume, chunks, &x->found->volume, x->error);
    }
    free(volume);
    return status;
}

static size_t listed_by(const tm_poly_arrays *mesh)
{
    return mesh->cells > 0 ? mesh->cell_start[mesh->cells] : 0;
}

static tm_status examine_cells(examining *x, unsigned threads)
{
    const size_t items = listed_by(&x->mesh->own);
    uint32_t *list = tm_new(items, sizeof *list);
    tm_number_set set = {0};
    facets_here here = {0};
    const bool enough =
        list && tm_number_set_of(&set, x->mesh->own.cell_facet, items, TM_NONE);
    tm_status status = tm_ranks_enough(enough, x->error);
    for (size_t i = 0; i < items && status == TM_OK; i++)
        list[i] = tm_number_set_below(&set, x->mesh->own.cell_facet[i]);
    if (status == TM_OK)
        status = fetch_facets(x, &set, &here);
    if (status == TM_OK)
        status = measure_cells(x, &here, list, threads);
    free_facets(&here);
    tm_number_set_free(&set);
    free(list);
    return status;
}

/* Facets --------------------------------------------------------------------------- */

/* The polyhedra that list facets which this rank has. */
typedef struct listing {
    uint32_t *cell; /* [cells]: their numbers */
    size_t cells;
    size_t *start; /* [cells + 1] */
    uint32_t *facet;
} listing;

/* Tells those who have facets by which polyhedra they are listed. */
static tm_status tell_facets(const examining *x, uint32_t **got, size_t *pairs)
{
    const tm_poly_arrays *own = &x->mesh->own;
    tm_post post = {0};
    for (size_t c = 0; c < own->cells; c++)
        for (size_t i = own->cell_start[c]; i < own->cell_start[c + 1]; i++) {
            const uint32_t letter[2] = {(uint32_t)(x->cells.first + c),
                                        own->cell_facet[i]};
            tm_post_put(&post, tm_rows_owner(&x->facets, letter[1]), letter, 2);
        }
    const tm_status status = tm_post_deliver(&post, got, pairs, x->error);
    *pairs /= 2;
    return status;
}

static tm_status take_listing(const examining *x, listing *l)
{
    uint32_t *got = NULL;
    size_t pairs;
    tm_status status = tell_facets(x, &got, &pairs);
    if (status != TM_OK)
        return status;
    l->cell = tm_new(pairs, sizeof *l->cell);
    l->start = tm_new(pairs + 1, sizeof *l->start);
    l->facet = tm_new(pairs, sizeof *l->facet);
    status = tm_ranks_enough(l->cell && l->start && l->facet, x->error);
    for (size_t i = 0; i < pairs && status == TM_OK; i++) {
        if (l->cells == 0 || l->cell[l->cells - 1] != got[2 * i]) {
            l->start[l->cells] = i;
            l->cell[l->cells++] = got[2 * i];
        }
        l->facet[i] = got[2 * i + 1] - (uint32_t)x->facets.first;
    }
    if (status == TM_OK)
        l->start[l->cells] = pairs;
    free(got);
    return status;
}

static void add_area(const void *context, tm_sum *sum)
{
    tm_poly_add_boundary_area(sum, context);
}

/* Counts the components of all by the trees of those here. */
static tm_status count_components(const examining *x, const listing *l,
                                  const uint32_t *tree)
{
    uint32_t(*pair)[2] = tm_new(l->cells, sizeof *pair);
    uint32_t *parent = tm_new(x->cells.count, sizeof *parent);
    size_t pairs = 0;
    tm_status status = tm_ranks_enough(pair && parent, x->error);
    for (uint32_t c = 0; c < l->cells && status == TM_OK; c++)
        if (tree[c] != c) {
            pair[pairs][0] = l->cell[c];
            pair[pairs++][1] = l->cell[tree[c]];
        }
    if (status == TM_OK)
        status = tm_ranks_unite(&x->cells, pair, pairs, parent, x->error);
    for (size_t c = 0; c < x->cells.count && status == TM_OK; c++)
        x->found->components += parent[c] == x->cells.first + c;
    free(pair);
    free(parent);
    return status;
}

/* Sides as the polyhedra that are here. */
static void find_sides(const tm_poly_arrays *own, const listing *l, uint32_t (*side)[2])
{
    for (size_t f = 0; f < own->facets; f++)
        for (size_t i = 0; i < 2; i++) {
            const uint32_t cell = own->side[f][i];
            const size_t at = tm_first_not_below(l->cell, l->cells, cell);
            const bool is_here = at < l->cells && l->cell[at] == cell;
            side[f][i] = cell == TM_NONE ? TM_NONE : is_here ? (uint32_t)at : TM_NONE - 1;
        }
}

/* The facets that this rank has, whose nodes are numbered as they are here, with the
 * polyhedra that list them. */
static tm_status match_facets(examining *x, const tm_poly_arrays *mesh, const listing *l,
                              const uint32_t *node_number)
{
    tm_examination found = {0};
    uint32_t *tree = tm_new(l->cells, sizeof *tree);
    tm_status status = tm_ranks_enough(tree, x->error);
    if (status == TM_OK)
        status =
            tm_ranks_agree(tm_poly_match_facets(&found, mesh, tree, x->error), x->error);
    if (status == TM_OK)
        status = count_components(x, l, tree);
    free(tree);
    for (size_t i = 0; i < TM_DEFECTS_LISTED; i++) {
        found.defect[TM_UNMATCHED_FACE].place[i][0] += (uint32_t)x->facets.first;
        found.defect[TM_DEGENERATE].place[i][0] += (uint32_t)x->facets.first;
    }
    tm_defect_list *twice = &found.defect[TM_DEGENERATE];
    for (size_t i = 0; i < twice->count && i < TM_DEFECTS_LISTED; i++)
        twice->place[i][1] = node_number[twice->place[i][1]];
    tm_defect_add_list(&x->found->defect[TM_UNMATCHED_FACE],
                       &found.defect[TM_UNMATCHED_FACE]);
    tm_defect_add_list(&x->found->defect[TM_DEGENERATE], twice);
    x->found->boundary_faces = found.boundary_faces;
    return status;
}

static tm_status count_nodes(const examining *x, const tm_part_nodes *nodes)
{
    size_t used;
    const tm_status status =
        tm_count_used_nodes(&x->nodes, nodes->number, nodes->set.count, &used, x->error);
    if (status == TM_OK && tm_rank() == 0) {
        x->found->unused_nodes = x->mesh->nodes - used;
        x->found->euler =
            (int64_t)used + (int64_t)x->mesh->facets - (int64_t)x->mesh->cells;
    }
    return status;
}

static tm_status examine_facets(examining *x)
{
    tm_poly_arrays mesh = x->mesh->own;
    const size_t corners = mesh.facets > 0 ? mesh.facet_start[mesh.facets] : 0;
    uint32_t *node = tm_new(corners, sizeof *node);
    uint32_t(*side)[2] = tm_new(mesh.facets, sizeof *side);
    listing l = {0};
    tm_part_nodes nodes = {0};
    tm_status status = tm_ranks_enough(node && side, x->error);
    if (status == TM_OK)
        status = take_listing(x, &l);
    if (status == TM_OK && node && corners > 0)
        memcpy(node, mesh.facet_node, corners * sizeof *node);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, node, corners, &x->nodes, mesh.xyz, x->error);
    if (status == TM_OK) {
        find_sides(&x->mesh->own, &l, side);
        mesh = (tm_poly_arrays){.nodes = nodes.set.count,
                                .xyz = (const double(*)[3])nodes.xyz,
                                .facets = mesh.facets,
                                .side = (const uint32_t(*)[2])side,
                                .facet_start = mesh.facet_start,
                                .facet_node = node,
                                .cells = l.cells,
                                .cell_start = l.start,
                                .cell_facet = l.facet};
        status = match_facets(x, &mesh, &l, nodes.number);
    }
    if (status == TM_OK) {
        tm_sum area;
        tm_sum_in_turn(&area, add_area, &mesh);
        x->found->area = tm_sum_value(area);
        status = count_nodes(x, &nodes);
    }
    tm_part_nodes_free(&nodes);
    free(l.cell);
    free(l.start);
    free(l.facet);
    free(node);
    free(side);
    return status;
}

/* Edges ---------------------------------------------------------------------------- */

/* Each facet to those who have its nodes. */
static tm_status send_facets(const examining *x, facets_here *h)
{
    const tm_poly_arrays *own = &x->mesh->own;
    tm_post post = {0};
    uint32_t *got, *last = tm_new(tm_ranks_count(), sizeof *last);
    size_t words;
    post.failed = !last;
    for (unsigned r = 0; r < tm_ranks_count() && last; r++)
        last[r] = TM_NONE;
    for (uint32_t f = 0; f < own->facets && last; f++)
        for (size_t i = own->facet_start[f]; i < own->facet_start[f + 1]; i++) {
            const unsigned to = tm_rows_owner(&x->nodes, own->facet_node[i]);
            if (last[to] != f)
                send_facet(&post, to, x, f);
            last[to] = f;
        }
    free(last);
    tm_status status = tm_post_deliver(&post, &got, &words, x->error);
    if (status == TM_OK)
        status = take_facets(h, got, words, x, false);
    free(got);
    return status;
}

static tm_status examine_edges(examining *x)
{
    tm_examination found = {0};
    facets_here here = {0};
    size_t edges = 0;
    tm_status status = send_facets(x, &here);
    if (status == TM_OK) {
        const tm_number_set *set = &here.nodes.set;
        const uint32_t first = tm_number_set_below(set, (uint32_t)x->nodes.first);
        const uint32_t past =
            tm_number_set_below(set, (uint32_t)(x->nodes.first + x->nodes.count));
        status = tm_poly_match_edges(&found, &here.mesh, first, past, &edges, x->error);
        if (status == TM_OK)
            status = tm_poly_examine_boundary(&found, &here.mesh, first, past, x->error);
        status = tm_ranks_agree(status, x->error);
    }
    x->found->euler -= (int64_t)edges;
    tm_rename_places(&found.defect[TM_REPEATED_FACE], 2, here.number);
    tm_rename_places(&found.defect[TM_OPEN_EDGE], 2, here.nodes.number);
    tm_rename_places(&found.defect[TM_NON_MANIFOLD_EDGE], 2, here.nodes.number);
    tm_rename_places(&found.defect[TM_NON_MANIFOLD_VERTEX], 1, here.nodes.number);
    for (size_t d = 0; d < TM_DEFECTS && status == TM_OK; d++)
        tm_defect_add_list(&x->found->defect[d], &found.defect[d]);
    free_facets(&here);
    return status;
}

tm_status tm_poly_examine_ranks(tm_examination *found, const tm_poly_slices *mesh,
                                unsigned threads, tm_error *error)
{
    *found = tm_poly_examination(mesh->nodes, mesh->cells);
    examining x = {.mesh = mesh,
                   .found = found,
                   .nodes = tm_rows_of(mesh->nodes),
                   .facets = tm_rows_of(mesh->facets),
                   .cells = tm_rows_of(mesh->cells),
                   .error = error};
    tm_status status = examine_cells(&x, threads);
    if (status == TM_OK)
        status = examine_facets(&x);
    if (status == TM_OK)
        status = examine_edges(&x);
    if (status == TM_OK)
        status = tm_examine_nodes_ranks(found, &x.nodes, mesh->own.xyz, error);
    if (status == TM_OK)
        status = tm_examination_join(found, error);
    return status;
}
