/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../mesh/ranks/components.h"
#include "../../ranks/post.h"
#include "../examination_boundary.h"

#include <stdlib.h>
#include <string.h>

typedef struct examining {
    const tm_element_slices *mesh;
    tm_examination *found; /* by this rank */
    tm_rows nodes, elements;
    tm_element_measures measures; /* of the rank's elements */
    unsigned threads;
    tm_error *error;
} examining;

/* Measures this rank's elements. */
static tm_status measure(examining *x)
{
    const tm_mesh_view *own = &x->mesh->own;
    const size_t items =
        own->start ? own->start[own->elements] : TM_TET_NODES * own->elements;
    uint32_t *list = tm_new(items, sizeof *list);
    tm_part_nodes nodes = {0};
    tm_status status = tm_ranks_enough(list, x->error);
    if (status == TM_OK && items > 0)
        memcpy(list, own->item, items * sizeof *list);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, list, items, &x->nodes, own->xyz, x->error);
    if (status == TM_OK) {
        const tm_mesh_view view = {.nodes = nodes.set.count,
                                   .xyz = (const double(*)[3])nodes.xyz,
                                   .elements = own->elements,
                                   .start = own->start,
                                   .item = list};
        status = tm_ranks_agree(
            tm_element_measure(x->found, &view, &x->measures, x->threads, x->error),
            x->error);
    }
    if (status == TM_OK)
        status = tm_sum_of_chunks(x->measures.volume, x->measures.chunks,
                                  &x->found->volume, x->error);
    const tm_defect_list *flat = &x->found->defect[TM_DEGENERATE];
    for (size_t i = 0; i < flat->count && i < TM_DEFECTS_LISTED && status == TM_OK; i++) {
        uint32_t *place = x->found->defect[TM_DEGENERATE].place[i];
        place[0] += (uint32_t)x->elements.first;
        place[1] = place[1] == TM_NONE ? TM_NONE : nodes.number[place[1]];
    }
    for (size_t i = 0; i < TM_DEFECTS_LISTED; i++)
        x->found->defect[TM_INVERTED].place[i][0] += (uint32_t)x->elements.first;
    tm_part_nodes_free(&nodes);
    free(list);
    return status;
}

/* Joins the elements of this rank's trees to components of all. */
static tm_status count_components(const examining *x, const tm_element_part *part,
                                  uint32_t *tree)
{
    const size_t count = part->view.elements;
    const uint32_t *number = part->row[0];
    uint32_t(*pair)[2] = tm_new(count, sizeof *pair);
    uint32_t *parent = tm_new(x->elements.count, sizeof *parent);
    size_t pairs = 0;
    tm_status status = tm_ranks_enough(pair && parent, x->error);
    for (uint32_t e = 0; e < count && status == TM_OK; e++)
        if (tree[e] != e) {
            pair[pairs][0] = number[e];
            pair[pairs++][1] = number[tree[e]];
        }
    if (status == TM_OK)
        status = tm_ranks_unite(&x->elements, pair, pairs, parent, x->error);
    for (size_t e = 0; e < x->elements.count && status == TM_OK; e++) {
        const bool is_whole = x->measures.sign[e] != TM_NODE_TWICE;
        x->found->components += is_whole && parent[e] == x->elements.first + e;
        x->found->euler -= is_whole;
    }
    free(pair);
    free(parent);
    return status;
}

/* Nodes in use, of which this rank knows some. */
static tm_status count_nodes(const examining *x, const tm_element_part *part,
                             const uint8_t *used)
{
    uint32_t *node = tm_new(part->view.nodes, sizeof *node);
    size_t count = 0;
    tm_status status = tm_ranks_enough(node, x->error);
    for (size_t v = 0; v < part->view.nodes && status == TM_OK; v++)
        if (used[v])
            node[count++] = part->nodes.number[v];
    if (status == TM_OK)
        status = tm_count_used_nodes(&x->nodes, node, count, &count, x->error);
    if (status == TM_OK && tm_rank() == 0) {
        x->found->unused_nodes = x->mesh->nodes - count;
        x->found->euler += (int64_t)count;
    }
    free(node);
    return status;
}

/* The boundary --------------------------------------------------------------------- */

typedef struct boundary {
    const tm_boundary_faces *faces;
    const double (*xyz)[3];
} boundary;

static void add_area(const void *context, void *sum)
{
    const boundary *b = context;
    tm_add_boundary_area(sum, b->xyz, (const uint32_t(*)[4])b->faces->node,
                         b->faces->count);
}

/* The area of the faces that ranks have, in the order of these; they name nodes of the
 * part that is given, and then those of all. */
static tm_status measure_area(const examining *x, tm_boundary_faces *faces,
                              const tm_part_nodes *named)
{
    uint32_t *list = (uint32_t *)faces->node;
    const size_t items = 4 * faces->count;
    tm_part_nodes nodes;
    for (size_t i = 0; i < items; i++)
        list[i] = list[i] == TM_NONE ? TM_NONE : named->number[list[i]];
    const tm_status status =
        tm_part_nodes_make(&nodes, list, items, &x->nodes, x->mesh->own.xyz, x->error);
    if (status == TM_OK) {
        tm_sum area = {0, 0};
        tm_sum_in_turn(&area, sizeof area, add_area,
                       &(boundary){faces, (const double(*)[3])nodes.xyz});
        x->found->area = tm_sum_value(area);
    }
    for (size_t i = 0; i < items && status == TM_OK; i++)
        list[i] = list[i] == TM_NONE ? TM_NONE : nodes.number[list[i]];
    tm_part_nodes_free(&nodes);
    return status;
}

/* Each boundary face to those who have its nodes. */
static tm_status send_boundary(const examining *x, const tm_boundary_faces *faces,
                               tm_boundary_faces *got)
{
    tm_post post = {0};
    for (size_t f = 0; f < faces->count; f++) {
        const uint32_t *n = faces->node[f];
        unsigned to[4];
        size_t count = 0;
        for (size_t i = 0; i < 4 && n[i] != TM_NONE; i++) {
            size_t r = 0;
            to[count] = tm_rows_owner(&x->nodes, n[i]);
            while (to[r] != to[count])
                r++;
            if (r == count)
                tm_post_put(&post, to[count++], n, 4);
        }
    }
    const tm_status status =
        tm_post_deliver(&post, (uint32_t **)&got->node, &got->count, x->error);
    got->count /= 4;
    return status;
}

static tm_status examine_boundary(const examining *x, const tm_boundary_faces *faces)
{
    tm_examination found = {0};
    tm_boundary_faces at = {0};
    tm_part_nodes nodes = {0};
    tm_status status = send_boundary(x, faces, &at);
    if (status == TM_OK)
        status = tm_part_nodes_make(&nodes, (uint32_t *)at.node, 4 * at.count, NULL, NULL,
                                    x->error);
    if (status == TM_OK) {
        const uint32_t first = tm_number_set_below(&nodes.set, (uint32_t)x->nodes.first);
        const uint32_t past =
            tm_number_set_below(&nodes.set, (uint32_t)(x->nodes.first + x->nodes.count));
        status = tm_examine_boundary(&found, nodes.set.count, first, past,
                                     (const uint32_t(*)[4])at.node, at.count, x->error);
        if (status == TM_OK)
            status = tm_element_examine_nonconforming(&found, &at, first, past, x->error);
        status = tm_ranks_agree(status, x->error);
    }
    static const struct {
        tm_defect defect;
        size_t nodes;
    } is[] = {{TM_UNMATCHED_FACE, 3},
              {TM_OPEN_EDGE, 2},
              {TM_NON_MANIFOLD_EDGE, 2},
              {TM_NON_MANIFOLD_VERTEX, 1}};
    for (size_t i = 0; i < sizeof is / sizeof *is && status == TM_OK; i++) {
        tm_rename_places(&found.defect[is[i].defect], is[i].nodes, nodes.number);
        tm_defect_add_list(&x->found->defect[is[i].defect], &found.defect[is[i].defect]);
    }
    tm_part_nodes_free(&nodes);
    free(at.node);
    return status;
}

/* Faces ---------------------------------------------------------------------------- */

/* Defects of a part with the numbers of all. */
static void rename_defects(tm_examination *found, const tm_element_part *part)
{
    tm_rename_places(&found->defect[TM_UNMATCHED_FACE], 3, part->nodes.number);
    tm_rename_places(&found->defect[TM_OVERLAPPING_FACE], 2, part->row[0]);
    tm_rename_places(&found->defect[TM_DANGLING_EDGE], 1, part->row[2]);
    tm_rename_places(&found->defect[TM_REPEATED_EDGE], 2, part->row[2]);
}

static tm_status examine_faces(examining *x)
{
    tm_element_part part;
    tm_status status = tm_element_part_make(&part, x->mesh, x->measures.sign, x->error);
    tm_walked walked = {.face_row = part.row[1], .facet_row = part.row[3]};
    if (status == TM_OK) {
        walked.first = tm_number_set_below(&part.nodes.set, (uint32_t)x->nodes.first);
        walked.past = tm_number_set_below(&part.nodes.set,
                                          (uint32_t)(x->nodes.first + x->nodes.count));
        status = tm_ranks_agree(tm_element_examine_faces(x->found, &part.view, part.sign,
                                                         &walked, x->threads, x->error),
                                x->error);
    }
    if (status == TM_OK) {
        rename_defects(x->found, &part);
        status = count_components(x, &part, walked.parent);
    }
    if (status == TM_OK)
        status = count_nodes(x, &part, walked.used);
    if (status == TM_OK)
        status = measure_area(x, &walked.boundary, &part.nodes);
    tm_element_part_free(&part);
    if (status == TM_OK)
        status = examine_boundary(x, &walked.boundary);
    tm_walked_free(&walked);
    return status;
}

tm_status tm_element_examine_ranks(tm_examination *found, const tm_element_slices *mesh,
                                   unsigned threads, tm_error *error)
{
    *found = tm_element_examination(mesh->own.start, mesh->nodes, mesh->elements);
    examining x = {.mesh = mesh,
                   .found = found,
                   .nodes = tm_rows_of(mesh->nodes),
                   .elements = tm_rows_of(mesh->elements),
                   .threads = threads,
                   .error = error};
    tm_status status = measure(&x);
    if (status == TM_OK)
        status = examine_faces(&x);
    tm_element_measures_free(&x.measures);
    if (status == TM_OK)
        status = tm_examine_nodes_ranks(found, &x.nodes, mesh->own.xyz, error);
    if (status == TM_OK)
        status = tm_examination_join(found, error);
    return status;
}
