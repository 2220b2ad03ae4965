/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tetrahedra of which each rank has a slice cut into polyhedra by all ranks.
 *
 * Each rank gets a part of the tetrahedra along a space-filling curve, with all that have
 * a node in common with these, and finds out to which one each of them leads. The roots
 * are found by halving ways across ranks; each region goes to the rank of its root, with
 * what is around it, and is taken apart there by the code of one process. Cells and
 * facets get the numbers that one process gives them. */
#ifndef TM_POLY_RANKS_POLYHEDRA_RANKS_H
#define TM_POLY_RANKS_POLYHEDRA_RANKS_H

#include "../../base/extern_c.h"
#include "../../stream/ranks/slices.h"
#include "../partition.h"

TM_EXTERN_C_BEGIN

/* What was made, of all ranks. */
typedef struct tm_polyhedra_report {
    tm_poly_report poly;
    size_t facets, lost; /* tm_partition_facets() */
    size_t turned;       /* tetrahedra that came left-handed */
} tm_polyhedra_report;

/* All ranks: makes of the blocks .ele and .face of a stream .facet and .cell, as
 * tm_partition_make() with TM_POLY_TERMINAL and tm_partition_facets() do. *odd is true,
 * the stream as it was and *report of no use, where something is not as it should be,
 * which who has all of the mesh will tell; also where tetrahedra are flat, or rows of
 * .face are not those of the boundary and between regions, or the mesh touches itself in
 * an edge. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_polyhedra_ranks(tm_slices *slices, const tm_poly_options *options,
                             bool ignore_markers, tm_polyhedra_report *report, bool *odd,
                             tm_error *error);

TM_EXTERN_C_END

#endif
