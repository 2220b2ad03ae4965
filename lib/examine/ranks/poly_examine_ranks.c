/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra with all their facets are looked at by those who have them, facets with the
 * polyhedra that list them by those who have these, and facets again by those who have a
 * node of them; edges are counted by those who have the smaller node. */
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
    bool sizes_only; /* of facets: tm_poly_count_ranks() */
    tm_error *error;
} examining;

/* Polyhedra ------------------------------------------------------------------------ */

/* Names of polyhedra and nodes in the places of what was found. */
static void rename_cells(examining *x, const tm_poly_part *part)
{
    static const tm_defect of_cells[] = {TM_INVERTED, TM_DEGENERATE, TM_UNCLOSED_EDGE,
                                         TM_UNORIENTED_EDGE};
    for (size_t d = 0; d < sizeof of_cells / sizeof *of_cells; d++) {
        tm_defect_list *list = &x->found->defect[of_cells[d]];
        for (size_t i = 0; i < list->count && i < TM_DEFECTS_LISTED; i++) {
            uint32_t *place = list->place[i];
            place[0] += (uint32_t)x->cells.first;
            for (size_t n = 1; n < 3 && d >= 2; n++)
                place[n] = part->nodes.number[place[n]];
        }
    }
}

static tm_status examine_cells(examining *x, unsigned threads)
{
    const size_t chunks = tm_parallel_chunks(x->cells.count, TM_POLY_CHUNK);
    tm_sum *volume = tm_new(chunks, sizeof *volume);
    tm_poly_part part = {.mesh = {0}};
    tm_status status = tm_ranks_enough(volume, x->error);
    if (status == TM_OK)
        status = tm_poly_part_of_cells(&part, x->mesh, x->error);
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_poly_examine_cells(x->found, &part.mesh, volume, threads, x->error),
            x->error);
    if (status == TM_OK) {
        rename_cells(x, &part);
        status = tm_sum_of_chunks(volume, chunks, &x->found->volume, x->error);
    }
    tm_poly_part_free(&part);
    free(volume);
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

static void add_area(const void *context, void *sum)
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

/* Sides become the polyhedra that are here. */
static void find_sides(tm_poly_part *part, const listing *l)
{
    for (size_t f = 0; f < part->mesh.facets; f++)
        for (size_t i = 0; i < 2; i++) {
            const uint32_t cell = part->side[f][i];
            const size_t at = tm_first_not_below(l->cell, l->cells, cell);
            const bool is_here = at < l->cells && l->cell[at] == cell;
            if (cell != TM_NONE)
                part->side[f][i] = is_here ? (uint32_t)at : TM_NONE - 1;
        }
}

/* What was found of the facets of the slice gets the numbers of the whole. */
static void rename_facets(const examining *x, tm_examination *found,
                          const uint32_t *node_number)
{
    tm_defect_list *twice = &found->defect[TM_DEGENERATE];
    for (size_t i = 0; i < TM_DEFECTS_LISTED; i++) {
        found->defect[TM_UNMATCHED_FACE].place[i][0] += (uint32_t)x->facets.first;
        twice->place[i][0] += (uint32_t)x->facets.first;
    }
    for (size_t i = 0; i < twice->count && i < TM_DEFECTS_LISTED; i++)
        twice->place[i][1] = node_number[twice->place[i][1]];
}

/* The facets that this rank has with the polyhedra that list them; these are connected in
 * trees. */
static tm_status match_facets(examining *x, const tm_poly_part *part, const listing *l)
{
    tm_examination found = {0};
    uint32_t *tree = tm_new(l->cells, sizeof *tree);
    tm_status status = tm_ranks_enough(tree, x->error);
    if (status == TM_OK)
        status = tm_ranks_agree(tm_poly_match_facets(&found, &part->mesh, tree, x->error),
                                x->error);
    if (status == TM_OK && !x->sizes_only)
        status = count_components(x, l, tree);
    free(tree);
    rename_facets(x, &found, part->nodes.number);
    tm_defect_add_list(&x->found->defect[TM_UNMATCHED_FACE],
                       &found.defect[TM_UNMATCHED_FACE]);
    tm_defect_add_list(&x->found->defect[TM_DEGENERATE], &found.defect[TM_DEGENERATE]);
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
        x->found->euler +=
            (int64_t)used + (int64_t)x->mesh->facets - (int64_t)x->mesh->cells;
    }
    return status;
}

/* Sends each edge of facets here to who has its smaller node. */
static tm_status send_edges(const examining *x, const tm_poly_part *part, uint32_t **got,
                            size_t *words)
{
    const tm_poly_arrays *mesh = &part->mesh;
    const size_t corners = mesh->facet_start[mesh->facets];
    uint32_t(*edge)[2] = tm_new(corners, sizeof *edge);
    size_t edges = 0;
    tm_post post = {0};
    tm_status status = tm_ranks_enough(edge, x->error);
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_poly_find_edges(edge, &edges, mesh, 0, (uint32_t)mesh->nodes, x->error),
            x->error);
    for (size_t e = 0; e < edges && status == TM_OK; e++) {
        for (int i = 0; i < 2; i++)
            edge[e][i] = part->nodes.number[edge[e][i]];
        tm_post_put(&post, tm_rows_owner(&x->nodes, edge[e][0]), edge[e], 2);
    }
    free(edge);
    return status == TM_OK ? tm_post_deliver(&post, got, words, x->error) : status;
}

/* Counts those that came, as the edges of facets of two nodes. */
static tm_status count_edges(examining *x, const tm_poly_part *part)
{
    uint32_t *node = NULL;
    size_t words = 0, edges;
    tm_part_nodes nodes = {0};
    tm_status status = send_edges(x, part, &node, &words);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, node, words, NULL, NULL, x->error);
    if (status != TM_OK)
        words = 0;
    size_t *start = tm_new(words / 2 + 1, sizeof *start);
    for (size_t i = 0; i <= words / 2 && start; i++)
        start[i] = 2 * i;
    if (status == TM_OK)
        status = tm_ranks_enough(start, x->error);
    const tm_poly_arrays mesh = {.nodes = nodes.set.count,
                                 .facets = words / 2,
                                 .facet_start = start,
                                 .facet_node = node};
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_poly_find_edges(NULL, &edges, &mesh, 0, (uint32_t)mesh.nodes, x->error),
            x->error);
    if (status == TM_OK)
        x->found->euler -= (int64_t)edges;
    tm_part_nodes_free(&nodes);
    free(start);
    free(node);
    return status;
}

static tm_status examine_facets(examining *x)
{
    listing l = {0};
    tm_poly_part part = {.mesh = {0}};
    tm_status status = take_listing(x, &l);
    if (status == TM_OK)
        status = tm_poly_part_of_slice(&part, x->mesh, x->error);
    if (status == TM_OK) {
        find_sides(&part, &l);
        part.mesh.cells = l.cells;
        part.mesh.cell_start = l.start;
        part.mesh.cell_facet = l.facet;
        status = match_facets(x, &part, &l);
    }
    free(l.cell);
    free(l.start);
    free(l.facet);
    if (status == TM_OK)
        status = count_nodes(x, &part.nodes);
    if (status == TM_OK)
        status = count_edges(x, &part);
    if (status == TM_OK && !x->sizes_only) {
        tm_sum area = {0, 0};
        tm_sum_in_turn(&area, sizeof area, add_area, &part.mesh);
        x->found->area = tm_sum_value(area);
    }
    tm_poly_part_free(&part);
    return status;
}

/* At nodes ------------------------------------------------------------------------- */

static tm_status examine_at_nodes(examining *x)
{
    tm_examination found = {0};
    tm_poly_part here = {.mesh = {0}};
    tm_status status = tm_poly_part_of_nodes(&here, x->mesh, x->error);
    if (status == TM_OK) {
        const tm_number_set *set = &here.nodes.set;
        const uint32_t first = tm_number_set_below(set, (uint32_t)x->nodes.first);
        const uint32_t past =
            tm_number_set_below(set, (uint32_t)(x->nodes.first + x->nodes.count));
        status = tm_poly_find_repeated(&found, &here.mesh, first, past, x->error);
        if (status == TM_OK)
            status = tm_poly_examine_boundary(&found, &here.mesh, first, past, x->error);
        status = tm_ranks_agree(status, x->error);
    }
    tm_rename_places(&found.defect[TM_REPEATED_FACE], 2, here.number);
    tm_rename_places(&found.defect[TM_OPEN_EDGE], 2, here.nodes.number);
    tm_rename_places(&found.defect[TM_NON_MANIFOLD_EDGE], 2, here.nodes.number);
    tm_rename_places(&found.defect[TM_NON_MANIFOLD_VERTEX], 1, here.nodes.number);
    for (size_t d = 0; d < TM_DEFECTS && status == TM_OK; d++)
        tm_defect_add_list(&x->found->defect[d], &found.defect[d]);
    tm_poly_part_free(&here);
    return status;
}

/* All together --------------------------------------------------------------------- */

static examining examining_of(tm_examination *found, const tm_poly_slices *mesh,
                              tm_error *error)
{
    return (examining){.mesh = mesh,
                       .found = found,
                       .nodes = tm_rows_of(mesh->nodes),
                       .facets = tm_rows_of(mesh->facets),
                       .cells = tm_rows_of(mesh->cells),
                       .error = error};
}

tm_status tm_poly_count_ranks(tm_examination *found, const tm_poly_slices *mesh,
                              tm_error *error)
{
    *found = tm_poly_examination(mesh->nodes, mesh->cells);
    examining x = examining_of(found, mesh, error);
    x.sizes_only = true;
    const tm_status status = examine_facets(&x);
    return status == TM_OK ? tm_examination_join(found, error) : status;
}

tm_status tm_poly_examine_ranks(tm_examination *found, const tm_poly_slices *mesh,
                                unsigned threads, tm_error *error)
{
    *found = tm_poly_examination(mesh->nodes, mesh->cells);
    examining x = examining_of(found, mesh, error);
    tm_status status = examine_cells(&x, threads);
    if (status == TM_OK)
        status = examine_facets(&x);
    if (status == TM_OK)
        status = examine_at_nodes(&x);
    if (status == TM_OK)
        status = tm_examine_nodes_ranks(found, &x.nodes, mesh->own.xyz, error);
    if (status == TM_OK)
        status = tm_examination_join(found, error);
    return status;
}
