/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examines and measures a mesh of which each rank has a slice of each block. What is
 * looked at in one place — faces and edges at their smallest nodes, boundary faces at
 * each of theirs, nodes by where they are — is sent to one rank, which examines it as one
 * process does.
 */
#ifndef TM_EXAMINE_RANKS_EXAMINE_RANKS_H
#define TM_EXAMINE_RANKS_EXAMINE_RANKS_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../mesh/mesh_view.h"
#include "../../mesh/poly_arrays.h"
#include "../examination.h"
#include "../poly/poly_statistics.h"
#include "../tet_statistics.h"

TM_EXTERN_C_BEGIN

/* Tetrahedra or mixed elements: this rank's rows, whose indices are those of all, and how
 * many all are. */
typedef struct tm_element_slices {
    tm_mesh_view own;
    size_t nodes, elements, faces, edges, facets;
} tm_element_slices;

/* All ranks: tm_element_examine() of all, in *found on each of them. TM_ERROR_SYSTEM, on
 * all, where memory is out on one. A rank has its slice and what is at its slice of the
 * nodes: where nodes that are near each other have near numbers, as much again. */
tm_status tm_element_examine_ranks(tm_examination *found, const tm_element_slices *mesh,
                                   unsigned threads, tm_error *error);

/* All ranks: tm_tet_statistics_measure() of all tetrahedra, in *statistics on each of
 * them, the same numbers; left-handed ones, *turned of all, are measured as if turned.
 * TM_ERROR_SYSTEM, on all, where memory is out on one. A rank has its slice, and the
 * places of its nodes. */
tm_status tm_tet_statistics_ranks(tm_tet_statistics *statistics, size_t *turned,
                                  const tm_element_slices *mesh, double limit,
                                  unsigned threads, tm_error *error);

/* Polyhedra. */
typedef struct tm_poly_slices {
    tm_poly_arrays own;
    size_t nodes, facets, cells;
} tm_poly_slices;

/* tm_poly_examine() of all, as above. */
tm_status tm_poly_examine_ranks(tm_examination *found, const tm_poly_slices *mesh,
                                unsigned threads, tm_error *error);

/* All ranks: tm_poly_statistics_measure() of all, in *statistics on each of them, the
 * same numbers. TM_ERROR_SYSTEM, on all, where memory is out on one. A rank has its slice
 * and, one after the other, the facets of its polyhedra and those at its nodes. */
tm_status tm_poly_statistics_ranks(tm_poly_statistics *statistics,
                                   const tm_poly_slices *mesh, unsigned threads,
                                   tm_error *error);

TM_EXTERN_C_END

#endif
