/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What examinations by several ranks are made of. All functions are called by all ranks
 * and give the same status on all. */
#ifndef TM_EXAMINE_RANKS_PARTS_H
#define TM_EXAMINE_RANKS_PARTS_H

#include "../../mesh/ranks/part_nodes.h"
#include "../element_examine_faces.h"
#include "examine_ranks.h"

/* Gives the first `numbers` numbers of the places of defects other names; TM_NONE stays.
 */
void tm_rename_places(tm_defect_list *list, size_t numbers, const uint32_t *name);

/* element_part.c: the elements that have a face or an edge whose smallest node is in this
 * rank's slice, with the rows of .face, .edge and .facet that have; nodes are numbered
 * anew, and all in the order that they have in the whole. Sides of facets that are not
 * here are TM_NONE - 1. */
typedef struct tm_element_part {
    tm_mesh_view view; /* without xyz */
    int8_t *sign;      /* [elements] */
    uint32_t *row[4];  /* what elements, faces, edges, facets are in the whole */
    uint32_t *node;    /* of all of these, one after the other */
    size_t *start[2];  /* of the view */
    uint32_t (*side)[2];
    tm_part_nodes nodes;
} tm_element_part;

tm_status tm_element_part_make(tm_element_part *part, const tm_element_slices *mesh,
                               const int8_t *sign, tm_error *error);
void tm_element_part_free(tm_element_part *part);

/* examine_parts.c */

/* Nodes with equal coordinates, of which this rank has some: in *found, as
 * tm_examine_nodes() finds them, one rank these and another one those. */
tm_status tm_examine_nodes_ranks(tm_examination *found, const tm_rows *rows,
                                 const double (*own)[3], tm_error *error);

/* How many of the nodes are used, on all ranks, where this one uses those in a list. */
tm_status tm_count_used_nodes(const tm_rows *rows, const uint32_t *node, size_t count,
                              size_t *used, tm_error *error);

/* The sum of all ranks' sums, each as if it went on where the one before ended: *sum is
 * that of those before, then add(context, sum) is called, then it is that of all. */
void tm_sum_in_turn(tm_sum *sum, void (*add)(const void *context, tm_sum *sum),
                    const void *context);

/* The sum of all chunks of all ranks. */
tm_status tm_sum_of_chunks(const tm_sum *chunk, size_t chunks, double *sum,
                           tm_error *error);

/* Makes what each rank has found that of all: counts and defects, not sums of volumes and
 * areas, nor the numbers of nodes and elements. */
tm_status tm_examination_join(tm_examination *found, tm_error *error);

#endif
