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

/* poly_part.c: facets on this rank, with their nodes, which are numbered anew; all in the
 * order that they have in the whole. */
typedef struct tm_poly_part {
    tm_poly_arrays mesh; /* of these arrays, with cells where that is said */
    uint32_t *number;    /* [facets]: in the whole; NULL of those of the slice */
    uint32_t (*side)[2]; /* [facets]: in the whole, where nothing else is said */
    size_t *start;
    uint32_t *node;
    uint32_t *list; /* of cells */
    tm_part_nodes nodes;
} tm_poly_part;

/* Those of this rank's slice. */
tm_status tm_poly_part_of_slice(tm_poly_part *part, const tm_poly_slices *mesh,
                                tm_error *error);

/* This rank's cells, and all facets that they list or that name them. Sides are cells
 * here; where they are on other ranks, all of them are mesh.cells. */
tm_status tm_poly_part_of_cells(tm_poly_part *part, const tm_poly_slices *mesh,
                                tm_error *error);

/* Those that have a node of this rank's slice; nodes have no places. */
tm_status tm_poly_part_of_nodes(tm_poly_part *part, const tm_poly_slices *mesh,
                                tm_error *error);
void tm_poly_part_free(tm_poly_part *part);

/* poly_examine_ranks.c: finds in *found, on all ranks, what of tm_poly_examine_facets()
 * sizes are told by: unmatched facets, unused nodes, Euler number. */
tm_status tm_poly_count_ranks(tm_examination *found, const tm_poly_slices *mesh,
                              tm_error *error);

/* examine_parts.c */

/* Nodes with equal coordinates, of which this rank has some: in *found, as
 * tm_examine_nodes() finds them, one rank these and another one those. */
tm_status tm_examine_nodes_ranks(tm_examination *found, const tm_rows *rows,
                                 const double (*own)[3], tm_error *error);

/* How many of the nodes are used, on all ranks, where this one uses those in a list. */
tm_status tm_count_used_nodes(const tm_rows *rows, const uint32_t *node, size_t count,
                              size_t *used, tm_error *error);

/* What is added up in the order of ranks: *sum, rank 0's, goes from one to the next, each
 * of which calls add(context, sum); all have the last one's then. */
void tm_sum_in_turn(void *sum, size_t size, void (*add)(const void *context, void *sum),
                    const void *context);

/* The sum of all chunks of all ranks. */
tm_status tm_sum_of_chunks(const tm_sum *chunk, size_t chunks, double *sum,
                           tm_error *error);

/* Makes what each rank has found that of all: counts and defects, not sums of volumes and
 * areas, nor the numbers of nodes and elements. */
tm_status tm_examination_join(tm_examination *found, tm_error *error);

#endif
