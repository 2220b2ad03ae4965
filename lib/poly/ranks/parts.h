/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What polyhedra_ranks.h is made of. All functions are called by all ranks and give the
 * same status on all. */
#ifndef TM_POLY_RANKS_PARTS_H
#define TM_POLY_RANKS_PARTS_H

#include "../../geom/space_order.h"
#include "../../mesh/ranks/part_nodes.h"
#include "../../ranks/post.h"
#include "../../stream/ranks/slices.h"
#include "../../tet/mesh.h"
#include "polyhedra_ranks.h"

/* The blocks of the stream, and how many rows all ranks have. */
typedef struct tm_tet_slices {
    const tm_block *node, *face, *edge; /* face, edge: may be NULL */
    tm_block *ele;
    tm_rows nodes, tets;
    size_t faces;
    size_t width; /* attributes of a tetrahedron */
} tm_tet_slices;

/* sorted_tets.c: the tetrahedra in the order of tm_tet_mesh_sort(), of which this rank
 * has its rows. A record is four nodes in order, then the attributes. */
typedef struct tm_sorted_tets {
    tm_rows rows;
    size_t words;        /* of a record */
    uint32_t *record;    /* [rows.count][words] */
    tm_part_nodes nodes; /* those that these have, and */
    uint32_t *home;      /* their homes: the ranks that know what is at them */
    tm_space space;
    double box[2][3];
    uint32_t *cut; /* [ranks - 1], ascending: where on the curve the next rank begins */
    size_t turned;
} tm_sorted_tets;

/* *odd is set where a tetrahedron is flat or names a node twice. */
tm_status tm_sorted_tets_make(tm_sorted_tets *sorted, const tm_tet_slices *slices,
                              bool *odd, tm_error *error);
void tm_sorted_tets_free(tm_sorted_tets *sorted);

/* The rank that knows what is at a node at that place. */
unsigned tm_sorted_home(const tm_sorted_tets *sorted, const double place[3]);

/* homes.c: what is at the nodes whose home a rank is: tetrahedra, as number in the order
 * and record, and rows of .face, as number, three nodes and marker. */
typedef struct tm_at_home {
    uint32_t *item; /* one after the other */
    size_t words;   /* of each */
    size_t items;
    uint32_t *start; /* [node.count + 1]: those at a node are */
    uint32_t *list;  /* list[start[v] … start[v + 1]) */
} tm_at_home;

typedef struct tm_homes {
    tm_number_set node;
    tm_at_home tet, face;
} tm_homes;

tm_status tm_homes_make(tm_homes *homes, const tm_sorted_tets *sorted,
                        const tm_tet_slices *slices, bool *odd, tm_error *error);
void tm_homes_free(tm_homes *homes);

/* A mesh of all tetrahedra that have some nodes: in the order and with neighbours. */
typedef struct tm_poly_tets {
    tm_tet_mesh mesh;
    tm_number_set tet; /* which ones they are */
    uint32_t *node;    /* [mesh.nodes]: their numbers */
} tm_poly_tets;

/* Asks for what is at a node, of the tetrahedra that this rank has, for a rank. */
void tm_poly_tets_ask(tm_post *asking, const tm_sorted_tets *sorted, size_t node,
                      unsigned rank);

/* Of all nodes that were asked for. *odd is set where they are no mesh. */
tm_status tm_poly_tets_make(tm_poly_tets *share, tm_post *asking, const tm_homes *homes,
                            const tm_tet_slices *slices, bool *odd,
                            const tm_poly_options *options, tm_error *error);
void tm_poly_tets_free(tm_poly_tets *share);

/* cells_ranks.c: cell[sorted->rows.count] are the numbers of the cells of this rank's
 * tetrahedra; *first[…], to be freed, whether one is the first of its cell. `share` has
 * all tetrahedra that have a node with these in common. */
typedef struct tm_rank_cells {
    uint32_t *cell;
    bool *first;
    size_t cells; /* of all ranks */
} tm_rank_cells;

tm_status tm_rank_cells_make(tm_rank_cells *cells, const tm_sorted_tets *sorted,
                             const tm_homes *homes, const tm_tet_slices *slices,
                             const tm_poly_tets *share, const tm_poly_options *options,
                             bool ignore_markers, tm_poly_report *report,
                             tm_error *error);

/* facets_ranks.c: fills the blocks .facet, whose rows are not slices but those of this
 * rank's cells, from *before on, and .cell, whose are slices. *facets and *lost of all.
 */
tm_status tm_rank_facets(const tm_rank_cells *cells, const tm_sorted_tets *sorted,
                         const tm_tet_slices *slices, const tm_poly_tets *share,
                         tm_block *facet, tm_block *cell, size_t *before, size_t *facets,
                         size_t *lost, tm_error *error);

#endif
